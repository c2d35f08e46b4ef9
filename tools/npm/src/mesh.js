// Meshes in the module's memory.
import { TesseraError, invalid } from './errors.js';
import { describe } from './handle.js';
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
  #blocks = {};
  #room = { vertices: 0, triangles: 0 };
  #edges = null;

  constructor(patches, hasParameters) {
    const { module } = patches;
    Object.defineProperties(this, { patches: { value: patches }, module: { value: module } });
    this.hasParameters = hasParameters;
    this.#struct = module.struct('tsr_mesh');
    this.vertexCount = this.triangleCount = 0;
  }

  get struct() {
    if (!this.#struct) throw new TesseraError('invalid_handle', 'the Mesh was disposed');
    return this.#struct.at;
  }
  get origin() { return this.patches.origin; }

  /** Makes room for the mesh of a plan; what it holds already is kept where it suffices. */
  resize({ vertices, triangles, hasNormals }) {
    const { module, struct } = this;
    const isShort = vertices > this.#room.vertices || triangles > this.#room.triangles;
    if (isShort) this.#allocate(vertices, triangles);
    this.hasNormals = hasNormals;
    Object.assign(this, { vertexCount: vertices, triangleCount: triangles });
    const set = (member, value) => module.set({ at: struct, name: 'tsr_mesh' }, member, value);
    for (const [name, [member, , isOfVertices]] of Object.entries(arrays)) {
      const isWanted = name === 'normals' ? hasNormals : name !== 'parameters' || this.hasParameters;
      set(member, isWanted ? this.#blocks[name] : 0);
      if (isOfVertices) set(member.replace('data', 'count'), isWanted ? vertices : 0);
    }
    set('triangle_count', triangles);
  }
  #allocate(vertices, triangles) {
    const { module } = this;
    this.#free();
    // A quarter more, so that a mesh that follows a view is not allocated anew each time.
    const room = { vertices: Math.ceil(1.25 * vertices), triangles: Math.ceil(1.25 * triangles) };
    for (const [name, [, components, isOfVertices]] of Object.entries(arrays))
      if (name !== 'parameters' || this.hasParameters)
        this.#blocks[name] = module.allocate(4 * components * (isOfVertices ? room.vertices : room.triangles));
    this.#room = room;
  }
  #free() {
    this.module.free(...Object.values(this.#blocks));
    this.#blocks = {};
    this.#room = { vertices: 0, triangles: 0 };
  }

  #array(name, Type) {
    const [, components, isOfVertices] = arrays[name];
    if (!this.#struct) throw new TesseraError('invalid_handle', 'the Mesh was disposed');
    const length = components * (isOfVertices ? this.vertexCount : this.triangleCount);
    return new Type(this.module.exports.memory.buffer, this.#blocks[name] ?? 0, length);
  }
  get positions() { return this.#array('positions', Float32Array); }
  get normals() { return this.hasNormals ? this.#array('normals', Float32Array) : null; }
  get parameters() { return this.hasParameters ? this.#array('parameters', Float32Array) : null; }
  get triangles() { return this.#array('triangles', Uint32Array); }
  get trianglePatches() { return this.#array('trianglePatches', Uint32Array); }
  /** The edges of shapes as pairs of vertices; null unless the plan was made with `edges`. */
  get edges() { return this.#edges; }

  takeEdges(plan) {
    const { module } = this;
    this.#edges = plan.hasEdges && module.scratch(({ keep }) => {
      const count = keep(module.allocate(4));
      module.call('tsr_plan_edges', plan.handle, 0, 0, count);
      const lines = module.view.getUint32(count, true), at = keep(module.allocate(8 * lines));
      module.call('tsr_plan_edges', plan.handle, at, lines, count);
      return new Uint32Array(module.exports.memory.buffer, at, 2 * lines).slice();
    }) || null;
  }

  check() { return describe(this.module, 'tsr_mesh_check', 'tsr_mesh_report', reportNames, this.struct); }
  /** The bytes of a file: 'glb', 'obj', 'ply', 'stl' or 'gltf'. */
  save(format) {
    if (typeof format !== 'string') throw invalid('save: expected a format, such as glb');
    return this.module.scratch(({ text }) =>
      fileOf(this.module, 'tsr_mesh_bytes', this.struct, this.patches.handle, text(`mesh.${format}`)));
  }
  get isDisposed() { return this.#struct === null; }
  dispose() {
    if (!this.#struct) return;
    this.#free();
    this.module.free(this.#struct.at);
    this.#struct = null;
  }
}
if (Symbol.dispose) Mesh.prototype[Symbol.dispose] = Mesh.prototype.dispose;
