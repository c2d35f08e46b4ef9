// The duties of the page. A case takes { assert, browser, server, folder, native }.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { request } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { Tab, axe, glbOf, modelAt, serve } from './browser.mjs';

const bearing = modelAt('bearing_block.step');
const trianglesOf = async (tab) => Number((await tab.row('Triangles')).replaceAll(',', ''));

/** Opens a tab with a model of tools/models. */
async function opened(browser, address, name, options) {
  const tab = await Tab.open(browser, address, options);
  await tab.dropFile(modelAt(name));
  await tab.shown(name);
  return tab;
}
const centreOf = (tab) => tab.page.$eval('#picture', (canvas) => {
  const { left, top, width, height } = canvas.getBoundingClientRect();
  return { x: left + width / 2, y: top + height / 2 };
});

async function dropAndFollow({ assert, browser, server }) {
  const tab = await opened(browser, server.address, 'bearing_block.step');
  assert.equal(await tab.evaluate(() => crossOriginIsolated), true);
  assert.match(await tab.text('proof'), /^Proven to 0\.\d\d pixels · [\d,]+ triangles$/);
  assert.equal(await tab.row('Mesh'), 'closed');
  assert.equal(await tab.row('Unit'), 'mm');
  const before = await trianglesOf(tab), { x, y } = await centreOf(tab);
  await tab.page.mouse.move(x, y);
  await tab.page.mouse.down();
  for (let k = 1; k <= 10; ++k) await tab.page.mouse.move(x + 15 * k, y + 4 * k);
  await tab.page.mouse.up();
  for (let k = 0; k < 6; ++k) await tab.page.mouse.wheel({ deltaY: -240 });
  await tab.settled();
  assert.notEqual(await trianglesOf(tab), before, 'the triangles follow the camera');
  const pixels = Number(/[\d.]+/.exec(await tab.row('Picture'))[0]);
  assert.ok(pixels > 0 && pixels <= 0.5, `${pixels} pixels`);
  const isOwn = (url) => url.startsWith(server.address) || url.startsWith('blob:');
  assert.ok(tab.requests.every(isOwn), 'no other server is asked');
  assert.deepEqual(tab.faults, []);
}

async function pickExactly({ assert, browser, server }) {
  const tab = await opened(browser, server.address, 'sphere.json');
  const { x, y } = await centreOf(tab);
  await tab.page.mouse.click(x + 30, y - 20);
  await tab.wait(() => document.querySelector('#face dl'));
  const numbers = async (row) => (await tab.row(row)).replaceAll('−', '-').match(/-?[\d.]+/g).map(Number);
  const point = await numbers('Point');
  assert.ok(Math.abs(Math.hypot(...point) - 1) < 1e-6, `${point} is on the sphere`);
  for (const radius of await numbers('Radii')) assert.ok(Math.abs(Math.abs(radius) - 1) < 1e-4, `radius ${radius}`);
  assert.equal(await tab.row('Gaussian'), '1');
  await tab.page.mouse.click(40, 400);
  await tab.wait(() => !document.querySelector('#face dl'));
  assert.deepEqual(tab.faults, []);
}

async function modes({ assert, browser, server }) {
  const tab = await opened(browser, server.address, 'bearing_block.step');
  const pictures = new Set();
  for (const mode of ['shaded', 'edges', 'curvature', 'wireframe']) {
    await tab.page.click(`input[value=${mode}] + span`);
    if (mode === 'curvature') await tab.page.waitForSelector('#legend:not([hidden])');
    await new Promise((resolve) => setTimeout(resolve, 300));
    await tab.settled();
    pictures.add(await tab.picture());
  }
  assert.equal(pictures.size, 4, 'each mode is another picture');
  await tab.page.click('input[value=curvature] + span');
  for (const kind of ['mean', 'gaussian', 'maximum']) {
    await tab.page.select('#curvature', kind);
    await tab.settled();
    assert.match(await tab.text('scale'), /\d/);
  }
  assert.deepEqual(tab.faults, []);
}

