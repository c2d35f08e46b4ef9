// Tessera in browsers and in Node: parametric surfaces to meshes whose error is proven, and rays that meet the surfaces.
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
import { unpacked } from './src/packed.js';
import { Patches } from './src/patches.js';
import { Plan } from './src/plan.js';
import { Scene } from './src/rays.js';

export { Mesh, Model, Patches, Plan, Scene, TesseraError };

const moduleBeside = () => new URL('./tessera.wasm', import.meta.url);

/** Compiles the module, for several init() that share it. */
export function compile(source = moduleBeside()) { return compiled(source); }

/** Makes an instance, with memory of its own. `source`: tessera.wasm elsewhere: bytes, an address, or compiled. */
export async function init(source = moduleBeside()) { return new Tessera(await Module.load(source, layout)); }

class Tessera {
  #module;
  constructor(module) { this.#module = module; }

  get version() {
    const number = this.#module.exports.tsr_version();
    return [number / 10000, (number / 100) % 100, number % 100].map(Math.floor).join('.');
  }
  get memoryBytes() { return this.#module.exports.memory.buffer.byteLength; }
  read(name, bytes, options) { return Model.read(this.#module, name, bytes, options); }
  async open(name, bytes, options) {
    const file = await unpacked(name, bytes);
    return Model.read(this.#module, file.name, file.bytes, options);
  }
  bspline(splines) { return Model.ofSplines(this.#module, splines); }
}
