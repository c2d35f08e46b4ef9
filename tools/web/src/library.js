// Tessera's side of the page: models are read, measured and asked in workers, each with memory of its own.
import { compile, init } from 'tessera/worker';
import { ModelObject } from 'tessera/three';

const degenerateNormal = 2;  // TSR_HIT_DEGENERATE_NORMAL
const moduleAddress = new URL('../tessera/tessera.wasm', import.meta.url);

/** Keeps one worker ready, so that a file is read at once. */
class Workers {
  #module = compile(moduleAddress);
  #next = null;

  another() { return this.#module.then((module) => init(module)); }
  prepare() { return (this.#next ??= this.another()); }
  take() {
    const taken = this.prepare();
    this.#next = null;
    return taken;
  }
}
const workers = new Workers();
let hasOpened = false;

/**
 * Makes a worker ready, and reads a small file in another: browsers compile what has run a while once more, and better,
 * for all workers that share the module.
 */
export async function prepare() {
  await workers.prepare();
  await new Promise((resolve) => setTimeout(resolve, 200));
  const response = await fetch(new URL('../models/bearing_block.step', import.meta.url));
  if (!response.ok || hasOpened) return;
  const tessera = await workers.another();
  const model = await tessera.open('warm.step', new Uint8Array(await response.arrayBuffer()));
  const patches = await model.patches();
  for (let k = 1; k <= 3 && !hasOpened; ++k) {
    const plan = await patches.plan({ pixels: 0.5, edges: true, view: warmView(await patches.box, k) });
    await plan.write();
  }
  tessera.terminate();
}
function warmView({ low, high }, k) {
  const target = low.map((value, c) => (value + high[c]) / 2);
  const size = Math.hypot(...low.map((value, c) => high[c] - value));
  return { eye: target.map((value, c) => value + size * [1, -1, 0.2 * k][c]), target };
}

/** Does work with a worker that ends as soon as the signal is raised, whatever it does then, or if the work fails. */
async function within(signal, tessera, work) {
  const stop = () => tessera.terminate();
  signal.addEventListener('abort', stop);
  try {
    signal.throwIfAborted();
    return await work();
  } catch (error) {
    stop();
    throw signal.aborted ? signal.reason : error;
  } finally {
    signal.removeEventListener('abort', stop);
  }
}

/** A model that is open: its patches, its object in the scene, and what can be asked about it. */
export class Document {
  #tessera;
  #model;
  #patches;
  #scene = null;

  /** Reads a source { name, bytes() }; `progress(words, share)` is told how far it is. */
  static async open(source, { signal, progress }) {
    hasOpened = true;
    const bytes = await source.bytes(signal);
    const tessera = await workers.take();
    try {
      return await within(signal, tessera, async () => {
        const made = new Document();
        await made.#read(tessera, source, bytes, progress);
        return made;
      });
    } finally {
      workers.prepare();
    }
  }
  async #read(tessera, source, bytes, progress) {
    // Measures are of these bytes, wherever the file is by then.
    Object.assign(this, { name: source.name, file: new Blob([bytes]) });
    this.#tessera = tessera;
    const model = (this.#model = await tessera.open(source.name, bytes,
      { progress: (share) => progress('Reading', 0.7 * share) }));
    const patches = (this.#patches = await model.patches(
      { progress: (share) => progress('Preparing', 0.7 + 0.3 * share) }));
    [this.warnings, this.instances, this.shapes, this.object] = await Promise.all(
      [model.warnings, model.instances(), model.shapes(), ModelObject.make(model, patches)]);
    Object.assign(this, { unit: model.unit, box: patches.box, patchCount: patches.count, cutCount: patches.cutCount,
      fitError: patches.fitError });
    this.faces = this.object.faces;
  }

  get diagonal() { return Math.hypot(...this.box.low.map((low, k) => this.box.high[k] - low)); }

  /** The nearest point of a face that is not hidden, on a ray: { surface, u, v, position, ... } or null. */
  async pick({ origin, direction }) {
    this.#scene ??= this.#patches.rays();
    const scene = await this.#scene;
    for (let near = 0, tries = 0; tries < 256; ++tries) {
      const hits = await scene.closest(origin, direction, { near });
      if (hits.kind[0] === 0) return null;
      if (!this.object.hidden[hits.surface[0]]) return this.#describe(hits);
      near = hits.t[0] + 1e-9 * (this.diagonal + Math.abs(hits.t[0]));
    }
    return null;
  }
  async #describe({ surface: [surface], uv: [u, v], position, normal, flags: [flags] }) {
    const names = ['firstCurvature', 'secondCurvature', 'gaussian', 'mean'];
    const found = await this.#patches.evaluate(surface, u, v, names);
    const curvatures = Object.fromEntries(Object.entries(found).map(([name, [value]]) => [name, value]));
    const isPole = (flags & degenerateNormal) !== 0;
    return { surface, u, v, isPole, position: Array.from(position), normal: Array.from(normal), ...curvatures };
  }

  /** The bytes of a .glb file within a tolerance. */
  async save(tolerance) {
    const plan = await this.#patches.plan({ tolerance });
    let mesh;
    try {
      mesh = await plan.write();
      return await mesh.save('glb');
    } finally {
      mesh?.dispose();
      plan.dispose();
    }
  }

  /** Measures in a worker of its own, so that the picture keeps moving. */
  async measure({ signal, progress }) {
    const bytes = new Uint8Array(await this.file.arrayBuffer()), tessera = await workers.take();
    try {
      return await within(signal, tessera, async () => {
        const model = await tessera.open(this.name, bytes, { progress: (share) => progress(0.2 * share) });
        return model.measure({ progress: (share) => progress(0.2 + 0.8 * share) });
      });
    } finally {
      tessera.terminate();
    }
  }

  close() { this.#tessera.terminate(); }
}
