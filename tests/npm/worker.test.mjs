// The worker: the same results and errors as in place, order, cancelling, disposal, and the end of the worker.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { pathToFileURL } from 'node:url';

import { block, codeOf, compiled, core, errorOf, folder, load, square, teapot, worker } from './package.mjs';

const started = [];
const start = async (options) => {
  const tessera = await worker.init(compiled, options);
  started.push(tessera);
  return tessera;
};
after(() => started.forEach((tessera) => tessera.terminate()));

test('the interface is that of the core', () => {
  const members = (Class) => Object.getOwnPropertyNames(Class.prototype).filter((name) => name !== 'constructor')
    .sort();
  for (const name of ['Tessera', 'Model', 'Patches', 'Plan', 'Mesh', 'Scene']) {
    const own = members(worker[name]).concat(members(Object.getPrototypeOf(worker[name])), ['dispose', 'isDisposed']);
    const missing = members(core[name]).filter((member) => !own.includes(member));
    assert.deepEqual(missing, [], name);
    assert.equal(worker[name].name, name);
  }
});

test('results are those of the core', async () => {
  const here = (await load()).read('block.step', block), model = await (await start()).open('block.step', block);
  assert.ok(model instanceof worker.Model);
  assert.deepEqual({ ...model }, { ...here });
  assert.deepEqual([await model.surface(3), await model.warnings], [here.surface(3), here.warnings]);
  const [own, patches] = [here.patches(), await model.patches()];
  assert.ok(patches.model === model);
  assert.deepEqual({ ...patches }, { ...own });
  const options = { tolerance: 0.1, edges: true };
  const [ownPlan, plan] = [own.plan(options), await patches.plan(options)],
    [ownMesh, mesh] = [ownPlan.write(), await plan.write()];
  assert.deepEqual({ ...plan }, { ...ownPlan });
  assert.ok(mesh instanceof worker.Mesh && mesh.patches === patches && plan.patches === patches);
  assert.equal(mesh.triangleCount, ownMesh.triangleCount);
  assert.deepEqual(await mesh.copy(), ownMesh.copy());
  assert.deepEqual(await mesh.positions, ownMesh.positions.slice());
  assert.deepEqual(await mesh.save('glb'), ownMesh.save('glb'));
  assert.deepEqual(await model.measure(), here.measure());
  const rays = [[0, 0, 100], [0, 0, -1, 0, 0.1, -1]], scene = await patches.rays();
  assert.deepEqual(await scene.closest(...rays), own.rays().closest(...rays));
  assert.deepEqual(await scene.info, own.rays().info);
});

test('lists are copies each time, and arguments that cannot be sent are errors of their call alone', async () => {
  const model = await (await start()).open('block.step', block), patches = await model.patches();
  const own = (await load()).read('block.step', block).patches(), ownMesh = own.plan({ tolerance: 1, edges: true }).write();
  own.surfaces.fill(7), ownMesh.edges.fill(7);
  for (let k = 0; k < 3; ++k) assert.deepEqual(await patches.surfaces, own.surfaces);
  const plan = await patches.plan({ tolerance: 1, edges: true });
  assert.equal(await codeOf(() => plan.write(plan.write())), 'invalid_argument');
  const mesh = await plan.write();
  for (let k = 0; k < 3; ++k) assert.deepEqual(await mesh.edges, ownMesh.edges);
});

test('edits and updates change the values of their objects', async () => {
  const patches = await (await (await start()).bspline([square])).patches();
  const plan = await patches.plan({ tolerance: 0.1, headroom: 0.5 }), mesh = await plan.write();
  const points = Float64Array.from(square.points, (x, k) => (k % 3 === 2 ? 1 : x));
  const update = plan.update(mesh, { patches: [0], points });
  points.fill(9);  // arguments are those of the call
  await update;
  assert.deepEqual([patches.revision, patches.box.high[2]], [1, 1]);
  assert.ok((await plan.write(mesh)) === mesh);
});

test('errors are those of the core', async () => {
  const tessera = await start(), here = await load();
  for (const call of [(t) => t.read('cut.bpt', 'garbage'), (t) => t.read('a.step', block.subarray(0, 500)),
    (t) => t.read(5),
    (t) => t.bspline([square, { ...square, weights: [1, 1, 1, -1] }]), (t) => t.read('a.bpt', teapot, { fromat: 1 })]) {
    const [there, own] = [await errorOf(() => call(tessera)), await errorOf(() => call(here))];
    assert.deepEqual([there.name, there.code, there.message, there.index],
      [own.name, own.code, own.message, own.index]);
  }
  assert.equal(await codeOf(() => tessera.read('a.bpt', () => 5)), 'invalid_argument');
  assert.equal(await codeOf(() => tessera.read('a.bpt', teapot, { progress: 5 })), 'invalid_argument');
  assert.equal(await codeOf(() => tessera.read('a.bpt', teapot, { signal: {} })), 'invalid_argument');
  const bytes = new Uint8Array(9);
  structuredClone(bytes.buffer, { transfer: [bytes.buffer] });
  assert.equal(await codeOf(() => tessera.read('a.bpt', bytes)), 'invalid_argument');
});

