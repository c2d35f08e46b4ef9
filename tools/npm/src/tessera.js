// An instance of the module, with memory of its own.
import { optionsOf, stringOf } from './arguments.js';
import { its } from './internal.js';
import { Model } from './model.js';
import { unpacked } from './packed.js';

export class Tessera {
  constructor(module) {
    Object.defineProperty(this, its.module, { value: module });
    const number = module.exports.tsr_version();
    this.version = [number / 10000, (number / 100) % 100, number % 100].map(Math.floor).join('.');
  }

  get memoryBytes() { return this[its.module].exports.memory.buffer.byteLength; }
  read(name, bytes, options) { return Model.read(this[its.module], name, bytes, options); }
  async open(name, bytes, options) {
    const given = optionsOf('open', options, ['format', 'progress', 'signal']);
    const file = await unpacked(stringOf('the name of the file', name), bytes);
    const format = given.format === undefined ? {} : { format: stringOf('format', given.format).replace(/\.gz$/i, '') };
    return Model.read(this[its.module], file.name, file.bytes, { ...given, ...format });
  }
  bspline(splines) { return Model.ofSplines(this[its.module], splines); }
}
