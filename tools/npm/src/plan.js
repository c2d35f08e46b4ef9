// Plans: how a set is divided into triangles, so that a tolerance is proven.
import { invalid } from './errors.js';
import { Handle, checkNames, describe, flagsOf, recordsOf, setNumbers } from './handle.js';
import { Mesh } from './mesh.js';

const numbers = {
  tolerance: 'tolerance', angle: 'angle', pixels: 'pixels', weld: 'weld', creaseAngle: 'crease_angle', maxGap: 'max_gap',
  spare: 'spare', maxTriangles: 'max_triangles', headroom: 'headroom',
};
const flagNames = {
  relative: 'RELATIVE', shareVertices: 'SHARE', fewest: 'FEWEST', smallest: 'SMALLEST', apart: 'APART', edges: 'EDGES',
};
const uvNames = { surface: 'UV_SURFACE', unit: 'UV_UNIT', patch: 'UV_PATCH' };
const planNames = [...Object.keys(numbers), ...Object.keys(flagNames), 'view', 'rates', 'parameters',
  'surfaceTolerances', 'progress'];
const viewNumbers = {
  fieldOfView: 'field_of_view', extent: 'extent', nearDistance: 'near_distance', width: 'width', height: 'height',
};
const viewNames = ['eye', 'target', 'up', ...Object.keys(viewNumbers)];

function fillView(module, options, view) {
  checkNames('view', view, viewNames);
  for (const name of ['eye', 'target', 'up']) {
    if (view[name] === undefined) continue;
    const vector = Array.from(view[name]);
    if (vector.length !== 3) throw invalid(`view.${name}: expected three numbers, found ${vector.length}`);
    module.set(options, name, vector);
  }
  setNumbers(module, options, view, viewNumbers);
}

function fillOptions(module, options, wanted, lists) {
  setNumbers(module, options, wanted, numbers);
  if (wanted.view) fillView(module, options, wanted.view);
  if (wanted.rates) {
    const [rateU, rateV] = typeof wanted.rates === 'number' ? [wanted.rates, wanted.rates] : wanted.rates;
    setNumbers(module, options, { rateU, rateV }, { rateU: 'rate_u', rateV: 'rate_v' });
  }
  if (wanted.surfaceTolerances) {
    module.set(options, 'surface_tolerances', lists(wanted.surfaceTolerances));
    module.set(options, 'surface_tolerance_count', wanted.surfaceTolerances.length);
  }
  const named = (names) => Object.fromEntries(
    Object.entries(names).map(([name, flag]) => [name, module.constants[`TSR_PLAN_${flag}`]]));
  const uv = wanted.parameters;
  if (uv !== undefined && !uvNames[uv])
    throw invalid(`parameters is ${uv}, expected one of ${Object.keys(uvNames).join(', ')}`);
  module.set(options, 'flags', flagsOf(wanted, named(flagNames)) | (uv ? named(uvNames)[uv] : 0));
}

export class Plan extends Handle {
  constructor(patches, handle, hasEdges) {
    super(patches.module, handle);
    Object.defineProperties(this, { patches: { value: patches }, hasEdges: { value: hasEdges } });
    this.#describe();
  }

  static make(patches, wanted) {
    checkNames('plan', wanted, planNames);
    const { module } = patches;
    return module.scratch(({ struct, numbers: lists, run }) => {
      const options = struct('tsr_plan_options', 'tsr_plan_defaults');
      fillOptions(module, options, wanted, lists);
      const made = module.make('tsr_plan_new', patches.handle, options.at, run(wanted));
      return new Plan(patches, made, Boolean(wanted.edges));
    });
  }

  #describe() {
    const { isCertified, hasNormals, ...rest } = describe(this.module, 'tsr_plan_describe', 'tsr_plan_info',
      ['vertices', 'triangles', 'tolerance', 'bound', 'gap', 'angle', 'pixels', 'is_certified', 'has_normals',
        'open_edges', 'crossed_patches', 'seen_bound'], this.handle);
    Object.assign(this, rest, { isCertified: isCertified === 1, hasNormals: hasNormals === 1 });
  }

  /** Writes the mesh, into one that an earlier call made if it is given. */
  write(into = null, options = {}) {
    checkNames('write', options, ['parameters', 'progress']);
    if (into !== null && !(into instanceof Mesh)) throw invalid('write: expected a mesh, or nothing');
    const mesh = into ?? new Mesh(this.patches, options.parameters !== false && !this.#sharesVertices);
    mesh.resize(this);
    this.module.scratch(({ run }) => this.module.call('tsr_plan_write', this.handle, mesh.struct, run(options)));
    mesh.takeEdges(this);
    return mesh;
  }
  get #sharesVertices() { return !this.hasNormals; }

  /** Takes the view that the next update() plans for. */
  set view(view) {
    this.module.scratch(({ struct }) => {
      const options = struct('tsr_plan_options', 'tsr_plan_defaults');
      fillView(this.module, options, view);
      this.module.call('tsr_plan_set_view', this.handle, options.at);
    });
  }

  /** Follows edits and the view; writes the mesh. Returns whether it has other triangles now. */
  update(mesh, { patches = [], points = [], view, ...rest } = {}) {
    checkNames('update', rest, ['progress']);
    recordsOf('points', points, 3);
    if (view) this.view = view;
    const { module } = this;
    const hasChanged = module.scratch(({ keep, numbers: lists, run }) => {
      const topology = keep(module.allocate(4));
      module.call('tsr_plan_update', this.handle, lists(patches, Uint32Array), patches.length, lists(points),
        points.length / 3, mesh.struct, topology, run(rest));
      return module.view.getInt32(topology, true) !== 0;
    });
    this.#describe();
    if (hasChanged) this.write(mesh);
    return hasChanged;
  }
}
