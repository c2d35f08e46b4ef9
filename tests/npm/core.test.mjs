// The results of the package: models, meshes, rays, points, measures.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { block, core, fileOf, load, square, teapot } from './package.mjs';

test('the version is that of the package', async () => {
  const tessera = await load();
  const { version, name } = JSON.parse(fileOf('tools/npm/package.json'));
  assert.equal(tessera.version, version);
  assert.ok(name);
});

test('twelve lines: a mesh of a STEP file', async () => {
  const tessera = await load(), model = tessera.read('block.step', block);
  assert.ok(model.surfaceCount > 10 && model.unit === 'mm');
  const patches = model.patches(), plan = patches.plan({ tolerance: 0.05, edges: true }), mesh = plan.write();
  assert.equal(mesh.positions.length, 3 * plan.vertices);
  assert.equal(mesh.triangles.length, 3 * plan.triangles);
  assert.ok(plan.bound > 0 && plan.bound <= 0.05 && plan.isCertified);
  assert.ok(mesh.triangles.every((vertex) => vertex < mesh.vertexCount));
  assert.ok(mesh.trianglePatches.every((patch) => patch < patches.count));
  assert.ok(mesh.edges.length > 0 && mesh.edges.every((vertex) => vertex < mesh.vertexCount));
  assert.ok(mesh.normals.every(Number.isFinite) && mesh.parameters.every(Number.isFinite));
  const { openEdges, flippedTriangles, nonFiniteVertices } = mesh.check();
  assert.deepEqual([openEdges, flippedTriangles, nonFiniteVertices], [plan.openEdges, 0, 0]);
  const glb = mesh.save('glb');
  assert.equal(new TextDecoder().decode(glb.subarray(0, 4)), 'glTF');
  const { volume, volumeError, isProven } = model.measure().bodies[0];
  assert.ok(volume > 0 && volumeError < 0.01 * volume && isProven);
  assert.deepEqual(core.TesseraError.prototype instanceof Error, true);
});

test('a copy of a mesh outlives it', async () => {
  const tessera = await load(), mesh = tessera.bspline([square]).patches().plan({ rates: 2 }).write();
  const copy = mesh.copy(), positions = [...mesh.positions];
  mesh.dispose();
  assert.deepEqual([...copy.positions], positions);
  assert.equal(copy.edges, null);
  assert.equal(copy.triangles.length, 3 * 8);
});

test('points, rays and patches of a square', async () => {
  const tessera = await load(), patches = tessera.bspline([{ ...square, name: 'floor' }]).patches({ points: true });
  assert.deepEqual(patches.patch(0).points, new Float64Array(square.points));
  assert.equal(patches.patch(0).weights, null);
  assert.deepEqual([...patches.surfaces], [0]);
  const { position, normal } = patches.evaluate(0, [0.25, 0.5], [0.5, 1]);
  assert.deepEqual([...position], [0.25, 0.5, 0, 0.5, 1, 0]);
  assert.deepEqual([...normal], [0, 0, 1, 0, 0, 1]);
  const scene = patches.rays();
  const { kind, t, uv } = scene.closest([0.25, 0.75, 2], [0, 0, -1, 0, 0, 1]);
  assert.deepEqual([[...kind], [...t], [...uv]], [[1, 0], [2, Infinity], [0.25, 0.75, 0, 0]]);
  assert.deepEqual([...scene.occluded([0.5, 0.5, 1], [0, 0, -1], { far: 0.5 })], [0]);
  assert.deepEqual([...scene.occluded([], [])], []);
  assert.equal(scene.closest([], []).t.length, 0);
});

test('edits are followed', async () => {
  const tessera = await load(), patches = tessera.bspline([square]).patches();
  const scene = patches.rays({ editable: true }), plan = patches.plan({ tolerance: 0.1, headroom: 0.5 });
  const mesh = plan.write(), lifted = square.points.map((x, k) => (k % 3 === 2 ? 1 : x));
  plan.update(mesh, { patches: [0], points: lifted });
  assert.equal(patches.revision, 1);
  assert.equal(patches.box.high[2], 1);
  assert.ok(mesh.positions.filter((_, k) => k % 3 === 2).every((z) => z + mesh.origin[2] === 1));
  scene.refit();
  assert.deepEqual([...scene.closest([0.5, 0.5, 3], [0, 0, -1]).t], [2]);
  patches.edit([0], square.points);
  assert.equal(patches.revision, 2);
});

test('a plan in pixels follows the view', async () => {
  const tessera = await load(), patches = tessera.read('teapot.bpt', teapot).patches();
  const view = (distance) => ({ eye: [0, -distance, 2], target: [0, 0, 1], up: [0, 0, 1], width: 800, height: 600 });
  const plan = patches.plan({ pixels: 0.5, view: view(30) }), mesh = plan.write(), far = plan.triangles;
  assert.equal(plan.update(mesh, { view: view(8) }), true);
  assert.ok(plan.triangles > far && plan.pixels <= 0.5);
  assert.equal(mesh.triangleCount, plan.triangles);
  assert.equal(plan.update(mesh, { view: view(8) }), false);
});

test('a model is written and read again', async () => {
  const tessera = await load(), model = tessera.read('teapot.bpt', teapot);
  for (const format of ['json', 'bpt', 'obj']) {
    const again = tessera.read(`teapot.${format}`, model.save(format));
    assert.equal(again.surfaceCount, model.surfaceCount);
  }
  assert.equal(tessera.read('noname', teapot, { format: 'bpt' }).surfaceCount, 32);
  assert.equal(tessera.read('a.bpt', teapot.toString()).surfaceCount, 32);
  assert.equal(tessera.read('a.bpt', Uint8Array.from(teapot).buffer).surfaceCount, 32);
});

test('the facts of a STEP file', async () => {
  const tessera = await load(), model = tessera.read('block.step', block);
  const surface = model.surface(0), instance = model.instance(0);
  assert.deepEqual([surface.instance, surface.shape, surface.face], [0, 0, 0]);
  assert.equal(instance.placement.length, 12);
  assert.equal(typeof model.shape(0).name, 'string');
  assert.deepEqual(model.warnings, []);
  const faces = Array.from({ length: model.surfaceCount }, (_, k) => model.surface(k))
    .filter(({ shape }) => shape === 0);
  assert.equal(model.patches({ shape: 0 }).surfaceCount, new Set(faces.map(({ face }) => face)).size);
});

test('reading and packing report progress, and are cancelled', async () => {
  const tessera = await load();
  for (const begin of [(run) => tessera.read('block.step', block, run),
    (run) => tessera.read('block.step', block).patches(run)]) {
    const shares = [];
    begin({ progress: (share) => void shares.push(share) });
    assert.ok(shares.length > 1 && shares.at(-1) === 1, `${shares}`);
    assert.ok(shares.every((share, k) => share > (shares[k - 1] ?? 0)), `${shares}`);
    assert.throws(() => begin({ progress: () => false }), { code: 'cancelled' });
    assert.throws(() => begin({ progress: () => { throw new RangeError('mine'); } }), /mine/);
    const control = new AbortController();
    assert.throws(() => begin({ signal: control.signal, progress: () => control.abort() }), { code: 'cancelled' });
    assert.throws(() => begin({ signal: control.signal }), { code: 'cancelled' });
  }
});
