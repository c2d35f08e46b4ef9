// The part that all objects of the module have in common.
import { TesseraError } from './errors.js';
import { its } from './internal.js';

/** An object of the module, with its memory there until dispose(). */
export class Handle {
  #handle;

  constructor(module, handle) {
    Object.defineProperty(this, its.module, { value: module });
    this.#handle = handle;
  }
  get isDisposed() { return this.#handle === 0; }
  get [its.handle]() {
    if (this.#handle === 0) throw disposed(this);
    return this.#handle;
  }
  dispose() {
    const module = this[its.module];
    if (this.#handle !== 0 && !module.isBroken) module.call('tsr_release', this.#handle);
    this.#handle = 0;
  }
}
if (Symbol.dispose) Handle.prototype[Symbol.dispose] = Handle.prototype.dispose;

export function disposed(object) {
  return new TesseraError('invalid_handle', `this ${object.constructor.name} was disposed`);
}

/** Makes the object of a new handle, which is released if that fails. */
export function adopted(module, handle, make) {
  try {
    return make(handle);
  } catch (error) {
    module.release(handle);
    throw error;
  }
}

/** Calls `name(...values, struct)` and returns these members of the struct by names in JavaScript's style. */
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
