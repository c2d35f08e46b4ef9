// Objects that stand for those of a worker, made of the classes of the core: there is no second list of their members.
import { TesseraError } from '../index.js';

/** Stands for an object of the worker. Its values are copies, as they were after the latest call. */
export class RemoteObject {
  #isDisposed = false;

  /** `id`: the number of the object in the worker; `facts`: its values; `relations`: what it was made of. */
  constructor(line, id, facts, relations = {}) {
    Object.assign(this, facts);
    const hidden = { line, id, generation: line.generation, ...relations };
    for (const [name, value] of Object.entries(hidden)) Object.defineProperty(this, name, { value });
  }
  get isDisposed() { return this.#isDisposed || !this.line.holds(this); }
  /** Returns an error where the object cannot be used. */
  fault() {
    const name = this.constructor.name;
    if (this.#isDisposed) return new TesseraError('invalid_handle', `this ${name} was disposed`);
    if (this.line.holds(this)) return null;
    return new TesseraError('invalid_handle', `this ${name} ended with its worker: ${this.line.reason}`);
  }
  async dispose() {
    if (this.isDisposed) return;
    this.#isDisposed = true;
    await this.line.release(this);
  }
}
if (Symbol.asyncDispose) RemoteObject.prototype[Symbol.asyncDispose] = RemoteObject.prototype.dispose;

/** Makes the class of objects that stand for those of a class of the core: what computes there is a promise here. */
export function remote(name, Core) {
  const Remote = { [name]: class extends RemoteObject {} }[name];
  for (const [member, { get, value }] of Object.entries(Object.getOwnPropertyDescriptors(Core.prototype))) {
    if (['constructor', 'dispose', 'isDisposed'].includes(member)) continue;
    const property = get ? { get() { return this.line.call(this, member, []); } }
      : { value(...values) { return this.line.call(this, member, values); } };
    Object.defineProperty(Remote.prototype, member, { ...property, configurable: true });
  }
  return Remote;
}