async function tree({ assert, browser, server }) {
  const tab = await opened(browser, server.address, 'bearing_block.step');
  const whole = await tab.picture();
  await tab.page.click('#parts .row input');
  await tab.settled();
  const empty = await tab.picture();
  assert.notEqual(empty, whole, 'a part is hidden');
  await tab.page.click('#parts .row input');
  await tab.settled();
  assert.ok(await tab.becomes(whole), 'it is shown again');
  await tab.page.click('#parts .twist[aria-expanded=false]');
  await tab.page.click('#parts .tree .tree .row .name');
  await tab.wait(() => document.querySelector('#parts .marked'));
  assert.notEqual(await tab.picture(), whole, 'a face is marked');
  await tab.page.click('#parts .tree .tree .row .zoom');
  await new Promise((resolve) => setTimeout(resolve, 500));
  await tab.settled();
  assert.match(await tab.text('live'), /^Zoomed to /);
  assert.deepEqual(tab.faults, []);
}

async function save({ assert, browser, server, native }) {
  const tab = await opened(browser, server.address, 'bearing_block.step');
  const downloads = mkdtempSync(join(tmpdir(), 'tessera-web-'));
  const session = await tab.page.createCDPSession();
  await session.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: downloads });
  await tab.page.click('#save');
  await tab.page.$eval('#tolerance', (input) => { input.value = '0.05'; });
  await tab.page.click('#saving button.main');
  await tab.wait(() => /bytes, within/.test(document.getElementById('live').textContent));
  let files = [];
  for (let tries = 0; tries < 100 && !files.some((name) => name.endsWith('.glb')); ++tries) {
    await new Promise((resolve) => setTimeout(resolve, 50));
    files = readdirSync(downloads);
  }
  const bytes = readFileSync(join(downloads, 'bearing_block.glb')), glb = glbOf(bytes);
  assert.equal(glb.asset.version, '2.0');
  assert.ok(glb.meshes.length > 0);
  if (native) {
    execFileSync(native, ['tessellate', bearing, '-o', join(downloads, 'native.glb'), '--tolerance', '0.05']);
    const its = glbOf(readFileSync(join(downloads, 'native.glb')));
    // The native program divides each shape once, and places it; the page divides the faces where they are.
    const trianglesIn = ({ nodes, meshes, accessors }) => nodes.flatMap(({ mesh }) => meshes[mesh]?.primitives ?? [])
      .reduce((sum, { indices }) => sum + accessors[indices].count / 3, 0);
    const [found, wanted] = [trianglesIn(glb), trianglesIn(its)];
    assert.ok(Math.abs(found - wanted) < 0.03 * wanted, `${found} triangles, the native program writes ${wanted}`);
    const coloursIn = ({ materials }) =>
      materials.map((each) => each.pbrMetallicRoughness.baseColorFactor.join()).sort();
    assert.deepEqual([...new Set(coloursIn(glb))], [...new Set(coloursIn(its))]);
  }
  rmSync(downloads, { recursive: true });
  assert.deepEqual(tab.faults, []);
}

async function errors({ assert, browser, server, folder }) {
  const { init } = await import(pathToFileURL(join(folder, 'tessera/index.js')).href), tessera = await init();
  const tab = await opened(browser, server.address, 'teapot.bpt');
  const broken = {
    'broken.stp': 'ISO-10303-21;\nHEADER;\nBROKEN',
    'broken.json': '{"surfaces": [{"type": "bezier", 3]}', 'empty.step': '',
  };
  for (const [name, text] of Object.entries(broken)) {
    let sentence = null;
    try { tessera.read(name, text); } catch (error) { sentence = error.message; }
    assert.ok(sentence, `${name} is an error in Node`);
    await tab.evaluate(() => document.getElementById('dismiss').click());
    await tab.drop(name, Buffer.from(text));
    await tab.wait(() => !document.getElementById('error').hidden);
    assert.equal(await tab.text('sentence'), sentence, 'the page says the sentence of the library');
    assert.equal(await tab.evaluate(() => document.title), 'teapot.bpt', 'the model before stays');
  }
  await tab.dropFile(modelAt('sphere.json'));
  await tab.shown('sphere.json');
  assert.equal(await tab.evaluate(() => document.getElementById('error').hidden), true);
  assert.deepEqual(tab.faults, []);
}

