// The package under test, in the folder that TESSERA_NPM names, and its instances.
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

export const folder = resolve(process.env.TESSERA_NPM ?? 'build/wasm/npm');
export const root = fileURLToPath(new URL('../..', import.meta.url));
const imported = (path) => import(pathToFileURL(join(folder, path)));

export const core = await imported('index.js');
export const worker = await imported('worker/index.js');
export const { its } = await imported('src/internal.js');
export const compiled = await core.compile();
export const load = () => core.init(compiled);

export const fileOf = (path) => readFileSync(join(root, path));
export const teapot = fileOf('tools/models/teapot.bpt'), block = fileOf('tools/models/bearing_block.step');
/** A flat square from 0 to 1. */
export const square = { degreeU: 1, degreeV: 1, points: [0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0] };

/** The error that a call throws or rejects with: its code; checks that it is a TesseraError with a sentence. */
export async function errorOf(call) {
  try {
    await call();
  } catch (error) {
    if (!(error instanceof core.TesseraError)) throw error;
    if (!/\S{2,} \S/.test(error.message)) throw new Error(`no sentence: "${error.message}"`);
    return error;
  }
  throw new Error(`no error: ${call}`);
}
export async function codeOf(call) { return (await errorOf(call)).code; }

/** Counts the bytes that the package's own code has allocated in an instance: returns a function that says them. */
export function liveBytes(tessera) {
  const module = tessera[its.module], { exports } = module, live = new Map();
  module.exports = {
    ...exports,
    malloc: (size) => {
      const at = exports.malloc(size);
      if (at !== 0) live.set(at >>> 0, size);
      return at;
    },
    free: (at) => {
      if (at !== 0 && !live.delete(at >>> 0)) throw new Error(`free(${at}) of no block`);
      exports.free(at);
    },
  };
  return () => [...live.values()].reduce((sum, size) => sum + size, 0);
}
