// Rays, which meet the surfaces themselves.
import { listOf, namesOf, optionsOf, recordsOf, setNumbers, truthOf } from './arguments.js';
import { invalid } from './errors.js';
import { Handle, adopted, describe } from './handle.js';
import { its } from './internal.js';

// Quantities of hits: numbers of a record, and their array.
const quantities = {
  kind: [1, Uint8Array], flags: [1, Uint8Array], surface: [1, Uint32Array], patch: [1, Uint32Array],
  t: [1, Float64Array], uv: [2, Float64Array], patchUv: [2, Float64Array], position: [3, Float64Array],
  normal: [3, Float64Array], du: [3, Float64Array], dv: [3, Float64Array], residual: [1, Float64Array],
};
const usual = ['kind', 'flags', 'surface', 'patch', 't', 'uv', 'position', 'normal'];
const rayNames = ['near', 'far', 'spawnOffset', 'progress', 'signal'];
const memberOf = (name) => (name === 'patchUv' ? 'patch_uv' : name);

export class Scene extends Handle {
  constructor(patches, handle) {
    super(patches[its.module], handle);
    Object.defineProperty(this, 'patches', { value: patches });
  }

  static make(patches, options) {
    const given = optionsOf('rays', options, ['tolerance', 'pieces', 'editable', 'progress', 'signal']);
    const module = patches[its.module];
    return module.scratch(({ struct, run }) => {
      const wanted = struct('tsr_scene_options', 'tsr_scene_defaults');
      setNumbers(module, wanted, given, { tolerance: 'tolerance', pieces: 'pieces' });
      module.set(wanted, 'is_editable', truthOf(given, 'editable') ? 1 : 0);
      const made = module.make('tsr_scene_new', patches[its.handle], wanted.at, run(given));
      return adopted(module, made, () => new Scene(patches, made));
    });
  }

  get info() {
    return describe(this[its.module], 'tsr_scene_describe', 'tsr_scene_info',
      ['memory_bytes', 'low', 'high', 'spawn_offset'], this[its.handle]);
  }
  /** Follows edits of the patches. */
  refit() { this[its.module].call('tsr_scene_refit', this[its.handle], 0); }

  closest(origins, directions, options) {
    const given = optionsOf('closest', options, [...rayNames, 'quantities']), module = this[its.module];
    const wanted = namesOf('quantities', given.quantities ?? usual, quantities);
    return module.scratch((scratch) => {
      const { rays, count } = this.#rays(scratch, origins, directions, given);
      const out = scratch.struct('tsr_hits_out'), found = {};
      module.set(out, 'is_double', 1);
      for (const name of wanted) {
        const [components, Type] = quantities[name];
        found[name] = scratch.keep(module.allocate(components * count * Type.BYTES_PER_ELEMENT));
        module.set(out, `${memberOf(name)}.data`, found[name]);
        module.set(out, `${memberOf(name)}.count`, count);
      }
      module.call('tsr_scene_closest', this[its.handle], rays.at, out.at, scratch.run(given));
      return Object.fromEntries(wanted.map((name) => {
        const [components, Type] = quantities[name];
        return [name, new Type(module.exports.memory.buffer, found[name], components * count).slice()];
      }));
    });
  }

  /** Whether anything lies on each ray: 1 or 0. */
  occluded(origins, directions, options) {
    const given = optionsOf('occluded', options, rayNames), module = this[its.module];
    return module.scratch((scratch) => {
      const { rays, count } = this.#rays(scratch, origins, directions, given);
      const out = scratch.struct('tsr_out'), at = scratch.keep(module.allocate(count));
      module.set(out, 'data', at);
      module.set(out, 'count', count);
      module.call('tsr_scene_occluded', this[its.handle], rays.at, out.at, scratch.run(given));
      return module.bytes(at, count).slice();
    });
  }

  #rays({ struct, numbers }, origins, directions, options) {
    const module = this[its.module], rays = struct('tsr_rays');
    const along = listOf('directions', directions), count = recordsOf('directions', along, 3);
    module.set(rays, 'is_double', 1);
    const set = (member, what, values, components) => {
      const list = listOf(what, values), records = recordsOf(what, list, components);
      if (records !== count && records !== 1)
        throw invalid(`${what}: expected ${count} records or one, as there are directions, found ${records}`);
      module.set(rays, `${member}.data`, numbers(list));
      module.set(rays, `${member}.count`, records);
    };
    set('direction', 'directions', along, 3);
    set('origin', 'origins', origins, 3);
    for (const [option, member] of [['near', 'tnear'], ['far', 'tfar'], ['spawnOffset', 'spawn_offset']]) {
      const value = options[option];
      if (value !== undefined) set(member, option, typeof value === 'number' ? [value] : value, 1);
    }
    return { rays, count };
  }
}
