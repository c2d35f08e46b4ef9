// Memory: nothing stays after errors, views and growth, models that are too large, two instances.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { block, codeOf, its, liveBytes, load, square, teapot } from './package.mjs';

test('a thousand errors leave nothing', async () => {
  const tessera = await load(), live = liveBytes(tessera), begin = live();
  const model = tessera.read('a.bpt', teapot), patches = model.patches(), plan = patches.plan({ tolerance: 0.1 });
  const mesh = plan.write(), scene = patches.rays(), held = live();
  const late = { progress: (share) => { if (share === 1) throw new Error('late'); } };
  const calls = [
    () => tessera.read('a.bpt', 'garbage'), () => tessera.read('a.step', block.subarray(0, 200)),
    () => tessera.read('a.step', block, late), () => tessera.read('a.step', block, { progress: () => false }),
    () => model.patches(late), () => model.patches({ shape: 1 }), () => patches.plan({ tolerance: 0.1, ...late }),
    () => patches.plan({ tolerance: 0.1, view: { eye: [1] } }), () => plan.write(null, late), () => plan.write(mesh, late),
    () => plan.write(null, { progress: () => false }), () => patches.rays(late), () => patches.rays({ pieces: 5 }),
    () => scene.closest([0, 0, 0], [0, 0, 1], { far: ['x'] }), () => scene.closest([0, 0, 0], [0, 0, 1], late),
    () => tessera.bspline([square, { ...square, weights: [1, 1, 1, NaN] }]), () => patches.edit([0], [1, 2, 3]),
    () => patches.evaluate(0, [0, 1], [0, 'x']), () => mesh.save('nothing'), () => model.save('nothing'),
    () => plan.update(mesh, { patches: [0], points: [1, 2, 3] }), () => model.measure(late), () => model.surface(99),
  ];
  const once = () => calls.forEach((call) => assert.throws(call, `${call}`));
  for (let k = 0; k < 5; ++k) once();
  const bytes = tessera.memoryBytes;
  for (let k = 0; k < 1000 / calls.length; ++k) once();
  assert.equal(live(), held);
  assert.equal(tessera.memoryBytes, bytes);
  for (const object of [mesh, scene, plan, patches, model]) object.dispose();
  assert.equal(live(), begin);
});

test('objects that are made and disposed leave nothing', async () => {
  const tessera = await load(), live = liveBytes(tessera);
  const once = () => {
    const model = tessera.read('block.step', block), patches = model.patches(), plan = patches.plan({ tolerance: 0.1 });
    const mesh = plan.write();
    patches.dispose();
    for (const object of [model, plan, mesh]) object.dispose();
  };
  for (let k = 0; k < 5; ++k) once();
  const bytes = tessera.memoryBytes, held = live();
  for (let k = 0; k < 30; ++k) once();
  assert.deepEqual([tessera.memoryBytes, live()], [bytes, held]);
});

test('arguments that are views of the module itself stand when memory grows', async () => {
  const tessera = await load(), patches = tessera.bspline([square]).patches(), module = tessera[its.module];
  const at = module.allocate(8 * 12), list = () => new Float64Array(module.exports.memory.buffer, at, 12);
  list().set(square.points);
  const held = list(), taken = [];
  // Little memory is left, so that the call makes it grow.
  for (let size = 2 ** 20; size >= 64; size /= 2)
    for (let before = tessera.memoryBytes; tessera.memoryBytes === before && taken.length < 1e5;) taken.push(module.allocate(size));
  patches.edit([0], list().map((x) => x + 1));
  patches.edit([0], list());
  assert.deepEqual(patches.patch(0).points, new Float64Array(square.points));
  assert.equal(held.length, 0);  // detached: an error, not zeros
  assert.equal(await codeOf(() => patches.edit([0], held)), 'invalid_argument');
  const { buffer } = module.exports.memory, bytes = new Uint8Array(buffer, module.copy(teapot), teapot.length);
  assert.equal(tessera.read('a.bpt', bytes).surfaceCount, 32);
  module.free(at, ...taken);
});

test('a mesh is used again, and grows', async () => {
  const tessera = await load(), patches = tessera.read('a.bpt', teapot).patches();
  const coarse = patches.plan({ rates: 2 }), fine = patches.plan({ rates: 40 });
  const shared = patches.plan({ rates: 5, shareVertices: true });
  const mesh = coarse.write();
  for (const plan of [fine, shared, coarse, fine, shared]) {
    assert.equal(plan.write(mesh), mesh);
    const { vertices, triangles, flippedTriangles } = mesh.check();
    assert.deepEqual([vertices, triangles], [plan.vertices, plan.triangles]);
    assert.deepEqual([mesh.normals === null, mesh.parameters === null], [!plan.hasNormals, !plan.hasParameters]);
    assert.ok(flippedTriangles >= 0);
  }
  assert.equal(fine.write(null, { parameters: false }).parameters, null);
});

test('what is too large for 2 GB is out_of_memory, and the instance goes on', async () => {
  const tessera = await load(), live = liveBytes(tessera);
  assert.equal(await codeOf(() => tessera.read('a.stp', new Uint8Array(2 ** 31))), 'out_of_memory');
  const patches = tessera.read('a.bpt', teapot).patches(), held = live();
  const mesh = patches.plan({ rates: 2 }).write(), plan = patches.plan({ rates: 3000 });
  assert.ok(plan.triangles > 5e8);
  assert.equal(await codeOf(() => plan.write()), 'out_of_memory');
  assert.equal(await codeOf(() => plan.write(mesh)), 'out_of_memory');
  assert.deepEqual([mesh.vertexCount, mesh.positions.length, mesh.normals], [0, 0, null]);
  assert.equal(patches.plan({ rates: 2 }).write(mesh).check().triangles, 240);
  mesh.dispose();
  assert.equal(live(), held);
});

test('memory that runs out within a call is out_of_memory, and the instance goes on', async () => {
  const tessera = await load(), module = tessera[its.module], patches = tessera.read('a.bpt', teapot).patches(), taken = [];
  for (let size = 2 ** 28; size >= 2 ** 8; size /= 2)
    for (let at; (at = module.exports.malloc(size)) !== 0;) taken.push(at);
  assert.ok(tessera.memoryBytes > 2 ** 31 - 2 ** 20);
  for (const call of [() => tessera.read('block.step', block), () => patches.plan({ tolerance: 1e-3 }), () => patches.rays(),
    () => patches.plan({ rates: 9 }), () => patches.model.patches(), () => tessera.bspline(Array(1000).fill(square))])
    assert.equal(await codeOf(call), 'out_of_memory', `${call}`);
  for (const at of taken) module.exports.free(at);
  assert.ok(tessera.read('block.step', block).patches().plan({ tolerance: 0.1 }).write().triangleCount > 0);
});

test('two instances stand side by side', async () => {
  const [one, two] = [await load(), await load()];
  const models = [one.read('a.bpt', teapot), two.bspline([square])];
  const meshes = models.map((model) => model.patches().plan({ rates: 2 }).write());
  assert.deepEqual(meshes.map((mesh) => mesh.triangleCount), [240, 8]);  // four of the teapot's patches have a side that is a point
  models[0].dispose();
  assert.equal(models[1].surface(0).loops, 0);
});
