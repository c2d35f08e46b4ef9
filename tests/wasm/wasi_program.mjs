// Runs a program of WASI in Node: wasi_program.mjs FILE [ARGUMENTS].
import { readFileSync } from 'node:fs';
import { WASI } from 'node:wasi';

const wasi = new WASI({ version: 'preview1', args: process.argv.slice(2), returnOnExit: true });
const host = { progress() {}, poll() {} };  // of engine/wasm32 and of loops
const imports = { wasi_snapshot_preview1: wasi.wasiImport, tessera: host };
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), imports);
process.exit(wasi.start(instance));
