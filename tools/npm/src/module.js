// An instance of tessera.wasm: its functions, and its memory as structs, texts and arrays.
import { TesseraError, invalid } from './errors.js';
import { compiled, importsOf } from './host.js';

const decoder = new TextDecoder(), encoder = new TextEncoder();

export class Module {
  #view = null;
  #run = null;  // { progress, cancel, error } of the call that runs
  #broken = null;
  #index = 0;  // where an error's index is written: there is room for it even if memory has run out

  /** `source`: as init() takes it; `layout`: { structs, constants } of layoutOf(). */
  static async load(source, layout) {
    const module = await compiled(source);
    let made;
    const imports = importsOf(module, () => made.exports.memory, (share) => made.#progress(share));
    made = new Module(layout);
    made.exports = (await WebAssembly.instantiate(module, imports)).exports;
    made.exports._initialize();
    made.#index = made.allocate(8);
    return made;
  }

  constructor({ structs, constants }) {
    this.structs = structs;
    this.constants = constants;
  }

  /** All memory; it holds until the next call, which may make the memory grow. */
  get view() {
    const { buffer } = this.exports.memory;
    if (this.#view?.buffer !== buffer) this.#view = new DataView(buffer);
    return this.#view;
  }
  bytes(at, size) { return new Uint8Array(this.exports.memory.buffer, at, size); }
  text(at) {
    if (at === 0) return null;
    const rest = new Uint8Array(this.exports.memory.buffer, at);
    return decoder.decode(rest.subarray(0, rest.indexOf(0)));
  }

  allocate(size) {
    const at = size < 2 ** 31 ? this.#trapped(() => this.exports.malloc(Math.max(size, 1))) >>> 0 : 0;
    if (at === 0) throw new TesseraError('out_of_memory', `${size} bytes are more than the module's memory has left`);
    return at;
  }
  /** Copies bytes, with a 0 behind them. */
  copy(bytes) {
    const at = this.allocate(bytes.length + 1);
    this.bytes(at, bytes.length).set(bytes);
    this.view.setUint8(at + bytes.length, 0);
    return at;
  }
  free(...all) { for (const at of all) this.exports.free(at); }

  /** Makes a struct with its size set; `defaults`: the function that fills it. */
  struct(name, defaults) {
    const { size, members } = this.structs[name], at = this.allocate(size);
    this.bytes(at, size).fill(0);
    if (members.struct_size) this.view.setUint32(at, size, true);
    if (defaults) this.exports[defaults](at);
    return { at, name };
  }
  place({ at, name }, path) {
    let struct = this.structs[name], member;
    for (const part of path.split('.')) {
      member = struct.members[part];
      at += member.offset;
      struct = member.struct && this.structs[member.struct];
    }
    return { at, member };
  }
  /** Returns a member, an array if it is one in C; 64-bit integers as numbers. */
  get(struct, path) {
    const { at, member } = this.place(struct, path);
    const read = (k) => Number(this.view[member.read](at + k * member.bytes, true));
    return member.count === 1 ? read(0) : Array.from({ length: member.count }, (_, k) => read(k));
  }
  /** Sets a member, all numbers of it if it is an array in C. */
  set(struct, path, value) {
    const { at, member } = this.place(struct, path);
    const values = member.count === 1 ? [value] : value;
    for (let k = 0; k < member.count; ++k)
      this.view[member.read.replace('get', 'set')](at + k * member.bytes,
        member.read.includes('Big') ? BigInt(values[k]) : values[k], true);
  }

  /** Calls a function that returns a status; throws a TesseraError with the library's sentence. */
  call(name, ...values) {
    const code = this.#trapped(() => this.exports[name](...values));
    if (this.#run?.error) throw this.#run.error;
    if (code === 0) return;
    const message = this.text(this.exports.tsr_last_message(this.#index));
    const index = Number(this.view.getBigInt64(this.#index, true));
    throw new TesseraError(this.text(this.exports.tsr_status_name(code)), message, index);
  }
  /** Calls a function whose first argument is the place of a new handle, which is returned. */
  make(name, ...values) {
    const at = this.allocate(4);
    try {
      this.call(name, at, ...values);
      return this.view.getUint32(at, true);
    } finally {
      this.free(at);
    }
  }

  /**
   * Calls `body` with what lets go of memory at its end, `keep(address)`, the structs of `struct()` and copies of texts
   * of `text()`; `run()`: a tsr_run of options.
   */
  scratch(body) {
    const kept = [];
    const keep = (at) => (kept.push(at), at);
    const struct = (name, defaults) => {
      const made = this.struct(name, defaults);
      keep(made.at);
      return made;
    };
    try {
      return body({
        keep, struct,
        text: (of) => keep(this.copy(encoder.encode(of))),
        numbers: (of, Type = Float64Array) => keep(this.numbers(of, Type)),
        run: (options) => this.#runOf(options, struct, keep),
      });
    } finally {
      this.#run = null;
      if (!this.#broken) this.free(...kept);
    }
  }
  /** Copies a list of numbers. */
  numbers(of, Type = Float64Array) {
    const array = of instanceof Type ? of : Type.from(of);
    const at = this.allocate(array.byteLength);
    new Type(this.exports.memory.buffer, at, array.length).set(array);
    return at;
  }

  #runOf(options, struct, keep) {
    if (!options?.progress) return 0;
    if (typeof options.progress !== 'function') throw invalid('progress: expected a function');
    const run = struct('tsr_run'), cancel = keep(this.allocate(1));
    this.view.setUint8(cancel, 0);
    this.set(run, 'threads', 1);
    this.set(run, 'cancel', cancel);
    this.set(run, 'progress', this.exports.tessera_progress());
    this.#run = { progress: options.progress, cancel, error: null };
    return run.at;
  }
  // An exception must not run through the module's frames: it ends the call, and is thrown behind it.
  #progress(share) {
    const run = this.#run;
    if (!run || run.error) return;
    try {
      if (run.progress(share) === false) this.view.setUint8(run.cancel, 1);
    } catch (error) {
      run.error = error;
      this.view.setUint8(run.cancel, 1);
    }
  }

  /** Calls the module; a trap leaves its memory in no known state, and every later call is an error. */
  #trapped(body) {
    if (this.#broken) throw this.#broken;
    if (this.#run?.isBusy) throw new TesseraError('in_use', 'progress() must not call the module that calls it');
    try {
      if (this.#run) this.#run.isBusy = true;
      return body();
    } catch (error) {
      this.#broken = new TesseraError('internal', `the module stopped and cannot be used any more: ${error.message}`);
      throw this.#broken;
    } finally {
      if (this.#run) this.#run.isBusy = false;
    }
  }
}
