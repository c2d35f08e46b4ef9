// Tests tessera/three in Node, with objects of the package and of its worker:  node three.mjs PAGE
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { register } from 'node:module';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const root = resolve(import.meta.dirname ?? '.', '../..'), page = resolve(process.argv[2]);
const place = pathToFileURL(join(root, 'tools/web/node_modules/three/build/three.module.js')).href;
// The page has an import map; here 'three' is found by a hook.
register(`data:text/javascript,${encodeURIComponent(
  `export const resolve = (name, context, next) =>
     name === 'three' ? { url: '${place}', shortCircuit: true } : next(name, context);`)}`);
const at = (name) => import(pathToFileURL(join(page, name)).href);
const three = await import('three');
const { ModelObject, arraysOf, coloursOf, geometryOf, surfacesOf, viewOf } = await at('tessera/three/index.js');
const core = await at('tessera/index.js'), worker = await at('tessera/worker/index.js');
const read = (name) => readFileSync(join(root, 'tools/models', name));
const random = ((state) => () => (state = (state * 48271) % 2147483647) / 2147483647)(7);
const vector = (size) => new three.Vector3(...[0, 0, 0].map(() => size * (random() - 0.5)));

/** Where a view shows a point, in pixels from the middle, as the library's documentation defines it. */
function shownAt(view, point) {
  const [eye, target, up] = [view.eye, view.target, view.up].map((each) => new three.Vector3(...each));
  const ahead = target.sub(eye).normalize(), right = ahead.clone().cross(up).normalize(), above = right.clone().cross(ahead);
  const arm = point.clone().sub(eye), shorter = Math.min(view.width, view.height);
  const scale = view.extent ? shorter / view.extent
    : shorter / 2 / Math.tan(view.fieldOfView / 2) / arm.dot(ahead);
  return [arm.dot(right) * scale, arm.dot(above) * scale];
}

function viewsAreThoseOfCameras() {
  for (let k = 0; k < 200; ++k) {
    const [width, height] = [1 + Math.floor(2000 * random()), 1 + Math.floor(2000 * random())];
    const half = 1 + 5 * random(), tall = half * height / width;
    const camera = k % 2 ? new three.PerspectiveCamera(10 + 100 * random(), width / height, 0.1, 100)
      : new three.OrthographicCamera(-half, 1.5 * half, 1.2 * tall, -1.3 * tall, 0.1, 100);
    camera.zoom = 0.5 + random();
    camera.updateProjectionMatrix();
    camera.position.copy(vector(20));
    camera.lookAt(vector(2));
    const parent = new three.Group(), object = new three.Group();
    parent.add(object);
    parent.position.copy(vector(10));
    parent.rotation.set(random(), random(), random());
    parent.scale.setScalar(0.2 + 3 * random());
    const view = viewOf(camera, width, height, object), p = camera.projectionMatrix.elements;
    assert.ok(Number.isInteger(view.width) && Number.isInteger(view.height));
    const point = new three.Vector3(random() - 0.5, random() - 0.5, -8).applyMatrix4(camera.matrixWorld);
    const wanted = point.clone().project(camera), found = shownAt(view, object.worldToLocal(point.clone()));
    // Pixels of the view are at least as fine as those of the picture.
    const fine = Math.max(width * p[0], height * p[5]);
    const expected = [wanted.x / p[0] * fine / 2, wanted.y / p[5] * fine / 2];
    found.forEach((value, c) =>
      assert.ok(Math.abs(value - expected[c]) < 1e-6 * (fine + Math.abs(value)), `${k}: ${found}, expected ${expected}`));
    assert.ok(fine / p[0] <= view.width + 1e-6 && fine / p[5] <= view.height + 1e-6, 'all of the picture is seen');
  }
  const camera = new three.PerspectiveCamera(40, 1, 1, 10), object = new three.Group();
  object.scale.set(1, 2, 1);
  assert.throws(() => viewOf(camera, 100, 100, object), /scaled alike/);
  assert.throws(() => viewOf(camera, 0, 100), /1 or more/);
  camera.setViewOffset(100, 100, 20, 0, 50, 50);
  assert.throws(() => viewOf(camera, 100, 100), /centred/);
}

