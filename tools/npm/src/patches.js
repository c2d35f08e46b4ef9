// Patch sets: Bezier patches of a model, packed for meshes, rays and points.
import { editOf, flagsOf, listOf, namesOf, optionsOf, setNumbers, wholeOf } from './arguments.js';
import { invalid } from './errors.js';
import { Handle, adopted, describe } from './handle.js';
import { its } from './internal.js';
import { Plan } from './plan.js';
import { Scene } from './rays.js';

const setNames = ['shape', 'whole', 'double', 'points', 'fitTolerance', 'progress', 'signal'];
// Quantities of points and their components.
const quantities = {
  position: 3, du: 3, dv: 3, duu: 3, duv: 3, dvv: 3, normal: 3, firstForm: 3, secondForm: 3, gaussian: 1, mean: 1,
  firstCurvature: 1, secondCurvature: 1, firstDirection: 3, secondDirection: 3,
};
const inSnakeCase = (name) => name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`);

export class Patches extends Handle {
  #surfaces = null;

  constructor(model, handle) {
    super(model[its.module], handle);
    Object.defineProperty(this, 'model', { value: model });
    this[its.refresh]();
  }

  static make(model, options) {
    const given = optionsOf('patches', options, setNames);
    const module = model[its.module], { TSR_SET_WHOLE, TSR_SET_DOUBLE, TSR_SET_POINTS } = module.constants;
    return module.scratch(({ struct, run }) => {
      const wanted = struct('tsr_set_options', 'tsr_set_defaults');
      if (given.shape !== undefined) module.set(wanted, 'shape', wholeOf('shape', given.shape));
      setNumbers(module, wanted, given, { fitTolerance: 'fit_tolerance' });
      module.set(wanted, 'flags',
        flagsOf(given, { whole: TSR_SET_WHOLE, double: TSR_SET_DOUBLE, points: TSR_SET_POINTS }));
      const made = module.make('tsr_set_new', model[its.handle], wanted.at, run(given));
      return adopted(module, made, () => new Patches(model, made));
    });
  }

  [its.refresh]() {
    const { low, high, unusedLoops, fitError, ...rest } = describe(this[its.module], 'tsr_set_describe', 'tsr_set_info',
      ['patches', 'surfaces', 'cut_patches', 'memory_bytes', 'revision', 'low', 'high', 'origin', 'fit_error',
        'unused_loops'], this[its.handle]);
    Object.assign(this, {
      count: rest.patches, surfaceCount: rest.surfaces, cutCount: rest.cutPatches, memoryBytes: rest.memoryBytes,
      revision: rest.revision, origin: rest.origin, box: { low, high }, fitError, unusedLoops,
    });
  }

  /** The surface of each patch. */
  get surfaces() {
    if (this.#surfaces) return this.#surfaces.slice();
    const module = this[its.module], handle = this[its.handle], found = new Uint32Array(this.count);
    module.scratch(({ struct }) => {
      const info = struct('tsr_patch_info');
      for (let k = 0; k < found.length; ++k) {
        module.call('tsr_set_patch', handle, k, info.at, 0, 0);
        found[k] = module.get(info, 'surface');
      }
    });
    return (this.#surfaces = found).slice();
  }

  patch(index) {
    const module = this[its.module], handle = this[its.handle];
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
    const { which, where, count } = editOf(patches, points), module = this[its.module];
    try {
      module.scratch(({ numbers }) => module.call('tsr_set_edit', this[its.handle], numbers(which), which.length,
        numbers(where), count));
    } finally {
      if (!this.isDisposed && !module.isBroken) this[its.refresh]();  // after an error some are set
    }
  }

  plan(options) { return Plan.make(this, options); }
  rays(options) { return Scene.make(this, options); }

  evaluate(surface, u, v, names = ['position', 'normal']) {
    const one = (what, list) => listOf(what, typeof list === 'number' ? [list] : list);
    const us = one('u', u), vs = one('v', v), count = us.length, wanted = namesOf('evaluate', names, quantities);
    if (vs.length !== count) throw invalid(`v: expected ${count} numbers, as u has, found ${vs.length}`);
    const surfaces = typeof surface === 'number' ? new Uint32Array(count).fill(wholeOf('surface', surface))
      : listOf('surface', surface, Uint32Array);
    const module = this[its.module];
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
      module.call('tsr_set_evaluate', this[its.handle], list(numbers(surfaces), surfaces.length),
        list(numbers(us), count), list(numbers(vs), count), jets.at, 0);
      return Object.fromEntries(wanted.map((name) => [name,
        new Float64Array(module.exports.memory.buffer, found[name], quantities[name] * count).slice()]));
    });
  }
}
