// Copies of arguments for a worker.
import { TesseraError } from '../index.js';

/** Copies a value that can be sent, and adds the buffers of the copies to `transfer`. */
export function copied(name, value, transfer) {
  const invalid = (what) => new TesseraError('invalid_argument', `${name}: ${what}`);
  const keep = (copy, buffer) => (transfer.add(buffer), copy);
  if (typeof value === 'function' || typeof value === 'symbol')
    throw invalid(`a ${typeof value} cannot be sent to the worker`);
  if (value === null || typeof value !== 'object') return value;
  try {
    if (value instanceof ArrayBuffer) {
      const copy = value.slice(0);
      return keep(copy, copy);
    }
    if (ArrayBuffer.isView(value)) {
      const whole = new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
      const buffer = Uint8Array.from(whole).buffer;
      return keep(value instanceof DataView ? new DataView(buffer) : new (typeOf(value))(buffer), buffer);
    }
  } catch {
    throw invalid('the buffer of an array is detached');
  }
  // Long lists of numbers are not looked through.
  if (Array.isArray(value))
    return value.some((each) => typeof each === 'object' || typeof each === 'function')
      ? value.map((each) => copied(name, each, transfer)) : value.slice();
  if (![Object.prototype, null].includes(Object.getPrototypeOf(value))) return value;  // as the host copies it
  return Object.fromEntries(Object.entries(value).map(([key, each]) => [key, copied(name, each, transfer)]));
}

// The array's own type: a Buffer of Node is a Uint8Array elsewhere.
function typeOf(array) {
  const Type = globalThis[array[Symbol.toStringTag]];
  return Type ?? Uint8Array;
}
