// Sizes of a package's parts: node sizes.mjs FOLDER, the folder that the target tessera_npm makes.
import { readFileSync, readdirSync } from 'node:fs';
import { extname, join } from 'node:path';
import { brotliCompressSync, constants } from 'node:zlib';

/** Parts with their bytes, plain and by brotli, each file compressed alone as servers do. */
export function sizesOf(folder) {
  const filesIn = (...path) => readdirSync(join(folder, ...path), { withFileTypes: true })
    .filter((entry) => entry.isFile() && ['.js', '.wasm'].includes(extname(entry.name)))
    .map((entry) => join(folder, ...path, entry.name));
  const parts = { 'tessera.wasm': [], 'index.js, src': [] };
  for (const file of [...filesIn(), ...filesIn('src')]) parts[file.endsWith('.wasm') ? 'tessera.wasm' : 'index.js, src'].push(file);
  for (const name of ['worker', 'three']) if (readdirSync(folder).includes(name)) parts[name] = filesIn(name);
  return Object.entries(parts).map(([part, files]) => {
    const contents = files.map((file) => readFileSync(file));
    const packed = contents.map((bytes) => brotliCompressSync(bytes,
      { params: { [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length, [constants.BROTLI_PARAM_LGWIN]: 24 } }));
    const sum = (list) => list.reduce((bytes, each) => bytes + each.length, 0);
    return { part, files: files.length, bytes: sum(contents), brotli: sum(packed) };
  });
}

if (process.argv[1]?.endsWith('sizes.mjs')) {
  if (!process.argv[2]) {
    console.error('usage: node sizes.mjs FOLDER');
    process.exit(2);
  }
  console.table(sizesOf(process.argv[2]));
}
