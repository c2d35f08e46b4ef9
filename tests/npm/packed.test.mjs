// Packed files: gzip, zip, .stpz; damaged, cut, and larger than they may be.
import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { deflateRawSync, gzipSync } from 'node:zlib';

import { block, codeOf, errorOf, fileOf, load, root, teapot } from './package.mjs';

/** The archive of some files, whose sums are left out of their heads. */
function zipOf(files, method = 8) {
  const parts = [], directory = [];
  let at = 0;
  for (const [name, content, sum] of files) {
    const data = method === 8 ? deflateRawSync(content) : Buffer.from(content), title = Buffer.from(name);
    const head = Buffer.alloc(30), entry = Buffer.alloc(46);
    head.writeUInt32LE(0x04034b50, 0);
    head.writeUInt16LE(title.length, 26);
    entry.writeUInt32LE(0x02014b50, 0);
    entry.writeUInt16LE(method, 10);
    entry.writeUInt32LE(sum, 16);
    entry.writeUInt32LE(data.length, 20);
    entry.writeUInt32LE(content.length, 24);
    entry.writeUInt16LE(title.length, 28);
    entry.writeUInt32LE(at, 42);
    parts.push(head, title, data);
    directory.push(entry, title);
    at += 30 + title.length + data.length;
  }
  const end = Buffer.alloc(22);
  end.writeUInt32LE(0x06054b50, 0);
  end.writeUInt16LE(files.length, 10);
  end.writeUInt32LE(at, 16);
  return Buffer.concat([...parts, ...directory, end]);
}
const sumOf = (content) => gzipSync(content).readUInt32LE(gzipSync(content).length - 8);

test('packed files are read as plain ones', async () => {
  const tessera = await load(), sum = sumOf(block);
  for (const [name, bytes] of [['teapot.bpt.gz', gzipSync(teapot)], ['teapot.bpt', teapot], ['teapot.bpt', gzipSync(teapot)]])
    assert.equal((await tessera.open(name, bytes)).surfaceCount, 32);
  const faces = tessera.read('block.step', block).surfaceCount, files = [['block.step', block, sum]];
  const shared = new Uint8Array(new SharedArrayBuffer(gzipSync(block).length));
  shared.set(gzipSync(block));
  for (const [name, bytes, options] of [['a.stpz', zipOf(files)], ['a.stpz', gzipSync(block)], ['a.zip', zipOf(files)],
    ['a.step', zipOf([['folder/', '', 0], ...files], 8)], ['a.stp', block], ['a.stp.gz', shared],
    ['a', gzipSync(block), { format: 'step.gz' }], ['a', block, { format: 'step' }]])
    assert.equal((await tessera.open(name, bytes, options)).surfaceCount, faces, name);
  assert.equal(await codeOf(() => tessera.read('a.stp.gz', gzipSync(block))), 'unsupported');
});

test('damaged archives are errors', async () => {
  const tessera = await load(), zip = zipOf([['block.step', block, sumOf(block)]]), packed = gzipSync(teapot);
  const wrong = [
    ['a.bpt.gz', teapot, /expected gzip data/], ['a.bpt.gz', packed.subarray(0, 99), /damaged or cut/],
    ['a.bpt.gz', packed.subarray(0, packed.length - 1), /damaged or cut/], ['a.bpt.gz', gzipSync(''), /the file is empty/],
    ['a.bpt.gz', Buffer.concat([packed, Buffer.from('more')]), /damaged or cut/], ['a.bpt', '', /a\.bpt/],
    ['a.stpz', zip.subarray(0, zip.length - 1), /no end/], ['a.stpz', zip.subarray(0, 999), /no end/],
    ['a.stpz', zipOf([['block.step', block, 5]]), /damaged or cut/], ['a.stpz', zipOf([]), /expected|no end|zip/],
    ['a.stpz', zipOf([['folder/', '', 0]]), /holds no file/], ['a.stpz', zipOf([['a', 'a', 0], ['b', 'b', 0]]), /holds 2 files/],
    ['a.stpz', zipOf([['a.step', block, 0]], 14), /uses compression 14/],
    ['huge.bpt.gz', gzipSync(Buffer.alloc(2 ** 27)), /unpacks to more than .* bytes; the limit is 200 times/],
  ];
  for (const [name, bytes, sentence] of wrong) {
    const error = await errorOf(() => tessera.open(name, bytes));
    assert.match(error.message, sentence);
    assert.ok(['parse_error', 'unsupported'].includes(error.code), error.code);
  }
});

test('bytes of any kind end in an error or a model', async () => {
  const tessera = await load(), zip = zipOf([['block.step', block, sumOf(block)]]), packed = gzipSync(block);
  let state = 1;
  const random = (below) => (state = (state * 48271) % 2147483647) % below;
  for (let k = 0; k < 300; ++k) {
    const copy = Buffer.from(k % 2 ? zip : packed);
    // The directory and the end are where most of an archive's numbers lie.
    for (let n = 0; n < 3; ++n) copy[k % 4 === 1 ? copy.length - 1 - random(100) : random(copy.length)] = random(256);
    await tessera.open('a.stpz', copy).then((model) => model.dispose(), (error) => assert.match(error.code, /^\w+$/));
  }
  for (const kind of ['gz', 'zip'])
    for (const name of readdirSync(join(root, 'tests/corpus', kind)))
      await tessera.open(`${name}.stpz`, fileOf(`tests/corpus/${kind}/${name}`))
        .then((model) => model.dispose(), (error) => assert.match(error.code, /^\w+$/));
});
