// The package as its users have it: packed, installed without a network, twelve lines, a mesh; and its size.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';

import { block, folder } from './package.mjs';

const hasNpm = spawnSync('npm', ['--version']).status === 0;
function run(command, values, cwd) {
  const { status, stdout, stderr } = spawnSync(command, values, { cwd, encoding: 'utf8', timeout: 60_000 });
  assert.equal(status, 0, `${command} ${values.join(' ')}: ${stderr}${stdout}`);
  return stdout;
}

test('the packed package is installed without a network, and makes a mesh', { skip: !hasNpm && 'no npm' }, () => {
  const place = mkdtempSync(join(tmpdir(), 'tessera-pack-'));
  try {
    const [{ filename, files }] = JSON.parse(run('npm', ['pack', '--json', '--pack-destination', place, folder], place));
    const names = files.map(({ path }) => path);
    for (const wanted of ['tessera.wasm', 'index.js', 'index.d.ts', 'worker/thread.js', 'README.md', 'LICENSE', 'src/layout.js'])
      assert.ok(names.includes(wanted), `${wanted} is not among ${names}`);
    for (const name of names) assert.match(name, /^(src|three|worker)\/[\w-]+(\.d)?\.[jt]s$|^(index\.(d\.ts|js)|tessera\.wasm|README\.md|LICENSE|package\.json)$/);
    writeFileSync(join(place, 'package.json'), '{ "type": "module" }');
    run('npm', ['install', '--offline', '--no-audit', '--no-fund', `./${filename}`], place);
    writeFileSync(join(place, 'block.step'), block);
    const [, lines] = /```js\n([\s\S]*?)```/.exec(readFileSync(join(folder, 'README.md'), 'utf8'));
    assert.ok(lines.split('\n').length <= 13, 'twelve lines');
    writeFileSync(join(place, 'twelve.js'), lines.replaceAll('part.step', 'block.step'));
    const out = run(process.execPath, ['twelve.js'], place);
    assert.match(out, /[1-9]\d* triangles/);
    assert.ok(readFileSync(join(place, 'part.glb')).length > 1000);
  } finally {
    rmSync(place, { recursive: true });
  }
});

test('package.json names only files that are there', () => {
  const { exports, files } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  const there = new Set(readdirSync(folder));
  // The folder three comes with its own tests.
  for (const name of files) if (name !== 'three') assert.ok(there.has(name), name);
  for (const [path, target] of Object.entries(exports))
    if (path !== './three')
      for (const file of typeof target === 'string' ? [target] : Object.values(target)) readFileSync(join(folder, file));
});
