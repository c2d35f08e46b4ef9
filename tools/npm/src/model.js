// Models: the surfaces of a file, with names, places and colours.
import { TesseraError, invalid } from './errors.js';
import { Handle, checkNames, describe, recordsOf, setNumbers } from './handle.js';
import { measure } from './measures.js';
import { Patches } from './patches.js';

const none = 0xffffffff;
const indexOrNull = (index) => (index === none ? null : index);

export class Model extends Handle {
  #info = null;

  /** Reads a file's bytes. */
  static read(module, name, bytes, options = {}) {
    checkNames('read', options, ['format', 'progress']);
    if (typeof name !== 'string') throw invalid('read: expected the name of a file, and its bytes');
    const content = bytesOf(bytes);
    return module.scratch(({ keep, struct, text, run }) => {
      const read = struct('tsr_read_options', 'tsr_read_defaults');
      if (options.format !== undefined) module.set(read, 'format', text(String(options.format)));
      const at = keep(module.copy(content)), its = text(name), how = run(options);
      return new Model(module, module.make('tsr_model_read_bytes', at, content.length, its, read.at, how));
    });
  }

  /** Makes a model of spline surfaces. */
  static ofSplines(module, splines) {
    if (!Array.isArray(splines)) throw invalid('bspline: expected an array of splines');
    return module.scratch(({ keep, text, numbers }) => {
      const { size } = module.structs.tsr_bspline;
      const first = keep(module.allocate(size * splines.length));
      module.bytes(first, size * splines.length).fill(0);
      splines.forEach((spline, k) => fillSpline(module, { at: first + k * size, name: 'tsr_bspline' }, spline, numbers, text));
      return new Model(module, module.make('tsr_model_new', first, splines.length));
    });
  }

  get #counts() {
    return (this.#info ??= describe(this.module, 'tsr_model_describe', 'tsr_model_info',
      ['surfaces', 'shapes', 'instances', 'warnings', 'trimmed'], this.handle));
  }
  get surfaceCount() { return this.#counts.surfaces; }
  get shapeCount() { return this.#counts.shapes; }
  get instanceCount() { return this.#counts.instances; }
  get trimmedCount() { return this.#counts.trimmed; }
  get unit() { return this.#text('UNIT', 0); }
  get warnings() { return Array.from({ length: this.#counts.warnings }, (_, k) => this.#text('WARNING', k)); }

  surface(index) {
    const { module, handle } = this;
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
    if (name === null) throw invalid(`shape ${index} is none, there are ${this.shapeCount}`);
    return { name };
  }
  instance(index) {
    const { hasColour, colour, ...rest } = describe(this.module, 'tsr_model_instance', 'tsr_instance_info',
      ['shape', 'first_surface', 'placement', 'colour', 'has_colour'], this.handle, wholeOf('instance', index));
    return { name: this.#text('INSTANCE', index), ...rest, colour: hasColour ? colour : null };
  }

  surfaces() { return Array.from({ length: this.surfaceCount }, (_, k) => this.surface(k)); }
  shapes() { return Array.from({ length: this.shapeCount }, (_, k) => this.shape(k)); }
  instances() { return Array.from({ length: this.instanceCount }, (_, k) => this.instance(k)); }

  join(distance = 0) {
    if (typeof distance !== 'number') throw invalid('join: expected a distance');
    return new Model(this.module, this.module.make('tsr_model_join', this.handle, distance));
  }
  patches(options = {}) { return Patches.make(this, options); }
  measure(options = {}) { return measure(this, options); }
  /** The bytes of a file of the surfaces. */
  save(format) {
    return this.module.scratch(({ text }) => fileOf(this.module, 'tsr_model_bytes', this.handle, text(`model.${format}`)));
  }

  #text(kind, index) {
    const { exports, constants } = this.module;
    return this.module.text(exports.tsr_model_text(this.handle, constants[`TSR_TEXT_${kind}`], index));
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
    module.call('tsr_release', file);
  }
}

export function bytesOf(bytes) {
  if (ArrayBuffer.isView(bytes)) return new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes instanceof ArrayBuffer || Object.prototype.toString.call(bytes) === '[object SharedArrayBuffer]')
    return new Uint8Array(bytes);
  if (typeof bytes === 'string') return new TextEncoder().encode(bytes);
  throw invalid('read: expected bytes, a Uint8Array, an ArrayBuffer or a text');
}

export function wholeOf(what, index) {
  if (Number.isSafeInteger(index) && index >= 0 && index < none) return index;
  throw new TesseraError('invalid_argument', `${what} ${index} is none: expected a whole number of at least 0`);
}

const splineNames = ['degreeU', 'degreeV', 'countU', 'countV', 'points', 'weights', 'knotsU', 'knotsV', 'name'];
function fillSpline(module, struct, spline, numbers, text) {
  checkNames('bspline', spline, splineNames);
  const points = recordsOf('points', spline.points, 3);
  const countU = spline.countU ?? spline.degreeU + 1, countV = spline.countV ?? spline.degreeV + 1;
  if (points !== countU * countV)
    throw invalid(`points: expected ${countU} x ${countV} points of three numbers, found ${points}`);
  if (spline.weights && spline.weights.length !== points)
    throw invalid(`weights: expected ${points}, found ${spline.weights.length}`);
  module.set(struct, 'struct_size', module.structs.tsr_bspline.size);
  setNumbers(module, struct, { ...spline, countU, countV },
    { degreeU: 'degree_u', degreeV: 'degree_v', countU: 'count_u', countV: 'count_v' });
  for (const [list, member] of [['points', 'points'], ['weights', 'weights'], ['knotsU', 'knots_u'], ['knotsV', 'knots_v']])
    if (spline[list]) module.set(struct, member, numbers(spline[list]));
  module.set(struct, 'knot_count_u', spline.knotsU?.length ?? 0);
  module.set(struct, 'knot_count_v', spline.knotsV?.length ?? 0);
  if (spline.name !== undefined) module.set(struct, 'name', text(String(spline.name)));
}
