// Tessera's side of the page: models are read, measured and asked in workers, each with memory of its own.
import { compile, init } from 'tessera/worker';
import { ModelObject } from 'tessera/three';

const moduleAddress = new URL('../tessera/tessera.wasm', import.meta.url);

/** Keeps one worker ready, so that a file is read at once. */
class Workers {
  #module = compile(moduleAddress);
  #next = null;

  prepare() { return (this.#next ??= this.#module.then((module) => init(module))); }
  take() {
    const taken = this.prepare();
    this.#next = null;
    return taken;
  }
}
const workers = new Workers();
export const prepare = () => workers.prepare();

const cancelled = () => new DOMException('cancelled', 'AbortError');
/** Rejects as soon as the signal is raised, and closes the worker, which stops whatever it does. */
function unlessAborted(signal, tessera, work) {
  return new Promise((resolve, reject) => {
    const stop = () => {
      tessera.dispose();
      reject(cancelled());
    };
    if (signal.aborted) return stop();
    signal.addEventListener('abort', stop, { once: true });
    work().then(resolve, reject).finally(() => signal.removeEventListener('abort', stop));
  });
}

/** A model that is open: its patches, its object in the scene, and what can be asked about it. */
export class Document {
  #tessera;
  #model;
  #patches;
  #scene = null;

  /** Reads a source { name, bytes() }; `progress(words, share)` is told how far it is. */
  static async open(source, { signal, progress }) {
    const bytes = await source.bytes();
    const tessera = await workers.take();
    try {
      return await unlessAborted(signal, tessera, async () => {
        const made = new Document();
        await made.#read(tessera, source, bytes, progress);
        return made;
      });
    } catch (error) {
      tessera.dispose();
      throw error;
    } finally {
      workers.prepare();
    }
  }
  async #read(tessera, source, bytes, progress) {
    Object.assign(this, { source, name: source.name });
    this.#tessera = tessera;
    const model = (this.#model = await tessera.open(source.name, bytes,
      { progress: (share) => progress('Reading', 0.7 * share) }));
    const patches = (this.#patches = await model.patches({ progress: (share) => progress('Preparing', 0.7 + 0.3 * share) }));
    const object = ModelObject.make(model, patches);
    [this.unit, this.warnings, this.instances, this.shapes, this.box, this.patchCount, this.cutCount] = await Promise.all(
      [model.unit, model.warnings, model.instances(), model.shapes(), patches.box, patches.count, patches.cutCount]);
    this.object = await object;
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
  async #describe({ surface: [surface], uv: [u, v], position, normal }) {
    const found = await this.#patches.evaluate(surface, u, v, ['firstCurvature', 'secondCurvature', 'gaussian', 'mean']);
    const curvatures = Object.fromEntries(Object.entries(found).map(([name, [value]]) => [name, value]));
    return { surface, u, v, position: Array.from(position), normal: Array.from(normal), ...curvatures };
  }

  /** The bytes of a .glb file within a tolerance. */
  async save(tolerance) {
    const plan = await this.#patches.plan({ tolerance });
    const mesh = await plan.write();
    try {
      return await mesh.save('glb');
    } finally {
      mesh.dispose();
      plan.dispose();
    }
  }

  /** Measures in a worker of its own, so that the picture keeps moving. */
  async measure({ signal, progress }) {
    const bytes = await this.source.bytes(), tessera = await workers.take();
    try {
      return await unlessAborted(signal, tessera, async () => {
        const model = await tessera.open(this.name, bytes, { progress: (share) => progress(0.2 * share) });
        return model.measure({ progress: (share) => progress(0.2 + 0.8 * share) });
      });
    } finally {
      tessera.dispose();
    }
  }

  close() { this.#tessera.dispose(); }
}
