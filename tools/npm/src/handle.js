// What all objects of the module have in common.
import { TesseraError, invalid } from './errors.js';

/** An object of the module, with its memory there until dispose(). */
export class Handle {
  #handle;

  constructor(module, handle) {
    Object.defineProperty(this, 'module', { value: module });
    this.#handle = handle;
  }
  get isDisposed() { return this.#handle === 0; }
  get handle() {
    if (this.#handle === 0) throw new TesseraError('invalid_handle', `the ${this.constructor.name} was disposed`);
    return this.#handle;
  }
  dispose() {
    if (this.#handle !== 0) this.module.call('tsr_release', this.#handle);
    this.#handle = 0;
  }
}
if (Symbol.dispose) Handle.prototype[Symbol.dispose] = Handle.prototype.dispose;

/** Calls `describe(handle, ...values, struct)` and returns these members of the struct by names in JavaScript's style. */
export function describe(module, name, struct, names, ...values) {
  return module.scratch(({ struct: make }) => {
    const info = make(struct);
    module.call(name, ...values, info.at);
    return Object.fromEntries(names.map((each) => [inCamelCase(each), module.get(info, each)]));
  });
}
export function inCamelCase(name) {
  return name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());
}

/** Checks that an object of options has no others than these: a misspelt one would be silence. */
export function checkNames(what, options, known) {
  for (const name of Object.keys(options ?? {}))
    if (!known.includes(name)) throw invalid(`${what}: there is no option ${name}; there are ${known.join(', ')}`);
}

/** Sets numbers of a struct; those that are undefined stay. */
export function setNumbers(module, struct, options, members) {
  for (const [option, member] of Object.entries(members)) {
    const value = options[option];
    if (value === undefined) continue;
    if (typeof value !== 'number') throw invalid(`${option}: expected a number, found ${typeof value}`);
    const { read, bytes } = module.place(struct, member).member, isWhole = !read.includes('Float');
    if (isWhole && !(Number.isSafeInteger(value) && value >= 0 && (bytes === 8 || value < 2 ** 31)))
      throw invalid(`${option} is ${value}, expected a whole number of at least 0${bytes === 8 ? '' : ' and below 2^31'}`);
    module.set(struct, member, value);
  }
}

/** Returns the flags of options that are true. */
export function flagsOf(options, flags) {
  let set = 0;
  for (const [option, flag] of Object.entries(flags)) if (options[option]) set |= flag;
  return set;
}

/** Lists of three numbers for each record; returns how many records there are. */
export function recordsOf(what, list, components) {
  if (typeof list?.length !== 'number') throw invalid(`${what}: expected a list of numbers`);
  if (list.length % components !== 0)
    throw invalid(`${what}: expected ${components} numbers each, found ${list.length} in all`);
  return list.length / components;
}