async function geometries(tessera) {
  const model = await tessera.read('bearing_block.step', read('bearing_block.step')), patches = await model.patches();
  const arrays = await arraysOf(await (await patches.plan({ tolerance: 0.05, edges: true })).write());
  const surfaces = surfacesOf(arrays, await patches.surfaces), faces = await model.surfaces();
  const { colours, ofSurfaces } = coloursOf(faces), hidden = new Uint8Array(faces.length);
  assert.ok(colours.length > 1 && colours.length < 10);
  hidden[3] = 1;
  const geometry = geometryOf(arrays, { ...surfaces, hidden, materials: ofSurfaces });
  const left = surfaces.ofTriangles.filter((surface) => surface !== 3).length;
  assert.equal(geometry.index.count, 3 * left);
  assert.equal(geometry.groups.reduce((sum, { count }) => sum + count, 0), 3 * left);
  for (const { start, count, materialIndex } of geometry.groups)
    for (let k = start; k < start + count; k += 3) assert.equal(ofSurfaces[geometry.userData.surfaces[k / 3]], materialIndex);
  assert.ok(arrays.edges.length > 100 && arrays.edges.every((vertex) => vertex < arrays.positions.length / 3));
  return [arrays.positions, arrays.triangles, surfaces.ofVertices];
}

async function objects(tessera) {
  const model = await tessera.read('sphere.json', read('sphere.json'));
  const object = await ModelObject.make(model, await model.patches());
  const camera = new three.PerspectiveCamera(40, 1.6, 0.1, 20);
  camera.position.set(3, 1, 2);
  camera.lookAt(0, 0, 0);
  assert.equal(object.isProvenFor(camera, 800, 500), false);
  assert.equal(await object.update(camera, 800, 500), true);
  assert.ok(object.isProvenFor(camera, 800, 500) && object.shown.pixels <= 0.5);
  const calls = [1, 2, 3].map((x) => (camera.position.setX(3 + x), object.update(camera, 800, 500)));
  assert.deepEqual(await Promise.all(calls), [true, false, true], 'the newest view comes next');
  for (const [kind, value] of [['gaussian', 1], ['maximum', 1]]) {
    await object.colourBy(kind);
    const found = object.mesh.geometry.getAttribute('curvature').array;
    const off = found.filter((each) => !(Math.abs(each - value) < 1e-4)).length;
    assert.ok(found.length > 100 && off < 0.01 * found.length, `${kind}: ${off} of ${found.length} are not ${value}`);
    assert.ok(Math.abs(object.curvatureRanges[kind] - 1) < 1e-4);
  }
  await assert.rejects(object.colourBy('colour'), /there are/);
  await object.colourBy('surface');
  const before = [...object.mesh.geometry.getAttribute('color').array.slice(0, 4)];
  object.select([0]);
  assert.notDeepEqual([...object.mesh.geometry.getAttribute('color').array.slice(0, 4)], before);
  object.hide([0]);
  assert.equal(object.mesh.geometry.index.count, 0);
  object.hide([0], false);
  assert.equal(object.surfaceOf(0), 0);
  const { low, high } = object.boxOf([0]);
  assert.ok([...low, ...high].every((each) => Math.abs(Math.abs(each) - 1) < 0.01));
  camera.position.setX(9);
  const last = object.update(camera, 800, 500);
  object.dispose();
  assert.equal(await last, false, 'an object that is disposed shows nothing more');
}

viewsAreThoseOfCameras();
const own = await core.init(), remote = await worker.init(join(page, 'tessera/tessera.wasm'));
assert.deepEqual(await geometries(own), await geometries(remote));
for (const tessera of [own, remote]) await objects(tessera);
remote.terminate();
console.log('tessera/three: all passed');
