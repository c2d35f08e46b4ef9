// The calls to a worker, in their order, and the worker, which ends where a call cannot be cancelled otherwise.
import { TesseraError } from '../index.js';
import { copied } from './copied.js';
import { RemoteObject } from './remote.js';

const cancelled = () => new TesseraError('cancelled', 'cancelled by the caller');

async function spawned() {
  if (typeof globalThis.Worker === 'function')
    return new Worker(new URL('./thread.js', import.meta.url), { type: 'module' });
  const threads = 'node:worker_threads', file = './thread.js';  // names that bundlers do not follow
  const { Worker: Thread } = await import(/* @vite-ignore */ /* webpackIgnore: true */ threads);
  // The program's own options, such as --input-type, are none for this file.
  return new Thread(new URL(file, import.meta.url), { execArgv: [] });
}
function listen(worker, type, take) {
  if (worker.on) worker.on(type, take);
  else worker.addEventListener(type, (event) => take(type === 'message' ? event.data : event));
}

export class Line {
  #module;
  #kinds;
  #flag;
  #worker = null;
  #starting = null;
  #queue = [];
  #running = null;
  #objects = new Map();  // of the worker, by number
  #next = 1;
  #isTerminated = false;

  constructor(module, isShared, kinds) {
    this.#module = module;
    this.#kinds = kinds;
    this.#flag = isShared ? new Int32Array(new SharedArrayBuffer(4)) : null;
    this.generation = 0;
    this.reason = '';
  }

