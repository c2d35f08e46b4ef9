// Makes the whole page in one folder, which any server of files can serve:  node assemble.mjs PACKAGE OUTPUT
// PACKAGE is the package of tools/npm as the target tessera_npm makes it. three comes from node_modules (npm ci).
import { cpSync, existsSync, mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { examples } from './src/examples.js';

const here = dirname(fileURLToPath(import.meta.url));
const own = ['index.html', 'style.css', 'icon.svg', 'serve.mjs', 'src', 'README.md'];
const ofThree = [['build/three.module.js', 'three.module.js'], ['build/three.core.js', 'three.core.js'],
  ['examples/jsm/controls/OrbitControls.js', 'addons/controls/OrbitControls.js'], ['LICENSE', 'LICENSE']];
const ofPackage = ['index.js', 'src', 'three', 'worker', 'tessera.wasm', 'LICENSE', 'package.json'];

function assemble(from, output) {
  const three = join(here, 'node_modules/three');
  if (!existsSync(three)) throw new Error(`three is not in ${join(here, 'node_modules')}: run npm ci in ${here}`);
  rmSync(output, { recursive: true, force: true });
  const copy = (file, to) => {
    mkdirSync(dirname(join(output, to)), { recursive: true });
    cpSync(file, join(output, to), { recursive: true });
  };
  for (const name of own) copy(join(here, name), name);
  for (const [name, to] of ofThree) copy(join(three, name), join('three', to));
  for (const name of ofPackage) copy(join(from, name), join('tessera', name));
  for (const [name] of examples) copy(resolve(here, '../models', name), join('models', name));
  const itself = { name: 'tessera-web', private: true, type: 'module', scripts: { start: 'node serve.mjs' } };
  writeFileSync(join(output, 'package.json'), `${JSON.stringify(itself, null, 2)}\n`);
}

const [from, output] = process.argv.slice(2);
if (!output) {
  console.error('usage: node assemble.mjs PACKAGE OUTPUT');
  process.exitCode = 2;
} else {
  try {
    assemble(resolve(from), resolve(output));
  } catch (error) {
    console.error(error.message);
    process.exitCode = 1;
  }
}