async function keyboard({ assert, browser, server }) {
  const tab = await opened(browser, server.address, 'bearing_block.step');
  const first = await tab.picture();
  await tab.key('ArrowLeft');
  const turned = await tab.picture();
  assert.notEqual(turned, first);
  for (const [key, shift] of [['ArrowUp', true], ['+', false], ['x', false], ['z', true]]) {
    const before = await tab.picture();
    await tab.key(key, shift);
    await new Promise((resolve) => setTimeout(resolve, 400));
    await tab.settled();
    assert.notEqual(await tab.picture(), before, `${key} moves the picture`);
  }
  await tab.key('Home');
  await tab.key('3');
  assert.equal(await tab.evaluate(() => document.querySelector('input[name=mode]:checked').value), 'curvature');
  await tab.key('Enter');
  await tab.wait(() => /^Face /.test(document.getElementById('live').textContent));
  await tab.key('Escape');
  await tab.wait(() => !document.querySelector('#face dl'));
  // Every control is reached by the tabulator, and shows that it is.
  await tab.evaluate(() => { document.activeElement.blur(); });
  const reached = new Set();
  for (let k = 0; k < 60; ++k) {
    await tab.page.keyboard.press('Tab');
    const [id, width] = await tab.evaluate(() => {
      const at = document.activeElement, style = getComputedStyle(at.name === 'mode' ? at.nextElementSibling : at);
      return [at.id || at.name || at.className, parseFloat(style.outlineWidth)];
    });
    if (!id) continue;
    reached.add(id);
    assert.ok(width >= 2, `the focus of ${id} is seen`);
  }
  for (const id of ['open', 'examples', 'save', 'help', 'theme', 'picture', 'mode', 'fit', 'measure', 'name', 'zoom'])
    assert.ok(reached.has(id), `${id} is reached`);
  assert.deepEqual(tab.faults, []);
}

async function touch({ assert, browser, server }) {
  const tab = await opened(browser, server.address, 'goblet.json', { width: 375, height: 740, touch: true });
  assert.equal(await tab.evaluate(() => document.documentElement.scrollWidth), 375, 'nothing is wider than a phone');
  const { x, y } = await centreOf(tab), session = await tab.page.createCDPSession();
  const touches = (type, ...points) => session.send('Input.dispatchTouchEvent',
    { type, touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })) });
  const before = await trianglesOf(tab);
  await touches('touchStart', [x - 30, y], [x + 30, y]);
  for (let k = 1; k <= 8; ++k) await touches('touchMove', [x - 30 - 8 * k, y], [x + 30 + 8 * k, y]);
  await touches('touchEnd');
  await tab.settled();
  assert.notEqual(await trianglesOf(tab), before, 'two fingers zoom');
  const picture = await tab.picture();
  await touches('touchStart', [x, y]);
  for (let k = 1; k <= 8; ++k) await touches('touchMove', [x + 9 * k, y]);
  await touches('touchEnd');
  await tab.settled();
  assert.notEqual(await tab.picture(), picture, 'one finger turns');
  await tab.page.touchscreen.tap(x, y - 40);
  await tab.wait(() => document.querySelector('#face dl'));
  assert.deepEqual(tab.faults, []);
}

async function colours({ assert, browser, server }) {
  const ground = (tab) => tab.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await Tab.open(browser, server.address);
  const dark = await Tab.open(browser, server.address, { scheme: 'dark' });
  assert.notEqual(await ground(light), await ground(dark));
  await light.page.select('#theme', 'dark');
  assert.equal(await ground(light), await ground(dark));
  await light.page.reload();
  assert.equal(await ground(light), await ground(dark), 'the choice is kept');
  await light.page.select('#theme', 'auto');
  assert.deepEqual([...light.faults, ...dark.faults], []);
}

async function sources({ assert, browser, folder }) {
  const server = await serve(folder, bearing);
  const tab = await Tab.open(browser, `${server.address}?model=/model/bearing_block.step`);
  await tab.shown('bearing_block.step');
  await tab.page.select('#examples', 'seashell.json');
  await tab.shown('seashell.json');
  await tab.evaluate((text) => {
    const data = new DataTransfer();
    data.setData('text/plain', text);
    document.body.dispatchEvent(new ClipboardEvent('paste', { clipboardData: data, bubbles: true }));
  }, readFileSync(modelAt('torus.json'), 'utf8'));
  await tab.shown('pasted.json');
  // Two files, one behind the other: the later one counts.
  await tab.dropFile(bearing);
  await tab.dropFile(modelAt('sphere.json'));
  await tab.shown('sphere.json');
  await new Promise((resolve) => setTimeout(resolve, 500));
  assert.equal(await tab.evaluate(() => document.title), 'sphere.json');
  assert.deepEqual(tab.faults, []);
  server.close();
}

