// Wrong arguments, objects that were disposed or are of another instance, calls from progress(), and a trap.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { block, codeOf, core, errorOf, its, load, square, teapot } from './package.mjs';

const wrongLists = [undefined, null, 5, 'text', {}, ['a', 'b', 'c'], [null, 0, 0], [, 0, 0], new BigInt64Array(3),
  new DataView(new ArrayBuffer(24)), [1, 2]];

function detached(array) {
  structuredClone(array.buffer, { transfer: [array.buffer] });
  return array;
}

test('wrong arguments are errors with a sentence', async () => {
  const tessera = await load(), model = tessera.read('a.bpt', teapot), patches = model.patches();
  const plan = patches.plan({ tolerance: 0.1 }), mesh = plan.write(), scene = patches.rays();
  const calls = [
    () => tessera.read(), () => tessera.read('a.bpt'), () => tessera.read(5, teapot), () => tessera.read('a.bpt', 5),
    () => tessera.read('a.bpt', {}), () => tessera.read('a.bpt', [1, 2]), () => tessera.read('a.bpt', teapot, 5),
    () => tessera.read('a.bpt', teapot, { fromat: 'bpt' }), () => tessera.read('a.bpt', teapot, { format: 5 }),
    () => tessera.read('a.bpt', detached(new Uint8Array(9))), () => tessera.open('a.bpt', detached(new Uint8Array(9))),
    () => tessera.read('a.bpt', teapot, { progress: 5 }), () => tessera.read('a.bpt', teapot, { signal: {} }),
    () => tessera.open(), () => tessera.open('a.bpt', null), () => tessera.open('a.bpt', teapot, { wrong: 1 }),
    () => tessera.bspline(), () => tessera.bspline([null]), () => tessera.bspline([{}]),
    () => tessera.bspline([{ ...square, degreeU: 1.5 }]), () => tessera.bspline([{ ...square, degreeU: -1 }]),
    () => tessera.bspline([{ ...square, countU: 2 ** 31 }]), () => tessera.bspline([{ ...square, weights: [1] }]),
    () => tessera.bspline([{ ...square, weights: 'abcd' }]), () => tessera.bspline([{ ...square, knotsU: 5 }]),
    () => tessera.bspline([{ ...square, name: 5 }]), () => tessera.bspline([{ ...square, colour: 5 }]),
    ...wrongLists.map((points) => () => tessera.bspline([{ ...square, points }])),
    ...[-1, 0.5, 32, NaN, Infinity, 2 ** 32, '0', null, undefined, 0n].flatMap((index) => [
      () => model.surface(index), () => model.instance(index), () => model.shape(index), () => patches.patch(index)]),
    () => model.join('far'), () => model.join(NaN), () => model.join(-1), () => model.save(), () => model.save('stl'),
    () => model.measure({ accuracy: 'high' }), () => model.measure({ bodies: 1 }), () => model.measure({ accuracy: NaN }),
    () => model.patches(5), () => model.patches({ shape: 0 }), () => model.patches({ shape: -1 }),
    () => model.patches({ whole: 'no' }), () => model.patches({ fitTolerance: NaN }), () => model.patches([]),
    ...[[0.5], [-1], [2 ** 32], [NaN], ['0'], '0', null, undefined, new Float64Array([0.5]), new BigUint64Array(1)]
      .map((which) => () => patches.edit(which, new Float64Array(48))),
    ...wrongLists.map((points) => () => patches.edit([0], points)),
    () => patches.edit([0], detached(new Float64Array(48))), () => patches.edit([99], new Float64Array(48)),
    () => patches.edit([0], new Float64Array(48).fill(NaN)), () => patches.edit([0, 0], new Float64Array(48)),
    () => patches.evaluate(0, 0.5), () => patches.evaluate(99, 0.5, 0.5), () => patches.evaluate(-1, 0.5, 0.5),
    () => patches.evaluate([0], [0.5, 0.5], [0.5, 0.5]), () => patches.evaluate(0, [0], [0, 1]),
    () => patches.evaluate(0, 0, 0, 'position'), () => patches.evaluate(0, 0, 0, ['toString']),
    () => patches.evaluate(0, 0, 0, [Symbol('s')]), () => patches.evaluate(0, '0', 0),
  ];
  for (const call of calls) assert.notEqual(await codeOf(call), 'internal', `${call}`);
  assert.ok(mesh.positions.length > 0 && scene.info.spawnOffset > 0);
});

