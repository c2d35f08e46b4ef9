// Tessera in a worker: the interface of 'tessera' with promises.
//
//   import { init } from 'tessera/worker';
//   const tessera = await init();
//   const model = await tessera.open('part.step', bytes, { signal, progress: (share) => show(share) });
//   const plan = await (await model.patches()).plan({ tolerance: 0.01 });
//   const mesh = await plan.write();
//   const { positions, triangles } = await mesh.copy();
import * as core from '../index.js';
import { Line } from './line.js';
import { RemoteObject, remote } from './remote.js';

export const { TesseraError, compile } = core;
export const Model = remote('Model', core.Model), Patches = remote('Patches', core.Patches);
export const Plan = remote('Plan', core.Plan), Mesh = remote('Mesh', core.Mesh), Scene = remote('Scene', core.Scene);
const kinds = { Model, Patches, Plan, Mesh, Scene };

export class Tessera extends remote('Tessera', core.Tessera) {
  terminate() { this.line.terminate(); }
}

/** Starts a worker. `shared`: whether running calls are cancelled through shared memory, where the host has it. */
export async function init(source, { shared = true } = {}) {
  const isShareable = typeof SharedArrayBuffer === 'function' && (globalThis.crossOriginIsolated ?? true);
  const line = new Line(await compile(source), shared && isShareable, kinds);
  return new Tessera(line, 0, await line.start());
}