async function measures({ assert, browser, server }) {
  const tab = await opened(browser, server.address, 'bearing_block.step');
  await tab.page.click('#measure');
  await tab.wait(() => [...document.querySelectorAll('dt')].some((each) => each.textContent === 'Area'));
  assert.match(await tab.row('Area'), /mm² ± /);
  assert.match(await tab.row('Volume'), /mm³ ± /);
  // A formula is fitted, which its measures count.
  await tab.dropFile(modelAt('seashell.json'));
  await tab.shown('seashell.json');
  assert.match(await tab.row('Fit'), /^within /);
  await tab.page.click('#measure');
  await tab.wait(() => [...document.querySelectorAll('dt')].some((each) => each.textContent === 'Area'));
  assert.match(await tab.row('Area'), /^[\d.]+ ± [\d.]+$/);
  assert.deepEqual(tab.faults, []);
}

/** A file that comes while the first picture of another is planned. */
async function comesMeanwhile({ assert, browser, server }) {
  const tab = await opened(browser, server.address, 'teapot.bpt');
  await tab.drop('slow.json', slowFile());
  await tab.wait(() => document.querySelectorAll('#parts input').length !== 32);  // the teapot's
  await tab.key('Escape');
  await tab.dropFile(modelAt('torus.json'));
  await tab.shown('torus.json');
  await new Promise((resolve) => setTimeout(resolve, 500));
  assert.equal(await tab.evaluate(() => document.getElementById('main').classList.contains('is-empty')), false);
  assert.equal(await tab.evaluate(() => document.querySelectorAll('#parts input').length), 1);
  assert.deepEqual(tab.faults, []);
}

/** A STEP file that takes a while: many copies of one. */
function slowFile() {
  const surface = JSON.parse(readFileSync(modelAt('trimmed_hundred_holes.json'), 'utf8'));
  return JSON.stringify({ ...surface, surfaces: Array.from({ length: 400 }, () => surface.surfaces[0]) });
}
async function cancelAndClose({ assert, browser, server }) {
  const tab = await opened(browser, server.address, 'teapot.bpt'), slow = slowFile();
  await tab.drop('slow.json', slow);
  await tab.evaluate(() => document.getElementById('cancel').click());
  await tab.wait(() => /was cancelled/.test(document.getElementById('live').textContent));
  assert.equal(await tab.evaluate(() => document.getElementById('busy').hidden), true);
  await tab.dropFile(modelAt('sphere.json'));
  await tab.shown('sphere.json');
  assert.deepEqual(tab.faults, []);
  await tab.drop('slow.json', slow);
  await tab.page.close();
  await (await opened(browser, server.address, 'sphere.json')).page.close();
}

async function serverIsClosed({ assert, server }) {
  const { port } = new URL(server.address);
  const statusOf = (path, headers = {}, method = 'GET') => new Promise((resolve, reject) => {
    request({ host: '127.0.0.1', port, path, headers, method }, (response) => resolve(response.resume().statusCode))
      .on('error', reject).end();
  });
  assert.equal(await statusOf('/'), 200);
  const outside = ['/../../../../etc/passwd', '/%2e%2e/%2e%2e/etc/passwd', '/src/..%2f..%2f..%2fetc/passwd',
    '/.git/config', '/src', '/model/x', '/%00', '/%'];
  for (const path of outside)
    assert.ok([400, 404].includes(await statusOf(path)), path);
  assert.equal(await statusOf('/', { host: 'example.com' }), 403);
  assert.equal(await statusOf('/', {}, 'POST'), 405);
}

async function audit({ assert, browser, server }) {
  const faults = [];
  const check = async (tab, where) => {
    await tab.evaluate(axe());
    const { violations } = await tab.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
    for (const { id, nodes } of violations)
      faults.push(`${where}: ${id}: ${nodes.map((node) => node.html.slice(0, 120)).join(' | ')}`);
  };
  for (const [scheme, width] of [['light', 1280], ['dark', 1280], ['light', 375]]) {
    const tab = await Tab.open(browser, server.address, { scheme, width });
    await check(tab, `${scheme} ${width} empty`);
    await tab.dropFile(bearing);
    await tab.shown('bearing_block.step');
    await tab.key('3');
    await tab.key('Enter');
    await check(tab, `${scheme} ${width}`);
    await tab.page.click('#help');
    await check(tab, `${scheme} ${width} help`);
  }
  assert.deepEqual(faults, []);
}

export const cases = {
  dropAndFollow, pickExactly, modes, tree, save, errors, keyboard, touch, colours, sources, measures,
  comesMeanwhile, cancelAndClose, serverIsClosed, audit,
};