test('calls run in their order, also where one fails', async () => {
  const tessera = await start(), order = [];
  const note = (name) => (value) => void order.push(`${name} ${value?.code ?? 'done'}`);
  const model = tessera.read('block.step', block);
  const calls = [model.then(note('one')), tessera.read('a.bpt', 'garbage').catch(note('two')),
    tessera.bspline([square]).then(note('three')), tessera.memoryBytes.then(note('four'))];
  await Promise.all(calls);
  assert.deepEqual(order, ['one done', 'two parse_error', 'three done', 'four done']);
});

test('disposed objects, and objects of another worker, are errors', async () => {
  const [one, two] = [await start(), await start()];
  const [patches, other] = await Promise.all([one, two].map(async (each) => (await each.bspline([square])).patches()));
  const plan = await patches.plan({ rates: 2 }), mesh = await plan.write();
  const foreign = await (await other.plan({ rates: 1 })).write();
  assert.match((await errorOf(() => plan.write(foreign))).message, /another instance/);
  const last = plan.write(mesh), disposal = mesh.dispose();  // the call before the disposal is done
  await Promise.all([last, disposal, mesh.dispose()]);
  assert.ok(mesh.isDisposed);
  assert.match((await errorOf(() => mesh.positions)).message, /this Mesh was disposed/);
  assert.equal(await codeOf(() => plan.write(mesh)), 'invalid_handle');
  assert.equal((await plan.write()).triangleCount, 8);
});

for (const shared of [true, false]) {
  test(`a call is cancelled, ${shared ? 'with' : 'without'} shared memory`, async () => {
    const tessera = await start({ shared }), kept = await tessera.bspline([square]);
    const many = await tessera.bspline(Array(5000).fill(square));
    const control = new AbortController(), { signal } = control;
    const running = many.measure({ signal, progress: () => control.abort() });
    const waiting = many.patches({ signal }), next = tessera.bspline([square]), using = kept.patches();
    const ends = await Promise.allSettled([running, waiting, next, using]);
    assert.deepEqual(ends.slice(0, 2).map(({ reason }) => reason.code), ['cancelled', 'cancelled']);
    assert.equal(ends[2].value.surfaceCount, 1);
    if (shared) {
      assert.equal(ends[3].value.count, 1);
    } else {
      assert.match(ends[3].reason.message, /ended with its worker: a running call was cancelled/);
      assert.ok(kept.isDisposed && many.isDisposed);
      await kept.dispose();
      assert.equal(await codeOf(() => many.patches()), 'invalid_handle');
    }
    assert.equal(await codeOf(() => tessera.read('a.bpt', teapot, { signal })), 'cancelled');
    const stop = { progress: () => false };
    assert.equal(await codeOf(() => tessera.read('block.step', block, stop)), 'cancelled');
    await assert.rejects(tessera.read('block.step', block, { progress: () => { throw new RangeError('mine'); } }),
      /mine/);
    const shares = [];
    assert.ok((await tessera.read('block.step', block,
      { progress: (share) => void shares.push(share) })).surfaceCount > 0);
    assert.ok(shares.at(-1) === 1 && shares.every((share, k) => share > (shares[k - 1] ?? 0)));
  });
}

test('the end of a worker rejects what runs and what waits', async () => {
  const tessera = await start(), model = await tessera.bspline(Array(5000).fill(square));
  const calls = [model.measure(), model.patches(), tessera.memoryBytes, model.dispose()];
  tessera.terminate();
  tessera.terminate();
  const ends = await Promise.all(calls.map((call) => call.then(() => 'done', (error) => error.code)));
  assert.deepEqual(ends, ['cancelled', 'invalid_handle', 'invalid_handle', 'done']);
  assert.match((await errorOf(() => tessera.bspline([square]))).message, /it was terminated/);
  assert.ok(model.isDisposed);
});

test('a worker that cannot start is an error', async () => {
  await assert.rejects(worker.init('nowhere.wasm'), /ENOENT/);
  await assert.rejects(worker.init(new Uint8Array([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0])), { code: 'internal' });
});

test('a program ends while an idle worker stands, and while one computes', () => {
  const address = JSON.stringify(pathToFileURL(join(folder, 'worker/index.js')).href);
  const run = (text) => spawnSync(process.execPath, ['--input-type=module', '-e',
    `import { init } from ${address}; const tessera = await init(); ${text}`], { encoding: 'utf8', timeout: 60_000 });
  const squares = `Array(3000).fill(${JSON.stringify(square)})`;
  for (const text of ['console.log(tessera.version)',
    'await init(new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0])).catch(({ code }) => console.log(code))',
    `(await tessera.bspline(${squares})).measure().catch(() => {});
      setTimeout(() => { console.log(1); process.exit(0) }, 50)`]) {
    const { status, stdout, stderr } = run(text);
    assert.ok(status === 0 && stdout.length > 1, stderr);
  }
});
