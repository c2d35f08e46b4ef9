// Meshes in the module's memory.
import { stringOf } from './arguments.js';
import { describe, disposed } from './handle.js';
import { its } from './internal.js';
import { fileOf } from './model.js';

// The arrays of a mesh: the member of tsr_mesh, numbers of a record, and whether records are vertices.
const arrays = {
  positions: ['position.data', 3, true], normals: ['normal.data', 3, true], parameters: ['parameter.data', 2, true],
  triangles: ['triangles', 3, false], trianglePatches: ['triangle_patches', 1, false],
};
const reportNames = ['vertices', 'distinct_positions', 'triangles', 'open_edges', 'non_manifold_edges',
  'inconsistent_edges', 't_junctions', 'flipped_triangles', 'degenerate_triangles', 'non_finite_vertices'];

export class Mesh {
  #struct;
  #set;  // a reference to the patches, which save() needs
  #blocks = {};
  #room = { vertices: 0, triangles: 0 };
  #edges = null;
  #keepsParameters;

  constructor(patches, keepsParameters) {
    const module = patches[its.module], set = patches[its.handle];
    Object.defineProperties(this, { patches: { value: patches }, [its.module]: { value: module } });
    this[its.plan] = null;  // the plan that wrote it
    this.origin = patches.origin;
    this.#keepsParameters = keepsParameters;
    this.#struct = module.struct('tsr_mesh');
    try {
      module.call('tsr_retain', set);
    } catch (error) {
      module.free(this.#struct.at);
      throw error;
    }
    this.#set = set;
    this.#empty();
  }

  get [its.struct]() {
    if (!this.#struct) throw disposed(this);
    return this.#struct.at;
  }

  /** Makes room for the mesh of a plan; what it holds already is kept where it suffices. */
  [its.resize]({ vertices, triangles, hasNormals, hasParameters }) {
    const module = this[its.module], at = this[its.struct];
    if (vertices > this.#room.vertices || triangles > this.#room.triangles) this.#allocate(vertices, triangles);
    hasParameters &&= this.#keepsParameters;
    Object.assign(this, { vertexCount: vertices, triangleCount: triangles, hasNormals, hasParameters });
    this.#edges = null;
    const set = (member, value) => module.set({ at, name: 'tsr_mesh' }, member, value);
    for (const [name, [member, , isOfVertices]] of Object.entries(arrays)) {
      const isWanted = name === 'normals' ? hasNormals : name !== 'parameters' || hasParameters;
      set(member, isWanted ? this.#blocks[name] : 0);
      if (isOfVertices) set(member.replace('data', 'count'), isWanted ? vertices : 0);
    }
    set('triangle_count', triangles);
  }
  #allocate(vertices, triangles) {
    // A quarter more, so that a mesh that follows a view is not allocated anew each time.
    for (const factor of [1.25, 1]) {
      const room = { vertices: Math.ceil(factor * vertices), triangles: Math.ceil(factor * triangles) };
      try {
        this.#empty();
        for (const [name, [, components, isOfVertices]] of Object.entries(arrays)) {
          if (name === 'parameters' && !this.#keepsParameters) continue;
          const records = isOfVertices ? room.vertices : room.triangles;
          this.#blocks[name] = this[its.module].allocate(4 * components * records);
        }
        this.#room = room;
        return;
      } catch (error) {
        this.#empty();
        if (factor === 1 || error.code !== 'out_of_memory') throw error;
      }
    }
  }
  #empty() {
    const blocks = Object.values(this.#blocks);
    this[its.module].free(...blocks);
    this.#blocks = {};
    this.#room = { vertices: 0, triangles: 0 };
    this.#edges = null;
    Object.assign(this, { vertexCount: 0, triangleCount: 0, hasNormals: false, hasParameters: false });
  }

  #array(name, Type, isThere = true) {
    void this[its.struct];  // an error where the mesh was disposed
    if (!isThere) return null;
    const [, components, isOfVertices] = arrays[name];
    const length = components * (isOfVertices ? this.vertexCount : this.triangleCount);
    return new Type(this[its.module].exports.memory.buffer, this.#blocks[name] ?? 0, length);
  }
  get positions() { return this.#array('positions', Float32Array); }
  get normals() { return this.#array('normals', Float32Array, this.hasNormals); }
  get parameters() { return this.#array('parameters', Float32Array, this.hasParameters); }
  get triangles() { return this.#array('triangles', Uint32Array); }
  get trianglePatches() { return this.#array('trianglePatches', Uint32Array); }
  get edges() {
    void this[its.struct];
    return this.#edges?.slice() ?? null;
  }
  copy() {
    const lists = Object.fromEntries(Object.keys(arrays).map((name) => [name, this[name]?.slice() ?? null]));
    return { ...lists, edges: this.edges, origin: [...this.origin] };
  }

  [its.takeEdges](plan) {
    const module = this[its.module], handle = plan[its.handle];
    this.#edges = module.scratch(({ keep }) => {
      const count = keep(module.allocate(4));
      module.call('tsr_plan_edges', handle, 0, 0, count);
      const lines = module.view.getUint32(count, true), at = keep(module.allocate(8 * lines));
      module.call('tsr_plan_edges', handle, at, lines, count);
      return new Uint32Array(module.exports.memory.buffer, at, 2 * lines).slice();
    });
  }

  check() { return describe(this[its.module], 'tsr_mesh_check', 'tsr_mesh_report', reportNames, this[its.struct]); }
  save(format) {
    const module = this[its.module], struct = this[its.struct], name = `mesh.${stringOf('format', format)}`;
    return module.scratch(({ text }) => fileOf(module, 'tsr_mesh_bytes', struct, this.#set, text(name)));
  }
  get isDisposed() { return this.#struct === null; }
  dispose() {
    if (!this.#struct) return;
    const module = this[its.module];
    this.#empty();
    module.free(this.#struct.at);
    module.release(this.#set);
    this.#struct = null;
  }
}
if (Symbol.dispose) Mesh.prototype[Symbol.dispose] = Mesh.prototype.dispose;