  /** Starts the worker unless it runs. Returns the values of its instance. */
  start() {
    this.#starting ??= this.#begin().catch((error) => {
      this.#starting = null;
      throw error;
    });
    return this.#starting;
  }
  async #begin() {
    const worker = await spawned();
    const begun = new Promise((resolve, reject) => {
      listen(worker, 'message', (message) => {
        if (message.begun === undefined) this.#take(worker, message);
        else if (message.begun) resolve(message.facts);
        else reject(new TesseraError(message.error.code, message.error.message));
      });
      const fail = (what) => {
        const error = new TesseraError('internal', `the worker ended: ${what}`);
        reject(error);
        if (this.#worker === worker) this.#end(error);
      };
      listen(worker, 'error', (event) => fail(event.message ?? 'its script could not be loaded'));
      listen(worker, 'exit', () => fail('its thread was stopped'));
    });
    if (this.#isTerminated) worker.terminate();
    this.#worker = worker;
    worker.postMessage({ module: this.#module, shared: this.#flag?.buffer });
    const facts = await begun.catch((error) => {
      worker.terminate();
      throw error;
    });
    if (!this.#running) worker.unref?.();  // an idle worker keeps no program of Node alive
    return facts;
  }

  /** Whether an object's worker runs still. */
  holds(object) { return !this.#isTerminated && (object.id === 0 || object.generation === this.generation); }

  /** Calls a method of an object, or reads a property. */
  call(object, name, given) {
    return new Promise((resolve, reject) => {
      const fault = object.fault();
      if (fault) throw fault;
      const entry = { number: this.#next++, object, name, resolve, reject, transfer: new Set(), failure: null };
      this.#fill(entry, given);
      if (entry.signal?.aborted) throw cancelled();
      entry.abort = () => this.#cancel(entry);
      entry.signal?.addEventListener('abort', entry.abort);
      this.#queue.push(entry);
      this.#pump();
    });
  }
  /** Copies the arguments now: the caller may change them while the call waits. */
  #fill(entry, given) {
    const last = given.at(-1), { progress, signal, ...rest } = isOptions(last) ? last : {};
    if (progress !== undefined && typeof progress !== 'function')
      throw new TesseraError('invalid_argument', 'progress: expected a function');
    if (signal !== undefined && typeof signal?.addEventListener !== 'function')
      throw new TesseraError('invalid_argument', 'signal: expected an AbortSignal');
    const hasRun = progress !== undefined || signal !== undefined;
    const uses = [entry.object, ...given.filter((each) => each instanceof RemoteObject)];
    Object.assign(entry, { progress, signal, uses });
    const list = hasRun ? [...given.slice(0, -1), rest] : given;
    entry.values = list.map((value) => this.#sent(entry, value));
    if (hasRun)
      entry.run = { optionsAt: list.length - 1, progress: progress !== undefined, signal: Boolean(progress ?? signal) };
  }
  #sent(entry, value) {
    if (!(value instanceof RemoteObject)) return { value: copied(entry.name, value, entry.transfer) };
    const fault = value.fault();
    if (fault) throw fault;
    if (value.line === this) return { isObject: true, id: value.id };
    throw new TesseraError('invalid_argument',
      `${entry.name}: the ${value.constructor.name} is of another instance of the module`);
  }
  /** Lets go of an object, after the calls that came before. */
  release(object) {
    return new Promise((resolve) => {
      this.#queue.push({ number: this.#next++, released: object.id, uses: [object], resolve, reject: resolve });
      this.#pump();
    });
  }

  async #pump() {
    if (this.#running || this.#queue.length === 0) return;
    const entry = this.#running = this.#queue.shift();
    try {
      await this.start();
    } catch (error) {
      if (this.#running === entry) this.#settle(entry, () => entry.reject(error));
      return;
    }
    if (this.#running !== entry) return;  // ended meanwhile
    entry.worker = this.#worker;
    const { number, name, values, released, run } = entry;
    // An object that the call makes has the call's number.
    const message = { number, target: entry.object?.id, name, values, released, run };
    try {
      this.#worker.postMessage(message, [...entry.transfer ?? []]);
      this.#worker.ref?.();
    } catch (error) {  // an argument that cannot be sent, such as a promise
      this.#settle(entry, () => entry.reject(new TesseraError('invalid_argument', `${name}: ${error.message}`)));
    }
  }
  #settle(entry, settle) {
    entry.signal?.removeEventListener('abort', entry.abort);
    this.#running = null;
    this.#worker?.unref?.();
    settle();
    this.#pump();
  }

  #take(worker, message) {
    const entry = this.#running;
    if (worker !== this.#worker || entry?.number !== message.number) return;
    if (message.share !== undefined) {
      this.#progress(entry, message.share);
      return;
    }
    for (const [id, facts] of message.facts ?? []) Object.assign(this.#objects.get(id) ?? {}, facts);
    if (entry.released !== undefined) this.#objects.delete(entry.released);
    const { error } = message;
    const thrown = error && new TesseraError(error.code, error.message, error.index);
    if (message.isBroken) return void this.#end(thrown);
    const result = error ? null : this.#received(entry, message.result);
    if (entry.failure) result?.dispose?.();
    this.#settle(entry, () => {
      if (entry.failure) entry.reject(entry.failure.error);
      else if (thrown) entry.reject(thrown);
      else entry.resolve(result);
    });
  }
  #received(entry, { kind, id, facts, value }) {
    if (!kind) return value;
    if (this.#objects.has(id)) return this.#objects.get(id);
    const { object } = entry;
    const relations = { Patches: { model: object }, Plan: { patches: object }, Scene: { patches: object },
      Mesh: { patches: object.patches } }[kind];
    const made = new this.#kinds[kind](this, id, facts, relations);
    this.#objects.set(id, made);
    return made;
  }

  #progress(entry, share) {
    try {
      if (entry.failure || entry.progress(share) !== false) return;
    } catch (error) {
      entry.failure = { error };
    }
    this.#cancel(entry);
  }
  #cancel(entry) {
    const error = entry.failure?.error ?? cancelled();
    const waiting = this.#queue.indexOf(entry);
    if (waiting >= 0) {
      this.#queue.splice(waiting, 1);
      entry.reject(error);
    } else if (this.#running !== entry) {
      return;
    } else if (!entry.worker) {
      this.#settle(entry, () => entry.reject(error));  // the worker has not begun
    } else if (this.#flag) {
      Atomics.store(this.#flag, 0, entry.number);
    } else {
      this.#end(error, 'a running call was cancelled');
    }
  }

  /** Ends the worker: the call that runs fails by `error`, those that use its objects fail, others begin a new one. */
  #end(error, reason = error.message) {
    const entry = this.#running, worker = this.#worker;
    this.#worker = this.#starting = this.#running = null;
    worker?.terminate();
    this.generation++;
    this.reason = reason;
    this.#objects.clear();
    const waiting = this.#queue;
    this.#queue = [];
    if (entry) {
      entry.signal?.removeEventListener('abort', entry.abort);
      entry.reject(error);
    }
    for (const each of waiting) {
      // A call that the same signal cancels has not been told yet.
      const lost = each.released !== undefined || each.signal?.aborted ? cancelled() : null;
      const fault = lost ?? each.uses.map((object) => object.fault()).find(Boolean);
      if (!fault) this.#queue.push(each);
      else each.reject(fault);
    }
    this.#pump();
  }
  terminate() {
    if (this.#isTerminated) return;
    this.#isTerminated = true;
    this.#end(cancelled(), 'it was terminated');
  }
}

function isOptions(value) {
  return typeof value === 'object' && value !== null && [Object.prototype, null].includes(Object.getPrototypeOf(value));
}