test('wrong options of plans and rays are errors', async () => {
  const tessera = await load(), patches = tessera.read('a.bpt', teapot).patches();
  const plan = patches.plan({ tolerance: 0.1 }), mesh = plan.write(), scene = patches.rays();
  const view = { eye: [0, -9, 0], target: [0, 0, 0], up: [0, 0, 1] };
  const calls = [
    () => patches.plan(), () => patches.plan({}), () => patches.plan({ tolerance: NaN }), () => patches.plan({ angle: 9 }),
    () => patches.plan({ tolerance: -1 }), () => patches.plan({ tolerance: Infinity }), () => patches.plan({ tolerance: '1' }),
    () => patches.plan({ rates: 0.5 }), () => patches.plan({ rates: [1] }), () => patches.plan({ rates: 5000 }),
    () => patches.plan({ rates: -1 }), () => patches.plan({ rates: [NaN, 1] }), () => patches.plan({ rates: {} }),
    () => patches.plan({ tolerance: 1, maxTriangles: 0.5 }), () => patches.plan({ tolerance: 1, maxTriangles: Infinity }),
    () => patches.plan({ tolerance: 1e-3, maxTriangles: 3 }), () => patches.plan({ tolerance: 1, parameters: 'toString' }),
    () => patches.plan({ tolerance: 1, parameters: Symbol('s') }), () => patches.plan({ tolerance: 1, edges: 1 }),
    () => patches.plan({ surfaceTolerances: [1] }), () => patches.plan({ surfaceTolerances: 'all' }),
    () => patches.plan({ pixels: 1, view: 5 }), () => patches.plan({ pixels: 1, view: { ...view, eye: 5 } }),
    () => patches.plan({ pixels: 1, view: { ...view, eye: [0, 0] } }), () => patches.plan({ pixels: 1, view: { from: 1 } }),
    () => patches.plan({ pixels: 1, view: { ...view, eye: [NaN, 0, 0] } }), () => patches.plan({ pixels: 1, view: [] }),
    () => patches.plan({ pixels: 1, view: { ...view, width: -1 } }), () => patches.plan({ pixels: 1, view: { ...view, width: 1e10 } }),
    () => plan.write(5), () => plan.write({}), () => plan.write(undefined, 5), () => plan.write(null, { parameters: 1 }),
    () => plan.write(patches), () => plan.update(), () => plan.update({}), () => plan.update(mesh, { points: [1, 2, 3] }),
    () => plan.update(mesh, { patches: [0], points: [1] }), () => plan.update(mesh, { view: { eye: 1 } }),
    () => plan.update(mesh, { patches: [99], points: new Float64Array(48) }), () => mesh.save(), () => mesh.save('bpt'),
    () => mesh.save('g\0lb'), () => patches.rays({ tolerance: NaN }), () => patches.rays({ pieces: 3 }),
    () => patches.rays({ editable: 1 }), () => scene.closest([0, 0, 0]), () => scene.closest([0, 0], [0, 0, 1]),
    () => scene.closest([0, 0, 0, 0, 0, 0], [0, 0, 1]), () => scene.closest([0, 0, 0], 'abc'), () => scene.refit(),
    () => scene.closest([0, 0, 0], [0, 0, 1], { quantities: ['constructor'] }),
    () => scene.closest([0, 0, 0], [0, 0, 1], { quantities: 't' }), () => scene.closest([0, 0, 0], [0, 0, 1], { near: 'a' }),
    () => scene.closest([0, 0, 0], [0, 0, 1], { far: [1, 2] }), () => scene.occluded([0, 0, 0], [0, 0, 1], { quantities: ['t'] }),
  ];
  const noError = [];
  for (const call of calls)
    await codeOf(call).then((code) => assert.notEqual(code, 'internal', `${call}`), () => noError.push(`${call}`));
  assert.deepEqual(noError, ['() => scene.refit()']);
});

test('an error names the element', async () => {
  const tessera = await load(), patches = tessera.bspline([square]).patches();
  assert.equal((await errorOf(() => patches.edit([0, 1.5], []))).index, 1);
  assert.equal((await errorOf(() => tessera.bspline([square, { ...square, weights: [1, 1, 1, -1] }]))).index, 1);
  const error = await errorOf(() => tessera.read('cut.bpt', 'garbage'));
  assert.deepEqual([error.name, error.code, error.index], ['TesseraError', 'parse_error', -1]);
  assert.match(error.message, /^cut\.bpt:1: expected/);
});

