// The words about a model beside its picture: the face that is picked, numbers, and parts.
import { count, counted, element, length, proven, short, terms } from './format.js';
import { plainName } from './parts.js';

const quiet = (text) => element('p', { className: 'quiet' }, text);
const point = (values, digits) => values.map((value) => short(value, digits)).join(', ');
/** A colour of STEP in CSS. */
export function cssColour(colour) {
  return `rgb(${colour.slice(0, 3).map((value) => Math.round(255 * value)).join(' ')})`;
}

function swatch(colour) {
  if (!colour) return 'none';
  const mark = element('span', { className: 'swatch', ariaHidden: 'true' });
  mark.style.background = cssColour(colour);
  const code = colour.slice(0, 3).map((value) => Math.round(255 * value).toString(16).padStart(2, '0')).join('');
  return element('span', {}, mark, `#${code}`);
}
/** Both radii of curvature; those of a fitted surface are the fit's. */
function radiiOf({ firstCurvature, secondCurvature, isPole }, { diagonal, unit, fitError }) {
  if (isPole) return 'none at a pole';
  const radius = (curvature) =>
    (Math.abs(curvature) * diagonal < 1e-9 ? 'flat' : length(1 / curvature, unit, fitError > 0 ? 3 : 5));
  return `${fitError > 0 ? 'about ' : ''}${radius(firstCurvature)}; ${radius(secondCurvature)}`;
}

/** The rows of a face that was picked. */
export function showFace(place, document, hit) {
  if (!hit) return place.replaceChildren(quiet('Click a face, or press Enter in the picture.'));
  const face = document.faces[hit.surface];
  const instance = face.instance === null ? null : plainName(document.instances[face.instance].name);
  place.replaceChildren(terms([
    ['Name', plainName(face.name) ?? 'none'], ['Part', instance], ['Colour', swatch(face.colour)],
    ['Surface', `${face.kind}, number ${count(hit.surface)}`],
    ['u, v', `${short(hit.u, 7)}, ${short(hit.v, 7)}`],
    ['Point', point(hit.position, 7)], ['Normal', point(hit.normal, 4)],
    ['Radii', radiiOf(hit, document)],
    ['Mean', hit.isPole ? null : short(hit.mean)], ['Gaussian', hit.isPole ? null : short(hit.gaussian)],
  ]));
}

const closed = (openEdges) => (openEdges === 0 ? 'closed' : counted(openEdges, 'open edge'));

/** The numbers of the model and of the mesh that is shown; `onMeasure` is asked for areas and volumes. */
export class Numbers {
  #rows = {};
  #measures;

  constructor(place, document, onMeasure) {
    const { faces, instances, shapes, patchCount, cutCount, unit, warnings, box, fitError } = document;
    const row = (name) => (this.#rows[name] = element('span'));
    this.unit = unit;
    this.#measures = element('div', { id: 'measures' });
    const size = box.high.map((high, k) => short(high - box.low[k])).join(' × ');
    place.replaceChildren(terms([
      ['Picture', row('pixels')], ['Bound', row('bound')], ['Gap', row('gap')], ['Mesh', row('closed')],
      ['Fit', fitError > 0 ? `within ${length(fitError, unit, 2)}` : null],
      ['Triangles', row('triangles')], ['Plan', row('time')],
      ['Size', unit ? `${size} ${unit}` : size], ['Unit', unit || 'none stated'], ['Faces', count(faces.length)],
      ['Parts', instances.length ? `${count(instances.length)} of ${counted(shapes.length, 'shape')}` : null],
      ['Patches', cutCount ? `${count(patchCount)}, ${count(cutCount)} trimmed` : count(patchCount)],
    ]), this.#measures);
    if (warnings.length) place.append(warningsOf(warnings));
    this.offerMeasure(onMeasure);
  }

  /** Takes the numbers of the mesh: those of ModelObject.shown. */
  take(shown, isProven) {
    const { unit } = this, set = (name, text) => { this.#rows[name].textContent = text; };
    set('pixels', isProven ? `within ${shown.pixels.toFixed(3)} pixels` : 'being planned');
    set('bound', length(shown.seenBound, unit));
    set('gap', shown.gap === 0 ? '0' : length(shown.gap, unit, 3));
    set('closed', closed(shown.openEdges) +
      (shown.crossedPatches ? `, ${counted(shown.crossedPatches, 'patch')} left out` : ''));
    set('triangles', count(shown.triangles));
    set('time', `${shown.milliseconds.toFixed(1)} ms`);
  }

  offerMeasure(onMeasure) {
    this.#measures.replaceChildren(
      element('button', { type: 'button', id: 'measure', onclick: onMeasure }, 'Measure area and volume'));
  }
  showMeasuring(share, onCancel) {
    if (!this.#measures.querySelector('progress'))
      this.#measures.replaceChildren(element('progress', { max: 1, ariaLabel: 'Measuring' }),
        element('button', { type: 'button', onclick: onCancel }, 'Cancel'));
    this.#measures.querySelector('progress').value = share;
  }
  showMeasures({ area, areaError, bodies, isProven }) {
    const value = (number, error, power) => proven(number, error, this.unit, power);
    const rows = [['Area', value(area, areaError, 2)]];
    const closedBodies = bodies.filter((body) => Number.isFinite(body.volume));
    const sum = (name) => closedBodies.reduce((total, body) => total + body[name], 0);
    if (closedBodies.length) rows.push(['Volume', value(sum('volume'), sum('volumeError'), 3)]);
    rows.push(['Bodies', bodies.length ? count(bodies.length) : 'none: the faces enclose no volume']);
    const areAll = isProven && bodies.every((body) => body.isProven);
    rows.push(['Bounds', areAll ? 'proven' : 'estimated, since fits, trimming curves or gaps are']);
    this.#measures.replaceChildren(terms(rows));
  }
  showMeasureError(sentence) { this.#measures.replaceChildren(quiet(sentence)); }
}

function warningsOf(warnings) {
  const shown = warnings.slice(0, 100).map((each) => element('li', {}, each));
  const left = warnings.length - shown.length;
  if (left > 0) shown.push(element('li', {}, `and ${count(left)} more`));
  return element('details', { className: 'warnings' },
    element('summary', {}, counted(warnings.length, 'warning')), element('ul', {}, ...shown));
}
