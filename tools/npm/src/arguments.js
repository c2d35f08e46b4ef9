// Checks of what callers pass. Options that are misspelt, and lists of something else, would be silence otherwise.
import { TesseraError, invalid } from './errors.js';

/** The kind of a value, for messages. */
function kindOf(value) {
  if (value === null || value === undefined) return String(value);
  return typeof value === 'object' ? value.constructor?.name ?? 'an object' : `a ${typeof value}`;
}

/** Returns an object of options, {} where there is none. Checks that it has no others than these. */
export function optionsOf(what, options, known) {
  if (options === undefined || options === null) return {};
  if (typeof options !== 'object' || Array.isArray(options))
    throw invalid(`${what}: expected an object of options, found ${kindOf(options)}`);
  for (const name of Object.keys(options))
    if (!known.includes(name)) throw invalid(`${what}: there is no option ${name}; there are ${known.join(', ')}`);
  return options;
}

/** Returns whether an option is true; `usual` where it is left open. */
export function truthOf(options, name, usual = false) {
  const value = options[name] ?? usual;
  if (typeof value !== 'boolean') throw invalid(`${name}: expected true or false, found ${kindOf(value)}`);
  return value;
}
/** Returns the flags of options that are true. */
export function flagsOf(options, flags) {
  let set = 0;
  for (const [option, flag] of Object.entries(flags)) if (truthOf(options, option)) set |= flag;
  return set;
}

export function stringOf(what, value) {
  if (typeof value !== 'string') throw invalid(`${what}: expected a string, found ${kindOf(value)}`);
  return value;
}

/** Returns an index, which the library compares with how many there are. */
export function wholeOf(what, index) {
  if (Number.isSafeInteger(index) && index >= 0 && index < 0xffffffff) return index;
  const found = typeof index === 'number' ? index : kindOf(index);
  throw new TesseraError('invalid_argument', `${what} ${found} is none: expected a whole number of at least 0`);
}

/** Sets numbers of a struct; those that are undefined stay. */
export function setNumbers(module, struct, options, members) {
  for (const [option, member] of Object.entries(members)) {
    const value = options[option];
    if (value === undefined) continue;
    if (typeof value !== 'number' || Number.isNaN(value))
      throw invalid(`${option}: expected a number, found ${typeof value === 'number' ? value : kindOf(value)}`);
    const { read, bytes } = module.place(struct, member).member, isWhole = !read.includes('Float');
    if (isWhole && !(Number.isSafeInteger(value) && value >= 0 && (bytes === 8 || value < 2 ** 31)))
      throw invalid(`${option} is ${value}, expected a whole number from 0${bytes === 8 ? '' : ' to 2147483647'}`);
    module.set(struct, member, value);
  }
}

/** The name of a host's own type, whichever window or thread it is of: "ArrayBuffer". */
export function kindName(value) { return Object.prototype.toString.call(value).slice(8, -1); }

function isDetached(buffer) {
  try {
    void new Uint8Array(buffer);
    return false;
  } catch {
    return true;
  }
}

/** Returns an array or a typed array of numbers as one of this type. */
export function listOf(what, list, Type = Float64Array) {
  const isTyped = ArrayBuffer.isView(list) && typeof list[0] !== 'bigint' && !(list instanceof DataView);
  if (!isTyped && !Array.isArray(list)) throw invalid(`${what}: expected an array of numbers, found ${kindOf(list)}`);
  if (isTyped && isDetached(list.buffer)) throw invalid(`${what}: the array's buffer is detached`);
  if (list instanceof Type) return list;
  const isWrong = Type === Uint32Array
    ? (value) => !(Number.isInteger(value) && value >= 0 && value <= 0xffffffff) : (value) => typeof value !== 'number';
  const wrong = list.findIndex(isWrong);
  if (wrong >= 0) {
    const found = typeof list[wrong] === 'number' ? list[wrong] : kindOf(list[wrong]);
    const wanted = Type === Uint32Array ? 'a whole number of at least 0 and below 2^32' : 'a number';
    throw new TesseraError('invalid_argument', `${what}[${wrong}]: expected ${wanted}, found ${found}`, wrong);
  }
  return Type.from(list);
}
/** Returns how many records of so many numbers a list has. */
export function recordsOf(what, list, components) {
  if (list.length % components !== 0)
    throw invalid(`${what}: expected ${components} numbers each, found ${list.length} in all`);
  return list.length / components;
}
/** Returns indices of patches, and all their points with how many these are. */
export function editOf(patches, points) {
  const which = listOf('patches', patches, Uint32Array), where = listOf('points', points);
  const count = recordsOf('points', where, 3);
  if (which.length === 0 && count > 0) throw invalid(`points: found ${count}, but no patches that they are of`);
  return { which, where, count };
}
/** Returns names of a table, which all must be there. */
export function namesOf(what, names, table) {
  if (!Array.isArray(names)) throw invalid(`${what}: expected an array of names, found ${kindOf(names)}`);
  for (const name of names)
    if (!Object.hasOwn(table, name))
      throw invalid(`${String(name)} is no quantity; there are ${Object.keys(table).join(', ')}`);
  return names;
}

/** Returns bytes, or a text as UTF-8. */
export function bytesOf(bytes) {
  if (typeof bytes === 'string') return new TextEncoder().encode(bytes);
  const isBuffer = ['ArrayBuffer', 'SharedArrayBuffer'].includes(kindName(bytes));
  if (!isBuffer && !ArrayBuffer.isView(bytes))
    throw invalid(`read: expected bytes, a Uint8Array, an ArrayBuffer or a string, found ${kindOf(bytes)}`);
  if (isDetached(isBuffer ? bytes : bytes.buffer)) throw invalid('read: the buffer of the bytes is detached');
  return isBuffer ? new Uint8Array(bytes) : new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength);
}
