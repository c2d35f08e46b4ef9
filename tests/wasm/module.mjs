// tessera.wasm in Node: its functions, and its memory as structs, texts and arrays.
import { readFileSync } from 'node:fs';

/** What the module wants of WASI: a clock, an environment without variables, and a place for what it prints. */
function wasiOf(memory) {
  const view = () => new DataView(memory().buffer);
  const badFile = 8, missing = 52;
  return {
    clock_time_get: (clock, precision, at) => {
      view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    environ_sizes_get: (count, bytes) => {
      view().setUint32(count, 0, true);
      view().setUint32(bytes, 0, true);
      return 0;
    },
    environ_get: () => 0,
    fd_write: (file, list, count, written) => {
      let bytes = 0;
      for (let k = 0; k < count; ++k) {
        const at = view().getUint32(list + 8 * k, true), size = view().getUint32(list + 8 * k + 4, true);
        process.stderr.write(new Uint8Array(memory().buffer, at, size));
        bytes += size;
      }
      view().setUint32(written, bytes, true);
      return 0;
    },
    fd_close: () => badFile, fd_fdstat_get: () => badFile, fd_seek: () => badFile, fd_read: () => badFile,
    fd_prestat_get: () => badFile, fd_prestat_dir_name: () => badFile,
    proc_exit: (code) => { throw new Error(`the module ended with ${code}`); },
    missing,
  };
}

/** What the module wants of its host beside WASI: Chinese text of STEP files. */
function hostOf(memory) {
  return {
    decode_gbk: (from, bytes, to, room) => {
      const text = new TextDecoder('gbk').decode(new Uint8Array(memory().buffer, from, bytes));
      return new TextEncoder().encodeInto(text, new Uint8Array(memory().buffer, to, room)).written;
    },
  };
}

export class Module {
  /** `structs`: of structsOf(). */
  static async load(file, structs) {
    let exports;
    const wasi = wasiOf(() => exports.memory);
    const imports = { wasi_snapshot_preview1: {}, tessera: hostOf(() => exports.memory) };
    const module = await WebAssembly.compile(readFileSync(file));
    for (const { module: from, name } of WebAssembly.Module.imports(module))
      if (from === 'wasi_snapshot_preview1') imports[from][name] = wasi[name] ?? (() => wasi.missing);
    exports = (await WebAssembly.instantiate(module, imports)).exports;
    exports._initialize();
    return new Module(exports, structs);
  }

  constructor(exports, structs) {
    Object.assign(this, { exports, structs });
  }

  get view() { return new DataView(this.exports.memory.buffer); }
  bytes(at, size) { return new Uint8Array(this.exports.memory.buffer, at, size); }
  text(at) {
    if (at === 0) return null;
    const rest = new Uint8Array(this.exports.memory.buffer, at);
    return new TextDecoder().decode(rest.slice(0, rest.indexOf(0)));
  }

  allocate(size) {
    const at = this.exports.malloc(Math.max(size, 1));
    if (at === 0) throw new Error(`${size} bytes are more than the module's memory has left`);
    return at >>> 0;
  }
  /** Copies bytes, with a 0 behind them. */
  copy(bytes) {
    const at = this.allocate(bytes.length + 1);
    this.bytes(at, bytes.length + 1).set(bytes);
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
      struct = member.struct;
    }
    return { at, member };
  }
  get(struct, path) {
    const { at, member } = this.place(struct, path);
    const value = this.view[member.read](at, true);
    return typeof value === 'bigint' ? Number(value) : value;
  }
  set(struct, path, value) {
    const { at, member } = this.place(struct, path);
    this.view[member.read.replace('get', 'set')](at, member.bytes === 8 && /Big/.test(member.read) ? BigInt(value) : value, true);
  }

  /** Calls a function that returns a status; throws an error with `code` and the library's sentence. */
  call(name, ...values) {
    const code = this.exports[name](...values);
    if (code !== 0) throw Object.assign(new Error(this.text(this.exports.tsr_last_message(0))), { code });
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
}
