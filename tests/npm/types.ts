// Uses every member of the package's types; npm.test.mjs compiles it by --strict.
import {
  Mesh, Model, Patches, Plan, Scene, Tessera, TesseraError, compile, init,
  type Hits, type MeshLists, type MeshReport, type PatchInfo, type Spline, type View,
} from 'tessera';
import * as worker from 'tessera/worker';

/** Compiles where the two types are the same. */
type Same<A, B> = (<T>() => T extends A ? 1 : 2) extends <T>() => T extends B ? 1 : 2 ? true : false;
function is<T extends true>(): T | undefined { return undefined; }

const triangle: Spline = { degreeU: 1, degreeV: 1, points: [0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0] };
const view: View = { eye: [0, 0, 5], target: new Float32Array(3), up: [0, 1, 0], width: 10, height: 9 };

export async function inPlace(signal: AbortSignal): Promise<void> {
  const tessera: Tessera = await init(await compile());
  await init(new URL('file:///tessera.wasm'));
  const opened: Model = await tessera.open('a.stpz', new ArrayBuffer(3));
  const model = tessera.read('a.bpt', 'text', { format: 'bpt', signal, progress: (share) => share < 1 });
  const [version, bytes]: [string, number] = [tessera.version, tessera.memoryBytes];
  const knots = { knotsU: [0, 0, 1, 1], knotsV: [0, 0, 1, 1], countU: 2, countV: 2 };
  const bent = tessera.bspline([triangle, { ...triangle, ...knots, name: 'a' }]);
  const { surfaceCount, shapeCount, instanceCount, trimmedCount, warningCount, unit, warnings, isDisposed } = model;
  const { name, kind, domain, loops, instance, shape, face, colour } = model.surface(0);
  const named: string = model.shape(0).name;
  const place: number = model.instance(0).placement[11] + model.instance(0).firstSurface;
  const { area, box, bodies: [body], centroid } = model.measure({ accuracy: 1e-3, bodies: true });
  const volume: number = body.volume + body.volumeError + body.inertia[5] + body.centroid[2] + body.gap + box.low[0];
  const saved: Uint8Array = model.join(0.1).save('json');
  const patches: Patches = model.patches({ shape: 0, whole: false, points: true, double: false, signal });
  const patch: PatchInfo = patches.patch(0);
  patches.edit([0], patch.points);
  const surfaces: Uint32Array = patches.surfaces;
  const { gaussian } = patches.evaluate(0, 0.5, [0.5], ['gaussian', 'du']);
  const { position, normal } = patches.evaluate([0], [0.5], [0.5]);
  const numbers = [patches.count, patches.surfaceCount, patches.cutCount, patches.memoryBytes, patches.revision,
    patches.fitError, patches.unusedLoops, ...patches.origin, ...patches.box.high];
  const plan: Plan = patches.plan({ tolerance: 0.1, pixels: 1, view, rates: [3, 4], parameters: 'unit', edges: true });
  const facts: number[] = [plan.vertices, plan.triangles, plan.tolerance, plan.bound, plan.seenBound, plan.gap,
    plan.angle, plan.pixels, plan.openEdges, plan.crossedPatches];
  const truths: boolean[] = [plan.isCertified, plan.hasNormals, plan.hasParameters, plan.hasEdges];
  const mesh: Mesh = plan.write(null, { parameters: true, progress: (share) => console.log(share), signal });
  const hasChanged: boolean = plan.update(mesh, { patches: [0], points: patch.points, view });
  const report: MeshReport = plan.write(mesh).check();
  const lists: MeshLists = mesh.copy();
  const normals: Float32Array = mesh.normals ?? mesh.parameters ?? mesh.positions;
  const counts = [mesh.vertexCount, mesh.triangleCount, ...mesh.triangles, ...(mesh.edges ?? mesh.trianglePatches)];
  const flags = [mesh.hasNormals, mesh.hasParameters, mesh.isDisposed, mesh.patches === plan.patches, mesh.save('glb')];
  const scene: Scene = patches.rays({ tolerance: 1e-9, pieces: 2, editable: true });
  scene.refit();
  const { t, kind: kinds } = scene.closest([0, 0, 1], [0, 0, -1], { near: 0, far: [9], quantities: ['t', 'kind'] });
  const hits: Pick<Hits, 'uv' | 'surface'> = scene.closest([0, 0, 1], [0, 0, -1]);
  const hidden: Uint8Array = scene.occluded([0, 0, 1], [0, 0, -1], { spawnOffset: scene.info.spawnOffset });
  for (const object of [scene, mesh, plan, patches, model, opened, bent]) object.dispose();
  console.log(version, bytes, surfaceCount, shapeCount, instanceCount, trimmedCount, warningCount, unit, warnings, kind,
    isDisposed, name, domain, loops, instance, shape, face, colour, named, place, area, centroid, volume, saved,
    surfaces, gaussian, position, normal, numbers, facts, truths, hasChanged, report, lists, normals, counts, flags,
    t, kinds, hits, hidden, scene.patches.model);
}

