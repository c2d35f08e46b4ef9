import type { Numbers, Run } from './common.js';
import { Handle } from './common.js';
import type { Mesh } from './mesh.js';
import type { Patches } from './patches.js';

/** A camera, whose picture a plan in pixels is for. */
export interface View {
  eye?: Numbers;
  target?: Numbers;
  up?: Numbers;
  /** Radians, across the shorter side; by default 40 degrees. */
  fieldOfView?: number;
  /** Above 0: parallel rays, and the length that the shorter side shows. */
  extent?: number;
  /** By default a thousandth of the target's distance. */
  nearDistance?: number;
  /** The size of the picture in pixels; 1280 x 800 by default. */
  width?: number;
  height?: number;
}

export interface PlanOptions extends Run {
  /** The largest distance between surfaces and mesh, a length. */
  tolerance?: number;
  /** The tolerance is a share of the set's size. */
  relative?: boolean;
  /** Tolerances for each surface, instead of `tolerance`. */
  surfaceTolerances?: Numbers;
  /** The largest turn of the normals in a triangle, radians, to pi/2. */
  angle?: number;
  /** The largest distance in the picture of `view`. */
  pixels?: number;
  view?: View;
  /** Segments of every patch, 1 to 4096, along both or along u and v; they prove nothing. */
  rates?: number | [number, number];
  /** Patches share the vertices of their borders, and the mesh has no normals. */
  shareVertices?: boolean;
  /** Look for fewer triangles, at a hundred times the time. */
  fewest?: boolean;
  /** The smallest tolerance for which maxTriangles suffice. */
  smallest?: boolean;
  /** Faces of shapes do not share vertices along edges. */
  apart?: boolean;
  /** Prepared for {@link Mesh.edges}; not with `apart`. */
  edges?: boolean;
  /** u and v of vertices: of the surface (default), as shares of its domain, or of the patch. */
  parameters?: 'surface' | 'unit' | 'patch';
  /** The largest distance of borders that are joined; by default as suits. */
  weld?: number;
  /** The largest angle of normals that are joined, radians; by default none are. */
  creaseAngle?: number;
  /** Edges with faces farther apart stay open; by default none. */
  maxGap?: number;
  /** Cells that an edited patch may have too many, as a share; by default 0.25. */
  spare?: number;
  /** By default 2^30. */
  maxTriangles?: number;
  /** The part of the tolerances that is left for updates, 0 (default) to 0.9. */
  headroom?: number;
}

export interface WriteOptions extends Run {
  /** Whether a new mesh has room for parameters; by default true. */
  parameters?: boolean;
}
export interface UpdateOptions extends Run {
  /** Patches whose control points change, and these: as {@link Patches.edit}. */
  patches?: Numbers;
  points?: Numbers;
  /** The view to follow, for plans in pixels. */
  view?: View;
}

/** How patches are divided into triangles, so that a tolerance is proven. Its counts are those of the mesh, exactly. */
export class Plan extends Handle {
  private constructor();
  readonly patches: Patches;
  readonly vertices: number;
  readonly triangles: number;
  /** The distance that was asked for, as a length. */
  readonly tolerance: number;
  /** The distance that is proven; infinite with rates. */
  readonly bound: number;
  /** With pixels: the bound of the patches that the view sees. */
  readonly seenBound: number;
  /** How far faces fail to meet at edges: points lie within bound + gap. */
  readonly gap: number;
  /** Proven, 0 if not wanted. */
  readonly angle: number;
  /** Proven, 0 if not wanted. */
  readonly pixels: number;
  readonly isCertified: boolean;
  readonly hasNormals: boolean;
  readonly hasParameters: boolean;
  readonly hasEdges: boolean;
  /** Edges of one triangle. */
  readonly openEdges: number;
  /** Patches that are left out, since their loops are no polygon. */
  readonly crossedPatches: number;
  /**
   * Writes the mesh.
   * @param into a mesh of the same patches that an earlier call returned, whose memory is used again where it suffices;
   *   after an error its content is undefined
   * @throws `out_of_memory`, `cancelled`
   */
  write(into?: Mesh | null, options?: WriteOptions): Mesh;
  /**
   * Follows edits and the view, and moves the mesh that write() returned last.
   * @returns whether the mesh has other triangles now
   */
  update(mesh: Mesh, options?: UpdateOptions): boolean;
}
