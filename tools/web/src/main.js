// The page: what is open, and what buttons, keys and files do.
import { curvatureKinds, curvatureStops } from 'tessera/three';
import { count, counted, element, length, round, short, withUnit } from './format.js';
import { listenForKeys, listenForPicks } from './keys.js';
import { Document, prepare } from './library.js';
import { Numbers, showFace } from './panels.js';
import { Parts } from './parts.js';
import { listen, sourceOfAddress } from './sources.js';
import { Viewer } from './viewer.js';

const $ = (id) => document.getElementById(id);
const canvas = $('picture');
let open = null;  // the Document that is shown
let numbers = null, parts = null;
let reading = null, measuring = null;  // AbortControllers
let selected = [];

const viewer = viewerOf();
function viewerOf() {
  try {
    return new Viewer(canvas, { onPicture: showProof, onError: (error) => fail(error.message) });
  } catch (error) {
    fail(`The picture needs WebGL 2, which this browser does not give: ${error.message}`);
    throw error;
  }
}

function say(sentence) { $('live').textContent = sentence; }
function fail(sentence) {
  $('sentence').textContent = sentence;
  $('error').hidden = false;
}
function forgive() { $('error').hidden = true; }

/** Opens a source in place of the former, whose picture stays until the new one is read. */
async function show(source) {
  reading?.abort();
  const mine = (reading = new AbortController());
  forgive();
  busy(source.name, 'Reading', null);
  performance.mark('open');
  try {
    const progress = (words, share) => { if (mine === reading) busy(source.name, words, share); };
    const document = await Document.open(source, { signal: mine.signal, progress });
    if (mine !== reading) return document.close();
    await take(document);
  } catch (error) {
    if (mine === reading && error.name !== 'AbortError') fail(error.message);
    else if (mine === reading) say(`Reading ${source.name} was cancelled.`);
  } finally {
    if (mine === reading) {
      reading = null;
      $('busy').hidden = true;
      $('empty').hidden = open !== null;
      $('main').classList.toggle('is-empty', open === null);
    }
  }
}
function busy(name, words, share) {
  $('empty').hidden = true;
  $('busy').hidden = false;
  $('doing').textContent = `${words} ${name}`;
  if (share === null) $('progress').removeAttribute('value');
  else $('progress').value = share;
}

async function take(next) {
  measuring?.abort();
  const former = open;
  open = null;
  selected = [];
  const colouring = viewer.mode === 'curvature' ? $('curvature').value : 'surface';
  next.object.colours = colouring;
  numbers = new Numbers($('numbers'), next, measure);
  parts = new Parts($('parts'), next, { select, hide, zoom });
  showFace($('face'), next, null);
  open = next;
  $('main').classList.remove('is-empty');
  try {
    await viewer.show(next.object, next.box);
  } catch (error) {
    if (open !== next) return;
    forget(next);
    throw error;
  } finally {
    former?.close();
  }
  if (open !== next) return;  // another file came meanwhile
  performance.measure('picture', 'open');
  showLegend();
  $('file').textContent = document.title = next.name;
  for (const id of ['save', 'fit', 'modes']) $(id).disabled = false;
  say(`${next.name}: ${counted(next.faces.length, 'face')}, ${counted(next.object.shown.triangles, 'triangle')}.` +
    (next.warnings.length ? ` ${counted(next.warnings.length, 'warning')}.` : ''));
}

/** Goes back to an empty page: the model could be read, but no picture be made. */
function forget(former) {
  viewer.clear();
  viewer.redraw();
  former.close();
  open = null;
  $('main').classList.add('is-empty');
  $('file').textContent = 'No file open';
  document.title = 'Tessera';
  for (const id of ['face', 'numbers', 'parts']) $(id).replaceChildren();
  for (const id of ['save', 'fit', 'modes']) $(id).disabled = true;
  $('proof').hidden = $('legend').hidden = true;
}

function showProof({ isProven }) {
  const shown = open?.object.shown;
  if (!shown) return;
  $('proof').hidden = false;
  $('proof').dataset.proven = isProven;
  $('proof').textContent = isProven ?
    `Proven to ${shown.pixels.toFixed(2)} pixels · ${counted(shown.triangles, 'triangle')}` :
    `Being proven · ${counted(shown.triangles, 'triangle')}`;
  numbers.take(shown, isProven);
}

