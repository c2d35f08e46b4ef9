// Models: the surfaces of a file, with names, places and colours.
import { bytesOf, listOf, optionsOf, recordsOf, setNumbers, stringOf, wholeOf } from './arguments.js';
import { invalid } from './errors.js';
import { Handle, adopted, describe } from './handle.js';
import { its } from './internal.js';
import { measure } from './measures.js';
import { Patches } from './patches.js';

const none = 0xffffffff;
const indexOrNull = (index) => (index === none ? null : index);

export class Model extends Handle {
  constructor(module, handle) {
    super(module, handle);
    const { surfaces, shapes, instances, trimmed, warnings } = describe(module, 'tsr_model_describe', 'tsr_model_info',
      ['surfaces', 'shapes', 'instances', 'warnings', 'trimmed'], handle);
    Object.assign(this, {
      surfaceCount: surfaces, shapeCount: shapes, instanceCount: instances, trimmedCount: trimmed,
      warningCount: warnings, unit: this.#text('UNIT', 0),
    });
  }

  /** Reads a file's bytes. */
  static read(module, name, bytes, options) {
    const wanted = optionsOf('read', options, ['format', 'progress', 'signal']);
    stringOf('the name of the file', name);
    const content = bytesOf(bytes);
    return module.scratch(({ keep, struct, text, run }) => {
      const read = struct('tsr_read_options', 'tsr_read_defaults');
      if (wanted.format !== undefined) module.set(read, 'format', text(stringOf('format', wanted.format)));
      const how = run(wanted), title = text(name), at = keep(module.copy(content));
      return Model.of(module, module.make('tsr_model_read_bytes', at, content.length, title, read.at, how));
    });
  }
  static of(module, handle) { return adopted(module, handle, () => new Model(module, handle)); }

  /** Makes a model of spline surfaces. */
  static ofSplines(module, splines) {
    if (!Array.isArray(splines)) throw invalid('bspline: expected an array of splines');
    return module.scratch(({ keep, text, numbers }) => {
      const { size } = module.structs.tsr_bspline;
      const first = keep(module.allocate(size * splines.length));
      module.bytes(first, size * splines.length).fill(0);
      const place = (k) => ({ at: first + k * size, name: 'tsr_bspline' });
      splines.forEach((spline, k) => fillSpline(module, place(k), spline, numbers, text));
      return Model.of(module, module.make('tsr_model_new', first, splines.length));
    });
  }

  get warnings() { return Array.from({ length: this.warningCount }, (_, k) => this.#text('WARNING', k)); }

  surface(index) {
    const module = this[its.module], handle = this[its.handle];
    const { domain, loops } = describe(module, 'tsr_model_surface', 'tsr_surface_info', ['domain', 'loops'], handle,
      wholeOf('surface', index));
    const face = describe(module, 'tsr_model_face', 'tsr_face_info',
      ['instance', 'shape', 'face', 'colour', 'has_colour'], handle, index);
    return {
      name: this.#text('SURFACE', index), kind: this.#text('SURFACE_KIND', index), domain, loops,
      instance: indexOrNull(face.instance), shape: indexOrNull(face.shape), face: indexOrNull(face.face),
      colour: face.hasColour ? face.colour : null,
    };
  }
  shape(index) {
    const name = this.#text('SHAPE', wholeOf('shape', index));
    if (name === null) throw invalid(`shape ${index} is none: there are ${this.shapeCount}`);
    return { name };
  }
  instance(index) {
    const { hasColour, colour, ...rest } = describe(this[its.module], 'tsr_model_instance', 'tsr_instance_info',
      ['shape', 'first_surface', 'placement', 'colour', 'has_colour'], this[its.handle], wholeOf('instance', index));
    return { name: this.#text('INSTANCE', index), ...rest, colour: hasColour ? colour : null };
  }

  surfaces() { return Array.from({ length: this.surfaceCount }, (_, k) => this.surface(k)); }
  shapes() { return Array.from({ length: this.shapeCount }, (_, k) => this.shape(k)); }
  instances() { return Array.from({ length: this.instanceCount }, (_, k) => this.instance(k)); }

  join(distance = 0) {
    if (typeof distance !== 'number') throw invalid('join: expected a distance');
    const module = this[its.module];
    return Model.of(module, module.make('tsr_model_join', this[its.handle], distance));
  }
  patches(options) { return Patches.make(this, options); }
  measure(options) { return measure(this, options); }
  save(format) {
    const module = this[its.module], name = `model.${stringOf('format', format)}`;
    return module.scratch(({ text }) => fileOf(module, 'tsr_model_bytes', this[its.handle], text(name)));
  }

  #text(kind, index) {
    const module = this[its.module];
    return module.readText('tsr_model_text', this[its.handle], module.constants[`TSR_TEXT_${kind}`], index);
  }
}

/** Makes the bytes of a file by a function of tessera_c_files.h, and copies them. */
export function fileOf(module, name, ...values) {
  const file = module.make(name, ...values);
  try {
    return module.scratch(({ keep }) => {
      const size = keep(module.allocate(4)), data = module.exports.tsr_bytes_data(file, size);
      return module.bytes(data, module.view.getUint32(size, true)).slice();
    });
  } finally {
    module.release(file);
  }
}

const splineNames = ['degreeU', 'degreeV', 'countU', 'countV', 'points', 'weights', 'knotsU', 'knotsV', 'name'];
function fillSpline(module, struct, spline, numbers, text) {
  const given = optionsOf('bspline', spline, splineNames);
  for (const degree of ['degreeU', 'degreeV'])
    if (!Number.isSafeInteger(given[degree])) throw invalid(`${degree} is ${given[degree]}, expected a whole number`);
  const { countU = given.degreeU + 1, countV = given.degreeV + 1 } = given;
  const points = recordsOf('points', listOf('points', given.points), 3);
  if (points !== countU * countV)
    throw invalid(`points: expected ${countU} x ${countV} points of three numbers, found ${points}`);
  if (given.weights && listOf('weights', given.weights).length !== points)
    throw invalid(`weights: expected ${points}, found ${given.weights.length}`);
  module.set(struct, 'struct_size', module.structs.tsr_bspline.size);
  setNumbers(module, struct, { ...given, countU, countV },
    { degreeU: 'degree_u', degreeV: 'degree_v', countU: 'count_u', countV: 'count_v' });
  const lists = { points: 'points', weights: 'weights', knotsU: 'knots_u', knotsV: 'knots_v' };
  for (const [name, member] of Object.entries(lists))
    if (given[name]) module.set(struct, member, numbers(listOf(name, given[name])));
  module.set(struct, 'knot_count_u', given.knotsU?.length ?? 0);
  module.set(struct, 'knot_count_v', given.knotsV?.length ?? 0);
  if (given.name !== undefined) module.set(struct, 'name', text(stringOf('name', given.name)));
}
