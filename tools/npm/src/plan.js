// Plans: how a set is divided into triangles, so that a tolerance is proven.
import { flagsOf, listOf, optionsOf, recordsOf, setNumbers, truthOf } from './arguments.js';
import { invalid } from './errors.js';
import { Handle, adopted, describe } from './handle.js';
import { its } from './internal.js';
import { Mesh } from './mesh.js';

const numbers = {
  tolerance: 'tolerance', angle: 'angle', pixels: 'pixels', weld: 'weld', creaseAngle: 'crease_angle',
  maxGap: 'max_gap', spare: 'spare', maxTriangles: 'max_triangles', headroom: 'headroom',
};
const flagNames = {
  relative: 'RELATIVE', shareVertices: 'SHARE', fewest: 'FEWEST', smallest: 'SMALLEST', apart: 'APART', edges: 'EDGES',
};
const uvNames = { surface: 'UV_SURFACE', unit: 'UV_UNIT', patch: 'UV_PATCH' };
const planNames = [...Object.keys(numbers), ...Object.keys(flagNames), 'view', 'rates', 'parameters',
  'surfaceTolerances', 'progress', 'signal'];
const updateNames = ['patches', 'points', 'view', 'progress', 'signal'];
const viewNumbers = {
  fieldOfView: 'field_of_view', extent: 'extent', nearDistance: 'near_distance', width: 'width', height: 'height',
};
const viewNames = ['eye', 'target', 'up', ...Object.keys(viewNumbers)];

function fillView(module, options, view) {
  const given = optionsOf('view', view, viewNames);
  for (const name of ['eye', 'target', 'up']) {
    if (given[name] === undefined) continue;
    const vector = listOf(`view.${name}`, given[name]);
    if (vector.length !== 3) throw invalid(`view.${name}: expected three numbers, found ${vector.length}`);
    module.set(options, name, vector);
  }
  setNumbers(module, options, given, viewNumbers);
}

function fillOptions(module, options, wanted, lists) {
  setNumbers(module, options, wanted, numbers);
  if (wanted.view !== undefined) fillView(module, options, wanted.view);
  if (wanted.rates !== undefined) {
    const rates = listOf('rates', typeof wanted.rates === 'number' ? [wanted.rates, wanted.rates] : wanted.rates);
    if (rates.length !== 2) throw invalid(`rates: expected a number or two, found ${rates.length}`);
    setNumbers(module, options, { rateU: rates[0], rateV: rates[1] }, { rateU: 'rate_u', rateV: 'rate_v' });
  }
  if (wanted.surfaceTolerances !== undefined) {
    const list = listOf('surfaceTolerances', wanted.surfaceTolerances);
    module.set(options, 'surface_tolerances', lists(list));
    module.set(options, 'surface_tolerance_count', list.length);
  }
  const named = (names) => Object.fromEntries(
    Object.entries(names).map(([name, flag]) => [name, module.constants[`TSR_PLAN_${flag}`]]));
  const uv = wanted.parameters;
  if (uv !== undefined && !Object.hasOwn(uvNames, uv))
    throw invalid(`parameters is ${String(uv)}, expected one of ${Object.keys(uvNames).join(', ')}`);
  module.set(options, 'flags', flagsOf(wanted, named(flagNames)) | (uv ? named(uvNames)[uv] : 0));
}

export class Plan extends Handle {
  constructor(patches, handle, { hasEdges, hasParameters }) {
    super(patches[its.module], handle);
    Object.defineProperty(this, 'patches', { value: patches });
    Object.assign(this, { hasEdges, hasParameters });
    this.#describe();
  }

  static make(patches, wanted) {
    const given = optionsOf('plan', wanted, planNames), module = patches[its.module];
    // Patches that share vertices have parameters only where these are asked for.
    const has = {
      hasEdges: truthOf(given, 'edges'),
      hasParameters: given.parameters !== undefined || !truthOf(given, 'shareVertices'),
    };
    return module.scratch(({ struct, numbers: lists, run }) => {
      const options = struct('tsr_plan_options', 'tsr_plan_defaults');
      fillOptions(module, options, given, lists);
      const made = module.make('tsr_plan_new', patches[its.handle], options.at, run(given));
      return adopted(module, made, () => new Plan(patches, made, has));
    });
  }

  #describe() {
    const { isCertified, hasNormals, ...rest } = describe(this[its.module], 'tsr_plan_describe', 'tsr_plan_info',
      ['vertices', 'triangles', 'tolerance', 'bound', 'gap', 'angle', 'pixels', 'is_certified', 'has_normals',
        'open_edges', 'crossed_patches', 'seen_bound'], this[its.handle]);
    Object.assign(this, rest, { isCertified: isCertified === 1, hasNormals: hasNormals === 1 });
  }
  #checked(what, mesh) {
    if (!(mesh instanceof Mesh)) throw invalid(`${what}: expected a Mesh`);
    if (mesh[its.module] !== this[its.module]) throw invalid(`${what}: the Mesh is of another instance of the module`);
    if (mesh.patches !== this.patches) throw invalid(`${what}: the Mesh is of other Patches`);
    return mesh;
  }

  write(into = null, options) {
    const given = optionsOf('write', options, ['parameters', 'progress', 'signal']);
    const keeps = truthOf(given, 'parameters', true), handle = this[its.handle];
    const mesh = into === null ? new Mesh(this.patches, keeps) : this.#checked('write', into);
    try {
      const module = this[its.module];
      mesh[its.plan] = null;
      mesh[its.resize](this);
      module.scratch(({ run }) => module.call('tsr_plan_write', handle, mesh[its.struct], run(given)));
      mesh[its.plan] = this;
      if (this.hasEdges) mesh[its.takeEdges](this);
    } catch (error) {
      if (into === null) mesh.dispose();
      throw error;
    }
    return mesh;
  }

  update(mesh, options) {
    const { patches = [], points = [], view, ...given } = optionsOf('update', options, updateNames);
    const which = listOf('patches', patches, Uint32Array), where = listOf('points', points);
    const count = recordsOf('points', where, 3), module = this[its.module], handle = this[its.handle];
    const struct = this.#checked('update', mesh)[its.struct];
    if (mesh[its.plan] !== this) throw invalid('update: expected the Mesh that this Plan wrote last');
    const hasChanged = module.scratch(({ keep, struct: make, numbers: lists, run }) => {
      const how = run(given), topology = keep(module.allocate(4));
      if (view !== undefined) {
        const seen = make('tsr_plan_options', 'tsr_plan_defaults');
        fillView(module, seen, view);
        module.call('tsr_plan_set_view', handle, seen.at);
      }
      try {
        module.call('tsr_plan_update', handle, lists(which), which.length, lists(where), count, struct, topology, how);
      } finally {
        if (which.length > 0 && !module.isBroken) this.patches[its.refresh]();
      }
      return module.view.getInt32(topology, true) !== 0;
    });
    this.#describe();
    if (hasChanged) this.write(mesh);
    return hasChanged;
  }
}