export async function inWorker(signal: AbortSignal): Promise<void> {
  const tessera: worker.Tessera = await worker.init(await worker.compile(), { shared: false });
  const model: worker.Model = await tessera.open('a.stp', new Uint8Array(3), { signal, progress: () => false });
  const bytes: number = await tessera.memoryBytes;
  const patches: worker.Patches = await model.patches({ shape: 0 });
  const plan: worker.Plan = await patches.plan({ tolerance: 0.1 });
  const mesh: worker.Mesh = await plan.write(null, { signal });
  const again: worker.Mesh = await plan.write(mesh);
  const hasChanged = await plan.update(mesh, { view });
  is<Same<typeof hasChanged, boolean>>();
  const positions: Float32Array = await mesh.positions;
  const lists: MeshLists = await again.copy();
  const { gaussian } = await patches.evaluate(0, 0.5, 0.5, ['gaussian']);
  const scene: worker.Scene = await patches.rays();
  const { t } = await scene.closest([0, 0, 1], [0, 0, -1], { quantities: ['t'] });
  const [surface, offset] = [(await model.surface(0)).kind, (await scene.info).spawnOffset];
  const warnings: string[] = await model.warnings;
  const glb: Uint8Array = await mesh.save('glb');
  const parents: [worker.Model, worker.Patches, worker.Patches, worker.Patches] =
    [patches.model, plan.patches, mesh.patches, scene.patches];
  const count: number = model.surfaceCount + patches.count + plan.triangles + mesh.vertexCount;
  await mesh.dispose();
  tessera.terminate();
  console.log(bytes, positions, lists, gaussian, t, surface, offset, warnings, glb, parents, count, mesh.isDisposed,
    mesh instanceof worker.Mesh, new worker.TesseraError('internal', '').code, new TesseraError('stale', '', 1).index);
}

// Wrong uses: each line is an error.
export function wrong(tessera: Tessera, patches: Patches, plan: Plan, mesh: Mesh, there: worker.Plan,
  apart: worker.Mesh) {
  // @ts-expect-error
  tessera.read('a.bpt');
  // @ts-expect-error
  tessera.read('a.bpt', 5);
  // @ts-expect-error
  patches.plan({ tolerence: 1 });
  // @ts-expect-error
  patches.plan({ parameters: 'patches' });
  // @ts-expect-error
  plan.write(patches);
  // @ts-expect-error
  plan.write(apart);
  // @ts-expect-error
  there.write(mesh);
  // @ts-expect-error
  plan.bound = 0;
  // @ts-expect-error
  mesh.positions = new Float32Array(3);
  // @ts-expect-error
  patches.evaluate(0, 0, 0, ['curvature']);
  // @ts-expect-error
  patches.evaluate(0, 0, 0).du;
  // @ts-expect-error
  patches.rays({ pieces: 3 });
  // @ts-expect-error
  patches.handle;
  // @ts-expect-error
  new Mesh();
  // @ts-expect-error
  const count: number = apart.positions.length;
  // @ts-expect-error
  new TesseraError('wrong', '');
  return count;
}
