// Files packed by gzip or zip, which browsers and Node unpack.
import { TesseraError } from './errors.js';
import { bytesOf } from './model.js';

const parseError = (name, found) => new TesseraError('parse_error', `${name}: ${found}`);
// The limit of the library's own unpacking.
const limitOf = (size) => Math.min(200 * size + 2 ** 20, 2 ** 30);

async function inflated(name, bytes, format) {
  const limit = limitOf(bytes.length), chunks = [];
  let size = 0;
  try {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format));
    for (const reader = stream.getReader(); ;) {
      const { done, value } = await reader.read();
      if (done) break;
      size += value.length;
      if (size > limit) {
        await reader.cancel();
        throw parseError(name, `unpacks to more than ${limit} bytes`);
      }
      chunks.push(value);
    }
  } catch (error) {
    throw error instanceof TesseraError ? error : parseError(name, `the packed data are damaged or cut off`);
  }
  const whole = new Uint8Array(size);
  let at = 0;
  for (const chunk of chunks) {
    whole.set(chunk, at);
    at += chunk.length;
  }
  return whole;
}

const endOfZip = 0x06054b50, entryOfZip = 0x02014b50;

/** The only file of a zip archive, by its central directory (PKWARE's APPNOTE, 4.3.12). */
async function unzipped(name, bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let end = bytes.length - 22;
  while (end >= 0 && view.getUint32(end, true) !== endOfZip) --end;
  if (end < 0) throw parseError(name, 'the zip archive has no directory: it is cut off');
  const files = [];
  let at = view.getUint32(end + 16, true);
  for (let left = view.getUint16(end + 10, true); left > 0; --left) {
    if (at + 46 > bytes.length || view.getUint32(at, true) !== entryOfZip) throw parseError(name, 'the directory of the zip archive is damaged');
    const [nameSize, extraSize, commentSize] = [28, 30, 32].map((place) => view.getUint16(at + place, true));
    const inner = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + nameSize));
    if (!inner.endsWith('/'))
      files.push({ inner, method: view.getUint16(at + 10, true), size: view.getUint32(at + 20, true), local: view.getUint32(at + 42, true) });
    at += 46 + nameSize + extraSize + commentSize;
  }
  if (files.length !== 1) throw parseError(name, `expected an archive of one file, found ${files.length}`);
  const [{ inner, method, size, local }] = files;
  const first = local + 30 > bytes.length ? Infinity : local + 30 + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
  if (first + size > bytes.length) throw parseError(name, 'the zip archive is cut off');
  const packed = bytes.subarray(first, first + size);
  if (method === 0) return { name: inner, bytes: packed };
  if (method !== 8) throw parseError(name, `the zip archive packs by method ${method}, expected 0 or 8`);
  return { name: inner, bytes: await inflated(name, packed, 'deflate-raw') };
}

/** Returns the file that the bytes hold: themselves, unless they begin as gzip or as a zip archive does. */
export async function unpacked(name, bytes) {
  const content = bytesOf(bytes);
  const begins = (...values) => values.every((value, k) => content[k] === value);
  if (begins(0x50, 0x4b, 3, 4)) return unzipped(name, content);
  if (!begins(0x1f, 0x8b)) return { name, bytes: content };
  const inner = name.replace(/\.gz$/i, '').replace(/\.stpz$/i, '.stp');
  return { name: inner, bytes: await inflated(name, content, 'gzip') };
}
