// tessera.wasm gives the bytes and the sentences of the native library with SSE2:
//   compare.mjs MODULE RESULTS ROOT [DATA]
// MODULE is tessera.wasm, RESULTS the program of results.c, ROOT the sources, DATA the folder of real models.
import assert from 'node:assert';
import { mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { brotliCompressSync, constants, gzipSync } from 'node:zlib';

import { layoutOf } from '../../tools/npm/layout.mjs';
import { Module } from '../../tools/npm/src/module.js';
import { comparison, nativeResults, resultOf } from './results.mjs';

const [moduleFile, program, root, data] = process.argv.slice(2);
const maxBrotliBytes = 1_150_000;  // with the readers of all formats, and rays
const layout = layoutOf(join(root, 'engine/include/tessera'));
const compiled = await WebAssembly.compile(readFileSync(moduleFile));
const load = () => Module.load(compiled, layout);

let faults = 0;
function report(ok, sentence) {
  console.log(`${ok ? 'ok' : 'FAILED'}: ${sentence}`);
  faults += ok ? 0 : 1;
}

function filesBelow(folder, pattern) {
  return readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile() && pattern.test(entry.name))
    .map((entry) => join(entry.path, entry.name)).sort();
}

/** A native result with the name of its status instead of the number. */
function named(tessera, { code, ...result }) {
  return code === undefined ? result : { ...result, code: tessera.text(tessera.exports.tsr_status_name(code)) };
}

/**
 * Compares all files, which the native program reads 20 at a time. `inLastBits`: how many meshes may have other last
 * bits, and hits of how many, see comparison().
 */
function compare(tessera, title, paths, inLastBits) {
  const differing = [], others = [], otherHits = [];
  let meshes = 0, errors = 0, own = 0;
  for (let k = 0; k < paths.length; k += 20) {
    const some = paths.slice(k, k + 20), wanted = nativeResults(program, some);
    some.forEach((path, n) => {
      const begin = performance.now(), found = resultOf(tessera, path);
      own += performance.now() - begin;
      const { fault, isSame, hasSameHits } = comparison(found, named(tessera, wanted[n]));
      if (fault) differing.push(`${basename(path)}: ${fault}`);
      else found.code ? ++errors : ++meshes;
      if (!fault && !isSame) others.push(basename(path));
      if (!fault && !hasSameHits) otherHits.push(basename(path));
    });
  }
  const areFew = others.length <= inLastBits.meshes && otherHits.length <= inLastBits.hits;
  report(paths.length > 0 && differing.length === 0 && areFew,
    `${title}: ${meshes} meshes and ${errors} errors of ${paths.length} files as natively, in ${Math.round(own)} ms` +
    (others.length ? `; other last bits in ${others.join(', ')}` : '') +
    (otherHits.length ? `; hits with other last bits in ${otherHits.join(', ')}` : ''));
  for (const line of differing) console.log(`  ${line}`);
}

/** Files cut short and with bytes changed: the same for every run. */
function damaged(folder, paths) {
  let state = 1;
  const random = (below) => (state = (state * 48271) % 2147483647) % below;
  return paths.flatMap((path, n) => {
    const bytes = readFileSync(path);
    return Array.from({ length: 12 }, (_, k) => {
      const copy = Buffer.from(k % 2 ? bytes : bytes.subarray(0, random(bytes.length + 1)));
      // Digits and bytes of any kind, by turns.
      if (k % 2) copy[random(copy.length)] = k % 4 === 1 ? 48 + random(10) : random(256);
      const to = join(folder, `${n}-${k}-${basename(path)}`);
      writeFileSync(to, copy);
      return to;
    });
  });
}

function checkSize() {
  const bytes = readFileSync(moduleFile);
  const brotli = brotliCompressSync(bytes, {
    params: { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_LGWIN]: 24 },
  }).length;
  const gzip = gzipSync(bytes, { level: 9 }).length;
  report(brotli <= maxBrotliBytes,
    `${bytes.length} bytes, ${gzip} by gzip, ${brotli} by brotli; at most ${maxBrotliBytes} by brotli`);
}

/** Where memory runs out, the call says so, and the module goes on. */
async function checkMemory() {
  const tessera = await load();
  const taken = [];
  for (let size = 2 ** 28; size >= 2 ** 16; size /= 2)
    for (let at; (at = tessera.exports.malloc(size)) !== 0;) taken.push(at >>> 0);
  const path = join(root, 'tools/models/teapot.bpt');
  const full = resultOf(tessera, path);
  report(full.code === 'out_of_memory', `without memory: ${full.code}, "${full.message}"`);
  tessera.free(...taken);
  const [wanted] = nativeResults(program, [path]);
  report(comparison(resultOf(tessera, path), wanted).isSame, 'the module goes on once there is memory again');
}

/** A handle of 32 bits that was released stays an error. */
function checkHandles(tessera) {
  const bytes = readFileSync(join(root, 'tools/models/teapot.bpt'));
  const content = tessera.copy(bytes), name = tessera.copy(new TextEncoder().encode('a.bpt'));
  const read = () => tessera.make('tsr_model_read_bytes', content, bytes.length, name, 0, 0);
  const first = read();
  tessera.call('tsr_release', first);
  assert.throws(() => tessera.call('tsr_release', first), /released/);
  for (let k = 0; k < 1000; ++k) {
    const next = read();
    assert.notStrictEqual(next, first);
    tessera.call('tsr_release', next);
  }
  assert.throws(() => tessera.call('tsr_retain', first), /released/);
  tessera.free(content, name);
  report(true, 'handles that were released are errors');
}

const tessera = await load();
const models = join(root, 'tools/models');
compare(tessera, 'models of the project', filesBelow(models, /\.(json|bpt|step)$/), { meshes: 8, hits: 11 });
const corpus = filesBelow(join(root, 'tests/corpus'), /\.(bpt|bv|g2|json|obj|rib|stp|step)$/);
compare(tessera, 'the corpora', corpus, { meshes: 2, hits: 2 });
const scratch = mkdtempSync(join(tmpdir(), 'tessera-wasm-'));
try {
  compare(tessera, 'damaged files', damaged(scratch, corpus), { meshes: 2, hits: 2 });
} finally {
  rmSync(scratch, { recursive: true });
}
if (data) {
  const step = filesBelow(data, /\.(stp|step)$/i).filter((path) => statSync(path).size < 2 ** 20);
  const every = Math.max(1, Math.floor(step.length / 60));
  compare(tessera, 'STEP files', step.filter((_, k) => k % every === 0).slice(0, 60), { meshes: 6, hits: 0 });
}
checkHandles(tessera);
await checkMemory();
checkSize();
process.exit(faults === 0 ? 0 : 1);
