// Patch sets: Bezier patches of a model, packed for meshes, rays and points.
import { invalid } from './errors.js';
import { Handle, checkNames, describe, flagsOf, recordsOf, setNumbers } from './handle.js';
import { wholeOf } from './model.js';
import { Plan } from './plan.js';
import { Scene } from './rays.js';

const setNames = ['shape', 'whole', 'double', 'points', 'fitTolerance', 'progress'];
// Quantities of points and their components.
const quantities = {
  position: 3, du: 3, dv: 3, duu: 3, duv: 3, dvv: 3, normal: 3, firstForm: 3, secondForm: 3, gaussian: 1, mean: 1,
  firstCurvature: 1, secondCurvature: 1, firstDirection: 3, secondDirection: 3,
};
const inSnakeCase = (name) => name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`);

export class Patches extends Handle {
  #surfaces = null;

  constructor(model, handle) {
    super(model.module, handle);
    this.#describe();
  }

  static make(model, options) {
    checkNames('patches', options, setNames);
    const { module } = model, { TSR_SET_WHOLE, TSR_SET_DOUBLE, TSR_SET_POINTS } = module.constants;
    return module.scratch(({ struct, run }) => {
      const wanted = struct('tsr_set_options', 'tsr_set_defaults');
      if (options.shape !== undefined) module.set(wanted, 'shape', wholeOf('shape', options.shape));
      setNumbers(module, wanted, options, { fitTolerance: 'fit_tolerance' });
      module.set(wanted, 'flags',
        flagsOf(options, { whole: TSR_SET_WHOLE, double: TSR_SET_DOUBLE, points: TSR_SET_POINTS }));
      return new Patches(model, module.make('tsr_set_new', model.handle, wanted.at, run(options)));
    });
  }

  #describe() {
    const { low, high, unusedLoops, fitError, ...rest } = describe(this.module, 'tsr_set_describe', 'tsr_set_info',
      ['patches', 'surfaces', 'cut_patches', 'memory_bytes', 'revision', 'low', 'high', 'origin', 'fit_error',
        'unused_loops'], this.handle);
    Object.assign(this, {
      count: rest.patches, surfaceCount: rest.surfaces, cutCount: rest.cutPatches, memoryBytes: rest.memoryBytes,
      revision: rest.revision, origin: rest.origin, box: { low, high }, fitError, unusedLoops,
    });
  }

  /** The surface of each patch. */
  get surfaces() {
    if (this.#surfaces) return this.#surfaces;
    const { module, handle } = this, found = new Uint32Array(this.count);
    module.scratch(({ struct }) => {
      const info = struct('tsr_patch_info');
      for (let k = 0; k < found.length; ++k) {
        module.call('tsr_set_patch', handle, k, info.at, 0, 0);
        found[k] = module.get(info, 'surface');
      }
    });
    return (this.#surfaces = found);
  }

  patch(index) {
    const { module, handle } = this;
    return module.scratch(({ keep, struct }) => {
      const info = struct('tsr_patch_info');
      module.call('tsr_set_patch', handle, wholeOf('patch', index), info.at, 0, 0);
      const degreeU = module.get(info, 'degree_u'), degreeV = module.get(info, 'degree_v');
      const count = (degreeU + 1) * (degreeV + 1);
      const points = keep(module.allocate(24 * count)), weights = keep(module.allocate(8 * count));
      module.call('tsr_set_patch', handle, index, info.at, points, weights);
      const numbers = (at, length) => new Float64Array(module.exports.memory.buffer, at, length).slice();
      return {
        degreeU, degreeV, surface: module.get(info, 'surface'), domain: module.get(info, 'domain'),
        isCut: module.get(info, 'is_cut') === 1, points: numbers(points, 3 * count),
        weights: module.get(info, 'is_rational') ? numbers(weights, count) : null,
      };
    });
  }

  edit(patches, points) {
    recordsOf('points', points, 3);
    this.module.scratch(({ numbers }) => this.module.call('tsr_set_edit', this.handle, numbers(patches, Uint32Array),
      patches.length, numbers(points), points.length / 3));
    this.#describe();
  }

  plan(options = {}) { return Plan.make(this, options); }
  rays(options = {}) { return Scene.make(this, options); }

  evaluate(surface, u, v, wanted = ['position', 'normal']) {
    const one = (list) => (typeof list === 'number' ? [list] : list);
    const [us, vs] = [one(u), one(v)], count = recordsOf('u', us, 1);
    if (vs.length !== count) throw invalid(`v: expected ${count} numbers, as u has, found ${vs.length}`);
    const surfaces = typeof surface === 'number' ? new Uint32Array(count).fill(wholeOf('surface', surface)) : surface;
    for (const name of wanted)
      if (!quantities[name]) throw invalid(`${name} is no quantity; there are ${Object.keys(quantities).join(', ')}`);
    const { module } = this;
    return module.scratch(({ keep, struct, numbers }) => {
      const jets = struct('tsr_jets'), found = {};
      module.set(jets, 'is_double', 1);
      const list = (at, records) => {
        const made = struct('tsr_in');
        module.set(made, 'data', at);
        module.set(made, 'count', records);
        return made.at;
      };
      for (const name of wanted) {
        found[name] = keep(module.allocate(8 * quantities[name] * count));
        module.set(jets, `${inSnakeCase(name)}.data`, found[name]);
        module.set(jets, `${inSnakeCase(name)}.count`, count);
      }
      module.call('tsr_set_evaluate', this.handle, list(numbers(surfaces, Uint32Array), surfaces.length),
        list(numbers(us), count), list(numbers(vs), count), jets.at, 0);
      return Object.fromEntries(wanted.map((name) => [name,
        new Float64Array(module.exports.memory.buffer, found[name], quantities[name] * count).slice()]));
    });
  }
}
