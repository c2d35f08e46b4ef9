// The types: they compile, wrong uses do not, and they name the members that there are.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, symlinkSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';

import { core, folder, root, worker } from './package.mjs';

const compiler = process.env.TESSERA_TSC ?? 'tsc';
const hasCompiler = spawnSync(compiler, ['--version']).status === 0;

test('types.ts compiles by --strict, and its wrong uses do not',
  { skip: !hasCompiler && !process.env.TESSERA_REQUIRE_WASM && 'no TypeScript (node-typescript)' }, () => {
    const place = mkdtempSync(join(tmpdir(), 'tessera-types-'));
    try {
      mkdirSync(join(place, 'node_modules'));
      symlinkSync(folder, join(place, 'node_modules/tessera'));
      cpSync(join(root, 'tests/npm/types.ts'), join(place, 'types.mts'));
      const { status, stdout } = spawnSync(compiler, ['--strict', '--noEmit', '--target', 'es2022', '--lib', 'es2022,dom',
        '--module', 'node16', '--moduleResolution', 'node16', 'types.mts'], { cwd: place, encoding: 'utf8' });
      assert.equal(status, 0, stdout);
    } finally {
      rmSync(place, { recursive: true });
    }
  });

const texts = ['index.d.ts', ...readdirSync(join(folder, 'src')).filter((name) => name.endsWith('.d.ts')).map((name) => `src/${name}`)]
  .map((name) => readFileSync(join(folder, name), 'utf8')).join('\n');
/** The members that the types of a class name, those of its base too. */
function typed(name) {
  const [, base, body] = new RegExp(`class ${name} (?:extends (\\w+) )?\\{\n([\\s\\S]*?)\n\\}`).exec(texts);
  const own = [...body.matchAll(/^ {2}(?:readonly |get )?(\w+)[(:<?]/gm)].map(([, member]) => member);
  return new Set([...own.filter((member) => member !== 'constructor'), ...(base === 'Handle' ? typed('Handle') : [])]);
}

test('the types name all members, and no others', async () => {
  const tessera = await core.init(), { square } = await import('./package.mjs');
  const model = tessera.bspline([square]), patches = model.patches(), plan = patches.plan({ rates: 1 });
  const objects = { Tessera: tessera, Model: model, Patches: patches, Plan: plan, Mesh: plan.write(), Scene: patches.rays() };
  for (const [name, object] of Object.entries(objects)) {
    const members = new Set(Object.getOwnPropertyNames(object));
    for (let from = Object.getPrototypeOf(object); from !== Object.prototype; from = Object.getPrototypeOf(from))
      for (const member of Object.getOwnPropertyNames(from)) members.add(member);
    members.delete('constructor');
    assert.deepEqual([...typed(name)].sort(), [...members].sort(), name);
  }
});

test('the types export the names that the modules export', () => {
  const classes = [...texts.matchAll(/^export (?:class|function) (\w+)/gm)].map(([, name]) => name);
  const own = classes.filter((name) => name !== 'Handle');  // in src/common.d.ts alone
  assert.deepEqual(own.sort(), Object.keys(core).sort());
  const text = readFileSync(join(folder, 'worker/index.d.ts'), 'utf8');
  for (const name of Object.keys(worker)) assert.match(text, new RegExp(`\\b${name}\\b`));
});
