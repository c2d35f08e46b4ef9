// Files packed by gzip or zip, which browsers and Node unpack, with the limits and sentences of the library's own zlib.
import { bytesOf, kindName } from './arguments.js';
import { TesseraError } from './errors.js';

const ratio = 200, slack = 2 ** 20, most = 2 ** 30;
const error = (code, name, sentence) => new TesseraError(code, `${name}: ${sentence}`);

/** Unpacks gzip data; `what`: in messages. */
async function inflated(name, bytes, what) {
  const limit = Math.min(ratio * bytes.length + slack, most), chunks = [];
  let size = 0;
  try {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
    for (const reader = stream.getReader(); ;) {
      const { done, value } = await reader.read();
      if (done) break;
      size += value.length;
      if (size > limit) {
        await reader.cancel();
        throw error('unsupported', name, `unpacks to more than ${limit} bytes; the limit is ${ratio} times the ` +
          'packed file and 1 MiB, and 1 GiB at the most; unpack it first (gunzip) if you trust it');
      }
      chunks.push(value);
    }
  } catch (cause) {
    throw cause instanceof TesseraError ? cause : error('parse_error', name, `${what} is damaged or cut off`);
  }
  if (size === 0) throw error('parse_error', name, 'the file is empty');
  const whole = new Uint8Array(size);
  let at = 0;
  for (const chunk of chunks) {
    whole.set(chunk, at);
    at += chunk.length;
  }
  return whole;
}

/** Wraps deflated data as gzip, so that their size and sum are checked, and for hosts that know gzip alone. */
function asGzip(deflated, sum, size) {
  const wrapped = new Uint8Array(deflated.length + 18), view = new DataView(wrapped.buffer);
  wrapped.set([0x1f, 0x8b, 8]);
  wrapped.set(deflated, 10);
  view.setUint32(deflated.length + 10, sum, true);
  view.setUint32(deflated.length + 14, size, true);
  return wrapped;
}

const endSize = 22, entrySize = 46, headSize = 30;  // of a zip archive's records, without names and comments
const endOfZip = 0x06054b50, entryOfZip = 0x02014b50, headOfZip = 0x04034b50, inZip64 = 0xffffffff;

/** A zip archive, by its directory (PKWARE's APPNOTE, 4.3). */
class ZipArchive {
  constructor(name, bytes) {
    Object.assign(this, { name, bytes, view: new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength) });
  }
  damaged(what) { return error('parse_error', this.name, `the zip archive ${what}`); }
  other(what) { return error('unsupported', this.name, `the zip archive ${what}; unpack it first (unzip)`); }
  holds(at, size) { return at + size <= this.bytes.length; }
  half(at) { return this.view.getUint16(at, true); }
  word(at) { return this.view.getUint32(at, true); }

  // The record at the end, whose comment ends with the archive.
  end() {
    for (let comment = 0; comment <= 0xffff && this.holds(0, endSize + comment); ++comment) {
      const at = this.bytes.length - comment - endSize;
      if (this.word(at) === endOfZip && this.half(at + 20) === comment) return at;
    }
    throw this.damaged('has no end; it may be cut');
  }
  /** Returns the entry of the only file, and its name. */
  onlyFile() {
    const end = this.end(), entries = this.half(end + 10), files = [];
    let at = this.word(end + 16);
    if (entries === 0xffff || at === inZip64) throw this.other('is of the kind Zip64');
    for (let k = 0; k < entries; ++k) {
      if (!this.holds(at, entrySize) || this.word(at) !== entryOfZip) throw this.damaged('has a damaged directory');
      const size = this.half(at + 28);
      if (!this.holds(at + entrySize, size)) throw this.damaged('has a damaged directory');
      const inner = new TextDecoder().decode(this.bytes.slice(at + entrySize, at + entrySize + size));
      if (!inner.endsWith('/')) files.push({ at, inner });
      at += entrySize + size + this.half(at + 30) + this.half(at + 32);
    }
    if (files.length === 0) throw this.damaged('holds no file');
    if (files.length > 1) throw this.other(`holds ${files.length} files, it must hold one`);
    return files[0];
  }
  async content(entry) {
    const method = this.half(entry + 10), sum = this.word(entry + 16), head = this.word(entry + 42);
    const packed = this.word(entry + 20), size = this.word(entry + 24);
    if (this.half(entry + 8) & 1) throw this.other('is encrypted');
    if (method !== 0 && method !== 8) throw this.other(`uses compression ${method}`);
    if ([packed, size, head].includes(inZip64)) throw this.other('is of the kind Zip64');
    if (!this.holds(head, headSize) || this.word(head) !== headOfZip) throw this.damaged('has a damaged header');
    const begin = head + headSize + this.half(head + 26) + this.half(head + 28);
    if (!this.holds(begin, packed)) throw this.damaged('ends within its file');
    const data = this.bytes.subarray(begin, begin + packed);
    return method === 0 ? data : inflated(this.name, asGzip(data, sum, size), 'the deflated data');
  }
}

/** Returns the file that the bytes hold: themselves, unless they begin as gzip or as a zip archive does. */
export async function unpacked(name, given) {
  let bytes = bytesOf(given);
  const begins = (...values) => values.every((value, k) => bytes[k] === value);
  if (begins(0x50, 0x4b, 3, 4)) {
    const archive = new ZipArchive(name, bytes), { at, inner } = archive.onlyFile();
    // The name states the format unless it is an archive's own.
    return { name: /\.zip$/i.test(name) ? inner : name, bytes: await archive.content(at) };
  }
  const plain = name.replace(/\.gz$/i, '');
  if (!begins(0x1f, 0x8b) && plain === name) return { name, bytes };
  if (!begins(0x1f, 0x8b))
    throw error('parse_error', name, 'expected gzip data; remove .gz from the name if the file is not packed');
  if (kindName(bytes.buffer) === 'SharedArrayBuffer') bytes = bytes.slice();
  return { name: plain, bytes: await inflated(name, bytes, 'the gzip data') };
}