// Faces and parts.
function mark(surfaces) {
  selected = surfaces;
  open.object.select(surfaces);
  parts.mark(surfaces);
  viewer.redraw();
}
function select(surfaces, name) {
  mark(surfaces);
  viewer.mark(null);
  say(`${name}: ${counted(surfaces.length, 'face')} selected.`);
}
function clear() {
  if (!open) return;
  mark([]);
  viewer.mark(null);
  showFace($('face'), open, null);
}
async function pick(x, y) {
  const asked = open;
  if (!asked) return;
  try {
    const hit = await asked.pick(viewer.ray(x, y));
    if (asked !== open) return;
    if (!hit) return clear();
    mark([hit.surface]);
    viewer.mark(hit.position);
    showFace($('face'), asked, hit);
    const face = asked.faces[hit.surface];
    say(`Face ${face.name || hit.surface}, ${face.kind}, u ${short(hit.u)}, v ${short(hit.v)}.`);
  } catch (error) {
    if (asked === open) fail(error.message);
  }
}
function hide(surfaces, isHidden) {
  open.object.hide(surfaces, isHidden);
  viewer.redraw();
}
function hidePart() {
  if (!selected.length) return say('No face is selected.');
  const { instance } = open.faces[selected[0]];
  const whole = open.faces.flatMap((face, k) => (instance !== null && face.instance === instance ? [k] : []));
  hide(selected.length === 1 && whole.length ? whole : selected, true);
  clear();
  parts.refresh();
}
function showAll() {
  hide(open.faces.map((_, k) => k), false);
  parts.refresh();
}
function zoom(surfaces, name) {
  const box = open.object.boxOf(surfaces);
  if (box) viewer.look(null, true, box);
  say(box ? `Zoomed to ${name}.` : `${name} has no triangles in this picture.`);
}

// Modes.
async function setMode(mode) {
  document.querySelector(`input[name=mode][value=${mode}]`).checked = true;
  viewer.setMode(mode);
  showLegend();
  if (!open) return;
  try {
    await open.object.colourBy(mode === 'curvature' ? $('curvature').value : 'surface');
  } catch (error) {
    fail(error.message);
  }
  showLegend();
  viewer.redraw();
}
function showLegend() {
  const kind = $('curvature').value, range = open?.object.curvatureRanges[kind];
  $('legend').hidden = viewer.mode !== 'curvature' || !range;
  if (!range) return;
  const unit = withUnit('', open.unit && `1/${open.unit}`, 1).trim() + (kind === 'gaussian' && open.unit ? '²' : '');
  $('ramp').style.background = `linear-gradient(to right, ${curvatureStops(kind).join(', ')})`;
  const low = curvatureKinds[kind].isSigned ? short(-range, 2) : '0';
  $('scale').replaceChildren(...[low, unit, short(range, 2)].map((text) => element('span', {}, text)));
}

// Measures and files.
async function measure() {
  const asked = open, its = numbers, mine = (measuring = new AbortController());
  const progress = (share) => its.showMeasuring(share, () => mine.abort());
  progress(0);
  try {
    const found = await asked.measure({
      signal: mine.signal, progress: (share) => { if (!mine.signal.aborted) progress(share); },
    });
    its.showMeasures(found);
    if (asked === open) say(`Area ${short(found.area)}.`);
  } catch (error) {
    if (error.name === 'AbortError') its.offerMeasure(measure);
    else its.showMeasureError(error.message);
  }
}
function askTolerance() {
  $('tolerance').value = round(open.diagonal / 2000);
  $('unit').textContent = open.unit;
  $('saving').showModal();
}
async function save() {
  const asked = open, tolerance = Number($('tolerance').value);
  try {
    const bytes = await asked.save(tolerance);
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([bytes], { type: 'model/gltf-binary' }));
    link.download = `${asked.name.replace(/\.\w+$/, '')}.glb`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    say(`${link.download}: ${count(bytes.length)} bytes, within ${length(tolerance, asked.unit)}.`);
  } catch (error) {
    fail(error.message);
  }
}

function takeColours() {
  const style = getComputedStyle(document.documentElement), value = (name) => style.getPropertyValue(name).trim();
  viewer.setColours({ ground: value('--stage'), line: value('--line'), wire: value('--wire') });
}

listen({
  stage: $('stage'), chooser: $('chooser'), buttons: [$('open'), $('choose')], choice: $('examples'), tries: $('tries'),
  open: show, say,
});
listenForKeys(canvas, viewer, { pick, mode: setMode, clear, hide: hidePart, showAll });
listenForPicks(canvas, pick);
$('cancel').addEventListener('click', () => reading?.abort());
$('dismiss').addEventListener('click', forgive);
$('fit').addEventListener('click', () => viewer.look([0.62, -1, 0.62]));
$('help').addEventListener('click', () => $('keys').showModal());
$('save').addEventListener('click', askTolerance);
$('unsaved').addEventListener('click', () => $('saving').close('cancel'));
$('saving').addEventListener('close', () => $('saving').returnValue === 'save' && save());
$('modes').addEventListener('change', (event) => setMode(event.target.value));
$('curvature').addEventListener('change', () => setMode('curvature'));
addEventListener('themechange', takeColours);
takeColours();

const asked = sourceOfAddress();
if (asked) {
  $('main').classList.remove('is-empty');  // the layout that the model will have
  show(asked);
} else prepare().catch((error) => fail(error.message));
