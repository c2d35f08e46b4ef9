// The host that tessera.wasm asks for: functions of WASI, Chinese text, and who is told of progress.

const badFile = 8, missing = 52;  // WASI's errno
const mebibyte = 1 << 20;

/** A clock, an environment without variables, and a place for what the module prints. There are no files. */
function wasiOf(memory) {
  const view = () => new DataView(memory().buffer);
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
      let text = '', bytes = 0;
      for (let k = 0; k < count; ++k) {
        const at = view().getUint32(list + 8 * k, true), size = view().getUint32(list + 8 * k + 4, true);
        text += new TextDecoder().decode(new Uint8Array(memory().buffer, at, Math.min(size, mebibyte)));
        bytes += size;
      }
      console.error(text);
      view().setUint32(written, bytes, true);
      return 0;
    },
    fd_close: () => badFile, fd_fdstat_get: () => badFile, fd_seek: () => badFile, fd_read: () => badFile,
    fd_prestat_get: () => badFile, fd_prestat_dir_name: () => badFile,
    proc_exit: (code) => { throw new Error(`the module ended with ${code}`); },
  };
}

function gbkOf(bytes) {
  try {
    return new TextDecoder('gbk').decode(bytes);
  } catch {
    return '';  // Node without the tables of languages
  }
}

/**
 * Returns the imports of a compiled module. `memory()`: the instance's memory; `progress(share)`: called as
 * tsr_run.progress; `poll()`: called often while a call runs, and may set its tsr_run.cancel.
 */
export function importsOf(module, memory, { progress, poll }) {
  const wasi = wasiOf(memory);
  const host = {
    decode_gbk: (from, bytes, to, room) => {
      const text = gbkOf(new Uint8Array(memory().buffer, from, bytes));
      return new TextEncoder().encodeInto(text, new Uint8Array(memory().buffer, to, room)).written;
    },
    progress, poll,
  };
  const imports = { wasi_snapshot_preview1: {}, tessera: host };
  for (const { module: from, name } of WebAssembly.Module.imports(module))
    if (from === 'wasi_snapshot_preview1') imports[from][name] = wasi[name] ?? (() => missing);
  return imports;
}

/** Returns the compiled module of bytes, of an address, or of a module that is compiled already. */
export async function compiled(source) {
  if (source instanceof WebAssembly.Module) return source;
  if (typeof source === 'string' || source instanceof URL) return compiledAt(new URL(source, base()));
  return WebAssembly.compile(source);
}
/** The base of relative addresses: the page, or the working folder. */
function base() {
  return globalThis.document?.baseURI ?? globalThis.location?.href ?? `file://${(globalThis.process?.cwd() ?? '').replace(/[%?#]/g, encodeURIComponent)}/`;
}

async function compiledAt(url) {
  if (url.protocol === 'file:') {
    const files = 'node:fs/promises';  // a name that bundlers do not follow
    const { readFile } = await import(/* @vite-ignore */ /* webpackIgnore: true */ files);
    return WebAssembly.compile(await readFile(url));
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: expected tessera.wasm, the server answers ${response.status}`);
  const isStreamed = response.headers.get('content-type')?.startsWith('application/wasm');
  return isStreamed ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}
