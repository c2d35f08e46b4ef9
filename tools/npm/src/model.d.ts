import type { Colour, Numbers, Run, Vector } from './common.js';
import { Handle } from './common.js';
import type { Patches } from './patches.js';

/** A spline surface; a Bezier patch without knots. */
export interface Spline {
  /** 1 to 15. */
  degreeU: number;
  degreeV: number;
  /** Control points along u and v; by default degree + 1. */
  countU?: number;
  countV?: number;
  /** Shape `[countU][countV][3]`. */
  points: Numbers;
  /** Shape `[countU][countV]`, above 0; by default 1. */
  weights?: Numbers;
  /** Shape `[count + degree + 1]`, both or none. */
  knotsU?: Numbers;
  knotsV?: Numbers;
  name?: string;
}

export interface SetOptions extends Run {
  /** The faces of one shape, in its own space; by default all surfaces at their places. */
  shape?: number;
  /** Trimming loops do not count. */
  whole?: boolean;
  /** Coefficients in double, for grids. */
  double?: boolean;
  /** Prepared for {@link Patches.evaluate}, which packs the set at its first call otherwise. */
  points?: boolean;
  /** How far patches may lie from surfaces that have no exact ones, a length; by default 1e-6 of the size. */
  fitTolerance?: number;
}

export interface MeasureOptions extends Run {
  /** The errors that are aimed at, as a share. */
  accuracy?: number;
  /** Whether bodies are measured; by default true. */
  bodies?: boolean;
}
/** A body that the faces of a shape enclose. Errors are proven where `isProven`, else estimates. */
export interface Body {
  instance: number;
  shape: number;
  solid: number;
  volume: number;
  volumeError: number;
  centroid: Vector;
  centroidError: number;
  /** About the centroid, for density 1: Ixx, Iyy, Izz, Ixy, Ixz, Iyz. */
  inertia: number[];
  inertiaError: number;
  /** How far faces fail to meet. */
  gap: number;
  isProven: boolean;
}
export interface Measures {
  area: number;
  areaError: number;
  centroid: Vector;
  centroidError: number;
  isProven: boolean;
  box: { low: Vector; high: Vector; lowError: Vector; highError: Vector; isProven: boolean };
  bodies: Body[];
}

/** A surface of a model. */
export interface SurfaceInfo {
  name: string | null;
  /** "B-spline surface", ... */
  kind: string;
  /** u0, u1, v0, v1. */
  domain: [number, number, number, number];
  /** Trimming loops. */
  loops: number;
  /** The instance, the shape and its face that the surface is; null: the file has no shapes. */
  instance: number | null;
  shape: number | null;
  face: number | null;
  colour: Colour | null;
}
/** A shape at its place. Its faces are the surfaces from `firstSurface` on. */
export interface InstanceInfo {
  name: string | null;
  shape: number;
  firstSurface: number;
  /** Three columns, then the translation. */
  placement: number[];
  colour: Colour | null;
}

/** The surfaces of a file, with names, places and colours. */
export class Model extends Handle {
  private constructor();
  readonly surfaceCount: number;
  readonly shapeCount: number;
  readonly instanceCount: number;
  /** Surfaces with trimming loops. */
  readonly trimmedCount: number;
  readonly warningCount: number;
  /** The unit of lengths, "mm"; "": the file states none. */
  readonly unit: string;
  /** The parts of the file that are skipped, one sentence each. */
  get warnings(): string[];
  /** @param index below surfaceCount; `invalid_argument` otherwise */
  surface(index: number): SurfaceInfo;
  /** @param index below shapeCount */
  shape(index: number): { name: string };
  /** @param index below instanceCount */
  instance(index: number): InstanceInfo;
  /** All surfaces, shapes and instances in their order, by one call each. */
  surfaces(): SurfaceInfo[];
  shapes(): { name: string }[];
  instances(): InstanceInfo[];
  /**
   * Makes a model whose faces share edges where these run side by side.
   * @param distance a length; 0 (default): one that suits the faces
   */
  join(distance?: number): Model;
  /** Packs the surfaces as Bezier patches. Errors: those of surfaces; `index` is the surface. */
  patches(options?: SetOptions): Patches;
  /** Measures area, box and bodies, each with a bound of its error. */
  measure(options?: MeasureOptions): Measures;
  /** Returns a file of the surfaces: "json", "obj" or "bpt". */
  save(format: string): Uint8Array;
}