test('disposed objects are errors, and what was made of them goes on', async () => {
  const tessera = await load(), model = tessera.read('block.step', block), patches = model.patches();
  const plan = patches.plan({ tolerance: 0.1, edges: true }), mesh = plan.write(), scene = patches.rays();
  model.dispose();
  patches.dispose();
  patches.dispose();
  assert.ok(model.isDisposed && patches.isDisposed && patches.count > 0);
  const again = plan.write(mesh);
  assert.ok(again === mesh && mesh.save('glb').length > 1000 && scene.closest([0, 0, 0], [0, 0, 1]).t.length === 1);
  for (const call of [() => model.patches(), () => model.surface(0), () => model.warnings, () => model.save('bpt'),
    () => model.measure(), () => model.join(), () => model.instance(0), () => model.shape(0), () => patches.plan({ tolerance: 1 }),
    () => patches.rays(), () => patches.patch(0), () => patches.edit([], []), () => patches.evaluate(0, 0, 0),
    () => patches.surfaces])
    assert.equal(await codeOf(call), 'invalid_handle', `${call}`);
  plan.dispose();
  assert.ok(mesh.check().triangles > 0);
  mesh.dispose();
  scene.dispose();
  for (const call of [() => plan.write(), () => plan.update(mesh), () => mesh.positions, () => mesh.normals, () => mesh.edges,
    () => mesh.triangles, () => mesh.copy(), () => mesh.check(), () => mesh.save('glb'), () => scene.info,
    () => scene.closest([0, 0, 0], [0, 0, 1]), () => scene.refit()])
    assert.equal(await codeOf(call), 'invalid_handle', `${call}`);
});

test('a plan refuses meshes that it cannot write', async () => {
  const [one, two] = [await load(), await load()].map((each) => each.bspline([square]).patches());
  const plan = one.plan({ rates: 2 }), mesh = plan.write(), second = one.plan({ rates: 3 });
  const foreign = two.plan({ rates: 2 }).write();
  assert.match((await errorOf(() => plan.write(foreign))).message, /another instance/);
  assert.match((await errorOf(() => plan.update(foreign))).message, /another instance/);
  assert.match((await errorOf(() => plan.write(one.model.patches().plan({ rates: 1 }).write()))).message, /other Patches/);
  assert.match((await errorOf(() => second.update(mesh))).message, /wrote last/);
  mesh.dispose();
  assert.equal(await codeOf(() => plan.write(mesh)), 'invalid_handle');
  assert.equal(await codeOf(() => plan.update(mesh)), 'invalid_handle');
  assert.equal(second.write().triangleCount, 18);
});

test('scenes of an earlier state are stale', async () => {
  const tessera = await load(), patches = tessera.bspline([square]).patches();
  const scene = patches.rays();
  patches.edit([0], square.points.map((x) => 2 * x));
  assert.equal(await codeOf(() => scene.closest([0, 0, 1], [0, 0, -1])), 'stale');
});

test('progress() cannot use the instance, and its error ends the call', async () => {
  const tessera = await load(), model = tessera.read('block.step', block), patches = model.patches();
  const plan = patches.plan({ tolerance: 0.1 }), mesh = plan.write();
  const uses = [() => model.patches(), () => tessera.read('a.bpt', teapot), () => mesh.dispose(), () => patches.dispose(),
    () => plan.write(mesh), () => model.surface(0), () => mesh.save('glb'), () => plan.write()];
  for (const use of uses) {
    const codes = [];
    plan.write(mesh, { progress: () => {
      try {
        use();
      } catch (error) {
        codes.push(error.code);
      }
    } });
    assert.ok(codes.length > 0 && codes.every((code) => code === 'in_use'), `${use}: ${codes}`);
    assert.equal(await codeOf(() => plan.write(mesh, { progress: use })), 'in_use');
  }
  for (const thrown of [undefined, null, 0, 'text', new TypeError('mine')]) {
    const found = (() => {
      try {
        plan.write(mesh, { progress: () => { throw thrown; } });
      } catch (error) {
        return [error];
      }
      return [];
    })();
    assert.deepEqual(found, [thrown]);
  }
  assert.ok(plan.write(mesh).check().triangles > 0);
  const other = await load();
  plan.write(mesh, { progress: () => void other.bspline([square]) });
});

test('after a trap each call says so, and other instances go on', async () => {
  const tessera = await load(), model = tessera.bspline([square]), mesh = model.patches().plan({ rates: 1 }).write();
  const module = tessera[its.module];
  assert.throws(() => module.call('tsr_model_describe', model[its.handle], 0xfffffff0 | 0), { code: 'internal' });
  for (const call of [() => model.patches(), () => tessera.bspline([square]), () => mesh.check(), () => model.surface(0)])
    assert.match((await errorOf(call)).message, /stopped and cannot be used any more/);
  model.dispose();
  mesh.dispose();
  assert.ok((await load()).bspline([square]).surfaceCount === 1);
});

test('another module is an error', async () => {
  await assert.rejects(core.init(new Uint8Array([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0])), /expected tessera\.wasm/);
  await assert.rejects(core.init(new Uint8Array(8)), WebAssembly.CompileError);
  await assert.rejects(core.init('nowhere.wasm'), /ENOENT/);
});
