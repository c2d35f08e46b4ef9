// Tessera in browsers and Node: parametric surfaces to meshes whose error is proven, and rays that meet the surfaces.
//
//   import { init } from 'tessera';
//   const tessera = await init();
//   const model = tessera.read('part.step', bytes);
//   const plan = model.patches().plan({ tolerance: 0.01 });
//   const mesh = plan.write();
//   console.log(mesh.triangleCount, plan.bound, mesh.positions, mesh.triangles);
import { TesseraError } from './src/errors.js';
import { compiled } from './src/host.js';
import { layout } from './src/layout.js';
import { Mesh } from './src/mesh.js';
import { Model } from './src/model.js';
import { Module } from './src/module.js';
import { Patches } from './src/patches.js';
import { Plan } from './src/plan.js';
import { Scene } from './src/rays.js';
import { Tessera } from './src/tessera.js';

export { Mesh, Model, Patches, Plan, Scene, Tessera, TesseraError };

const moduleBeside = () => new URL('./tessera.wasm', import.meta.url);

export function compile(source = moduleBeside()) { return compiled(source); }

export async function init(source = moduleBeside()) { return new Tessera(await Module.load(source, layout)); }
