// An instance of tessera.wasm: its functions, and its memory as structs, texts and arrays.
import { TesseraError, invalid } from './errors.js';
import { compiled, importsOf } from './host.js';

const decoder = new TextDecoder(), encoder = new TextEncoder();

export class Module {
  #view = null;
  #run = null;  // { progress, signal, cancel, failure } of the call that runs
  #isBusy = false;
  #broken = null;
  #index = 0;  // where an error's index is written: there is room for it even if memory has run out

  /** `source`: as init() takes it; `layout`: { structs, constants } of layoutOf(). */
  static async load(source, layout) {
    const module = await compiled(source);
    let made;
    const imports = importsOf(module, () => made.exports.memory,
      { progress: (share) => made.#progress(share), poll: () => made.#poll() });
    made = new Module(layout);
    made.exports = (await WebAssembly.instantiate(module, imports)).exports;
    if (!made.exports.tsr_version) throw new Error('expected tessera.wasm, found another module');
    made.exports._initialize();
    made.#index = made.allocate(8);
    return made;
  }

  constructor({ structs, constants }) {
    this.structs = structs;
    this.constants = constants;
  }
  /** Whether a call has trapped. */
  get isBroken() { return this.#broken !== null; }

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
    const at = size < 2 ** 31 ? this.#trapped('malloc', [Math.max(size, 1)]) >>> 0 : 0;
    if (at === 0) throw new TesseraError('out_of_memory', `${size} bytes are more than the module's memory has left`);
    return at;
  }
  /** Copies bytes, with a 0 behind them. */
  copy(bytes) {
    const apart = this.#apart(bytes), at = this.allocate(apart.length + 1);
    this.bytes(at, apart.length).set(apart);
    this.view.setUint8(at + apart.length, 0);
    return at;
  }
  /** Copies a Float64Array or a Uint32Array. */
  numbers(list) {
    const apart = this.#apart(list), at = this.allocate(apart.byteLength);
    const Type = apart instanceof Uint32Array ? Uint32Array : Float64Array;
    new Type(this.exports.memory.buffer, at, apart.length).set(apart);
    return at;
  }
  // A view of the module's own memory is detached where an allocation makes that grow.
  #apart(array) { return array.buffer === this.exports.memory.buffer ? array.slice() : array; }
  free(...all) {
    if (this.#broken) return;
    this.#check();
    for (const at of all) this.exports.free(at);
  }

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
    const code = this.#trapped(name, values);
    if (this.#run?.failure) throw this.#run.failure.error;
    if (code === 0) return;
    const message = this.text(this.exports.tsr_last_message(this.#index));
    const index = Number(this.view.getBigInt64(this.#index, true));
    throw new TesseraError(this.text(this.exports.tsr_status_name(code)), message, index);
  }
  /** Calls a function whose first argument is the place of a new handle, which is returned. */
  make(name, ...values) {
    const at = this.allocate(4);
    this.view.setUint32(at, 0, true);
    try {
      this.call(name, at, ...values);
      return this.view.getUint32(at, true);
    } catch (error) {
      this.release(this.view.getUint32(at, true));  // made before progress() threw at its last call
      throw error;
    } finally {
      this.free(at);
    }
  }
  release(handle) {
    if (handle !== 0 && !this.#broken) this.exports.tsr_release(handle);
  }
  /** Calls a function that returns a text. */
  readText(name, ...values) { return this.text(this.#trapped(name, values)); }

  /**
   * Calls `body` with what lets go of memory at its end, `keep(address)`, the structs of `struct()` and copies of
   * `text()` and of typed arrays, `numbers()`; `run()`: a tsr_run of options.
   */
  scratch(body) {
    this.#check();
    const kept = [], outer = this.#run;
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
        numbers: (list) => keep(this.numbers(list)),
        run: (options) => this.#runOf(options, struct, keep),
      });
    } finally {
      this.#run = outer;
      this.free(...kept);
    }
  }

  #runOf({ progress, signal }, struct, keep) {
    if (progress !== undefined && typeof progress !== 'function') throw invalid('progress: expected a function');
    if (signal !== undefined && typeof signal?.aborted !== 'boolean') throw invalid('signal: expected an AbortSignal');
    if (signal?.aborted) throw new TesseraError('cancelled', 'cancelled by the caller');
    if (!progress && !signal) return 0;
    const run = struct('tsr_run'), cancel = keep(this.allocate(1));
    this.view.setUint8(cancel, 0);
    this.set(run, 'threads', 1);
    this.set(run, 'cancel', cancel);
    this.set(run, 'progress', this.exports.tessera_progress());
    this.#run = { progress, signal, cancel, failure: null };
    return run.at;
  }
  #progress(share) { this.#ask((run) => run.progress?.(share) !== false); }
  #poll() {
    if (this.#run?.signal) this.#ask((run) => !run.signal.aborted);
  }
  // Ends the call that runs unless `goesOn` is true. An exception must not run through the module's frames: it ends the
  // call, and is thrown behind it.
  #ask(goesOn) {
    const run = this.#run;
    if (!run || run.failure) return;
    try {
      if (goesOn(run)) return;
    } catch (error) {
      run.failure = { error };
    }
    this.view.setUint8(run.cancel, 1);
  }

  #check() {
    if (this.#broken) throw this.#broken;
    if (this.#isBusy) throw new TesseraError('in_use', 'progress() must not use the instance that calls it');
  }
  /** Calls the module; a trap leaves its memory in no known state, and every later call is an error. */
  #trapped(name, values) {
    this.#check();
    try {
      this.#isBusy = true;
      return this.exports[name](...values);
    } catch (error) {
      this.#broken = new TesseraError('internal', `the module stopped and cannot be used any more: ${error.message}`);
      throw this.#broken;
    } finally {
      this.#isBusy = false;
    }
  }
}
