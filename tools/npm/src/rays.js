// Rays, which meet the surfaces themselves.
import { invalid } from './errors.js';
import { Handle, checkNames, describe, recordsOf, setNumbers } from './handle.js';

// Quantities of hits: numbers of a record, and their array.
const quantities = {
  kind: [1, Uint8Array], flags: [1, Uint8Array], surface: [1, Uint32Array], patch: [1, Uint32Array],
  t: [1, Float64Array], uv: [2, Float64Array], patchUv: [2, Float64Array], position: [3, Float64Array],
  normal: [3, Float64Array], du: [3, Float64Array], dv: [3, Float64Array], residual: [1, Float64Array],
};
const usual = ['kind', 'flags', 'surface', 'patch', 't', 'uv', 'position', 'normal'];
const memberOf = (name) => (name === 'patchUv' ? 'patch_uv' : name);

export class Scene extends Handle {
  constructor(patches, handle) {
    super(patches.module, handle);
    Object.defineProperty(this, 'patches', { value: patches });
  }

  static make(patches, options) {
    checkNames('rays', options, ['tolerance', 'pieces', 'editable', 'progress']);
    const { module } = patches;
    return module.scratch(({ struct, run }) => {
      const wanted = struct('tsr_scene_options', 'tsr_scene_defaults');
      setNumbers(module, wanted, options, { tolerance: 'tolerance', pieces: 'pieces' });
      module.set(wanted, 'is_editable', options.editable ? 1 : 0);
      return new Scene(patches, module.make('tsr_scene_new', patches.handle, wanted.at, run(options)));
    });
  }

  get info() {
    return describe(this.module, 'tsr_scene_describe', 'tsr_scene_info',
      ['memory_bytes', 'low', 'high', 'spawn_offset'], this.handle);
  }
  /** Follows edits of the patches. */
  refit() { this.module.call('tsr_scene_refit', this.handle, 0); }

  closest(origins, directions, options = {}) {
    const { module } = this, wanted = options.quantities ?? usual;
    for (const name of wanted)
      if (!quantities[name]) throw invalid(`${name} is no quantity; there are ${Object.keys(quantities).join(', ')}`);
    return module.scratch((scratch) => {
      const { rays, count } = this.#rays(scratch, origins, directions, options);
      const out = scratch.struct('tsr_hits_out'), found = {};
      module.set(out, 'is_double', 1);
      for (const name of wanted) {
        const [components, Type] = quantities[name];
        found[name] = scratch.keep(module.allocate(components * count * Type.BYTES_PER_ELEMENT));
        module.set(out, `${memberOf(name)}.data`, found[name]);
        module.set(out, `${memberOf(name)}.count`, count);
      }
      module.call('tsr_scene_closest', this.handle, rays.at, out.at, scratch.run(options));
      return Object.fromEntries(wanted.map((name) => {
        const [components, Type] = quantities[name];
        return [name, new Type(module.exports.memory.buffer, found[name], components * count).slice()];
      }));
    });
  }

  /** Whether anything lies on each ray: 1 or 0. */
  occluded(origins, directions, options = {}) {
    const { module } = this;
    return module.scratch((scratch) => {
      const { rays, count } = this.#rays(scratch, origins, directions, options);
      const out = scratch.struct('tsr_out'), at = scratch.keep(module.allocate(count));
      module.set(out, 'data', at);
      module.set(out, 'count', count);
      module.call('tsr_scene_occluded', this.handle, rays.at, out.at, scratch.run(options));
      return module.bytes(at, count).slice();
    });
  }

  #rays({ struct, numbers }, origins, directions, options) {
    checkNames('rays', options, ['near', 'far', 'spawnOffset', 'quantities', 'progress']);
    const { module } = this, rays = struct('tsr_rays'), count = recordsOf('directions', directions, 3);
    module.set(rays, 'is_double', 1);
    const list = (member, what, values, components) => {
      const records = recordsOf(what, values, components);
      if (records !== count && records !== 1)
        throw invalid(`${what}: expected ${count} records or one, as there are directions, found ${records}`);
      module.set(rays, `${member}.data`, numbers(values));
      module.set(rays, `${member}.count`, records);
    };
    list('direction', 'directions', directions, 3);
    list('origin', 'origins', origins, 3);
    for (const [option, member] of [['near', 'tnear'], ['far', 'tfar'], ['spawnOffset', 'spawn_offset']]) {
      const value = options[option];
      if (value !== undefined) list(member, option, typeof value === 'number' ? [value] : value, 1);
    }
    return { rays, count };
  }
}
