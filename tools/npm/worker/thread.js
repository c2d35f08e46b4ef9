// The worker's side: runs one call after the other on an instance of its own.
import { Mesh, Model, Patches, Plan, Scene, TesseraError, init } from '../index.js';
import { its } from '../src/internal.js';

const kinds = { Model, Patches, Plan, Mesh, Scene };
const progressInterval = 30;  // milliseconds
const objects = new Map();  // by number, as index.js counts them; 0: the instance
const ids = new WeakMap();  // their numbers
let flag = null;            // where index.js writes the number of a call that it cancels
let post = (message, transfer) => globalThis.postMessage(message, transfer);

/** The members of an object that it keeps as values: index.js has copies of them. */
function factsOf(object) { return { ...object }; }

/** A result as it is sent: objects of the module stay here, and views of its memory are copied. */
function sent(value, id, transfer) {
  const kind = Object.keys(kinds).find((name) => value instanceof kinds[name]);
  if (kind) {
    if (!ids.has(value)) {
      objects.set(id, value);
      ids.set(value, id);
    }
    return { kind, id: ids.get(value), facts: factsOf(value) };
  }
  const copies = (each) => {
    if (ArrayBuffer.isView(each)) {
      const copy = each.buffer === objects.get(0)[its.module].exports.memory.buffer ? each.slice() : each;
      transfer.add(copy.buffer);
      return copy;
    }
    if (Array.isArray(each)) return each.map(copies);
    if (each === null || typeof each !== 'object') return each;
    return Object.fromEntries(Object.entries(each).map(([name, inner]) => [name, copies(inner)]));
  };
  return { value: copies(value) };
}

function errorOf(error) {
  if (error instanceof TesseraError) return { code: error.code, message: error.message, index: error.index };
  return { code: 'internal', message: error?.message ?? String(error), index: -1 };
}

/** Adds to the options of a call what tells of its progress and sees that it is cancelled. */
function withRun(options, number, { progress, signal }) {
  const run = {};
  let last = -Infinity;
  if (progress)
    run.progress = (share) => {
      if (share < 1 && performance.now() - last < progressInterval) return;
      last = performance.now();
      post({ number, share });
    };
  if (signal && flag) run.signal = { get aborted() { return Atomics.load(flag, 0) === number; } };
  return { ...options, ...run };
}

async function answer({ number, target, name, values, run }) {
  const transfer = new Set();
  const object = objects.get(target), list = values.map((each) => (each.isObject ? objects.get(each.id) : each.value));
  try {
    if (run) list[run.optionsAt] = withRun(list[run.optionsAt], number, run);
    const member = object[name], result = typeof member === 'function' ? await member.apply(object, list) : member;
    const reply = { number, result: sent(result, number, transfer) };
    reply.facts = changedFacts(object, list);
    post(reply, [...transfer]);
  } catch (error) {
    const isBroken = objects.get(0)?.[its.module].isBroken === true;
    post({ number, error: errorOf(error), isBroken, facts: isBroken ? [] : changedFacts(object, list) });
  }
}
/** The values of what a call may have changed: of its object, the patches of that, and its arguments. */
function changedFacts(object, list) {
  const changed = [object, object.patches, ...list].filter((each) => ids.has(Object(each)));
  return changed.map((each) => [ids.get(each), factsOf(each)]);
}

async function begin({ module, shared }) {
  flag = shared ? new Int32Array(shared) : null;
  try {
    const tessera = await init(module);
    objects.set(0, tessera);
    ids.set(tessera, 0);
    post({ begun: true, facts: factsOf(tessera) });
  } catch (error) {
    post({ begun: false, error: errorOf(error) });
  }
}

function take(message) {
  if (message.module) return begin(message);
  if (message.released === undefined) return answer(message);
  objects.get(message.released)?.dispose();
  objects.delete(message.released);
  post({ number: message.number, result: { value: undefined } });
  return undefined;
}

if (globalThis.postMessage && globalThis.addEventListener) {
  globalThis.addEventListener('message', ({ data }) => take(data));
} else {
  const threads = 'node:worker_threads';  // a name that bundlers do not follow
  // Messages wait until then. An await here would keep bundlers from making a classic worker.
  import(/* @vite-ignore */ /* webpackIgnore: true */ threads).then(({ parentPort }) => {
    post = (message, transfer) => parentPort.postMessage(message, transfer);
    parentPort.on('message', take);
  });
}
