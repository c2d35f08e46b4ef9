import type { Vector } from './common.js';
import type { Patches } from './patches.js';

/** Faults of a mesh, counted. */
export interface MeshReport {
  vertices: number;
  distinctPositions: number;
  triangles: number;
  openEdges: number;
  nonManifoldEdges: number;
  inconsistentEdges: number;
  tJunctions: number;
  flippedTriangles: number;
  degenerateTriangles: number;
  nonFiniteVertices: number;
}

/** Lists of a mesh, apart from the module's memory. */
export interface MeshLists {
  positions: Float32Array;
  normals: Float32Array | null;
  parameters: Float32Array | null;
  triangles: Uint32Array;
  trianglePatches: Uint32Array;
  edges: Uint32Array | null;
  origin: Vector;
}

/**
 * A mesh in the module's memory.
 *
 * Its lists are views of that memory, made anew by each access. A view holds until the next call on the instance: the
 * call may make the memory grow, which leaves the view empty (length 0), or write other content to it. Use a view at
 * once, or take a {@link copy}.
 */
export class Mesh {
  private constructor();
  readonly patches: Patches;
  readonly vertexCount: number;
  readonly triangleCount: number;
  readonly hasNormals: boolean;
  readonly hasParameters: boolean;
  /** The point that positions are relative to: float has 24 bits, whatever the model's distance from 0. */
  readonly origin: Vector;
  /** Shape `[vertexCount][3]`, relative to origin. */
  get positions(): Float32Array;
  /** Shape `[vertexCount][3]`, unit; null: the plan shares vertices. */
  get normals(): Float32Array | null;
  /** Shape `[vertexCount][2]`, u and v; null: there are none. */
  get parameters(): Float32Array | null;
  /** Shape `[triangleCount][3]`: vertices, counter-clockwise. */
  get triangles(): Uint32Array;
  /** Shape `[triangleCount]`: the patch of each triangle. */
  get trianglePatches(): Uint32Array;
  /** Shape `[k][2]`: the edges of shapes as pairs of vertices, a copy; null: the plan was made without `edges`. */
  get edges(): Uint32Array | null;
  /** Copies all lists. */
  copy(): MeshLists;
  /** Counts the faults of the mesh. */
  check(): MeshReport;
  /** Returns a file of the mesh in the model's place: "glb", "gltf", "obj", "ply" or "stl". */
  save(format: string): Uint8Array;
  get isDisposed(): boolean;
  dispose(): void;
}
