import type {
  BufferGeometry, Camera, Color, ColorRepresentation, Group, LineBasicMaterial, LineSegments, Material,
  Mesh as ThreeMesh, MeshStandardMaterial, Object3D,
} from 'three';

import type { SurfaceInfo } from '../index.js';

type Now<T> = T | Promise<T>;

/** All that is known of a surface. */
export type Face = SurfaceInfo;
/** A view as plan({ view }) takes it. */
export interface View {
  eye: number[]; target: number[]; up: number[]; width: number; height: number;
  fieldOfView?: number; extent?: number; nearDistance?: number;
}

/** The objects of the package or of its worker: members may be promises. */
export interface AnyModel {
  surfaces(): Now<Face[]>;
}
export interface AnyMesh {
  copy(): Now<Arrays>;
}
export interface AnyPatches {
  readonly surfaces: Now<Uint32Array>; readonly origin: Now<number[]>;
  plan(options: object): Now<object>;
  evaluate(surfaces: Uint32Array, u: Float64Array, v: Float64Array, names: any[]): Now<Record<string, Float64Array>>;
}

/** The view of a camera in the coordinates of `object`. Errors: a camera off its axis, a transform of uneven scale. */
export function viewOf(camera: Camera, width: number, height: number, object?: Object3D | null): View;

export type CurvatureKind = 'mean' | 'gaussian' | 'maximum';
export const curvatureKinds: Record<CurvatureKind, { quantities: string[]; isSigned: boolean }>;
/** Colours in CSS, from -range (from 0 where the kind has no sign) to range. */
export function curvatureStops(kind: CurvatureKind): string[];
/** A curvature for each vertex, of the surfaces, or beside poles; NaN where there is none. `domains`: four a surface. */
export function curvaturesOf(patches: AnyPatches, kind: CurvatureKind,
  at: { parameters: Float32Array; surfaces: Uint32Array; domains: Float64Array }): Promise<Float32Array>;
/** The range that holds the values of 95 of 100 parts of the curved area; 1 where nothing is curved. */
export function curvatureRange(values: Float32Array, mesh: Pick<Arrays, 'positions' | 'triangles'>): number;
/** Writes four numbers, 0 to 65535, for each value. */
export function colourByCurvature(colours: Uint16Array, values: Float32Array, kind: CurvatureKind, range: number): void;

export interface Arrays {
  positions: Float32Array; normals: Float32Array | null; parameters: Float32Array | null;
  triangles: Uint32Array; trianglePatches: Uint32Array; edges: Uint32Array | null;
}
export interface Surfaces { ofTriangles: Uint32Array; ofVertices: Uint32Array }
/** The arrays of a mesh, as copies that stay. */
export function arraysOf(mesh: AnyMesh): Promise<Arrays>;
/** The surface of each triangle and vertex. */
export function surfacesOf(arrays: Arrays, patchSurfaces: Uint32Array): Surfaces;
/** Four linear numbers, 0 to 65535, for each surface; `plain`: of those without a colour. */
export function paletteOf(faces: Face[], plain: ColorRepresentation): Uint16Array;
/** The colours that surfaces have, each once, and the place of each surface among them. */
export function coloursOf(faces: Face[], plain?: ColorRepresentation): { colours: Color[]; ofSurfaces: Uint32Array };
/**
 * A geometry with positions relative to the mesh's origin, normals, parameters as `uv`, and userData.surfaces: the
 * surface of each triangle. `palette` adds colours of vertices, `materials` groups, `hidden` leaves surfaces out.
 */
export function geometryOf(arrays: Arrays, options: Surfaces & {
  palette?: Uint16Array; hidden?: Uint8Array; materials?: Uint32Array;
}): BufferGeometry;
/** Edges of shapes for LineSegments, over the positions of `geometry`; `plan({ edges: true })` prepares them. */
export function edgeGeometryOf(geometry: BufferGeometry, arrays: Arrays,
  options?: { ofVertices?: Uint32Array; hidden?: Uint8Array }): BufferGeometry;

export interface Shown {
  triangles: number; vertices: number; pixels: number; bound: number; seenBound: number; gap: number;
  openEdges: number; crossedPatches: number; isCertified: boolean;
  /** How long plan and mesh took, worker and copies included. */
  milliseconds: number;
  view: View; key: string;
}
export interface ModelOptions {
  /** The largest distance in the picture; 0.5. */
  pixels?: number;
  colours?: 'surface' | CurvatureKind;
  /** Whether edges of shapes are drawn; true. */
  edges?: boolean;
  /** The colour of surfaces that have none. */
  plain?: ColorRepresentation;
  highlight?: ColorRepresentation;
  /** Further options of plan(). */
  plan?: object;
}
/** Lets a material of lines draw a thousandth of the distance nearer, so that they lie before the faces they bound. */
export function drawnNearer<T extends Material>(material: T): T;
/** A model in a scene, whose triangles follow the camera. */
export class ModelObject extends Group {
  static make(model: AnyModel, patches: AnyPatches, options?: ModelOptions): Promise<ModelObject>;
  private constructor();
  readonly mesh: ThreeMesh<BufferGeometry, MeshStandardMaterial>;
  readonly lines: LineSegments<BufferGeometry, LineBasicMaterial>;
  readonly faces: Face[];
  /** 1 for each surface that hide() has hidden. */
  readonly hidden: Uint8Array;
  /** 1 for each surface that select() has marked. */
  readonly selected: Uint8Array;
  readonly highlight: Color;
  pixels: number;
  colours: 'surface' | CurvatureKind;
  /** The range of colours of each kind of curvature, taken from the first mesh; set it to choose another. */
  curvatureRanges: Partial<Record<CurvatureKind, number>>;
  /** The mesh that is shown; null before the first update(). */
  shown: Shown | null;
  isProvenFor(camera: Camera, width: number, height: number): boolean;
  /**
   * Plans the triangles for what a camera shows, in pixels of the device. Resolves to true once they are shown, to
   * false if a later call came before its turn. With objects of the worker the page is not blocked meanwhile.
   */
  update(camera: Camera, width: number, height: number): Promise<boolean>;
  /** Plans anew at the next update(): after edits of the patches, or another `pixels`. */
  invalidate(): Promise<void>;
  colourBy(colours: 'surface' | CurvatureKind): Promise<void>;
  select(surfaces: Iterable<number>): void;
  hide(surfaces: Iterable<number>, isHidden?: boolean): void;
  surfaceOf(faceIndex: number): number | null;
  boxOf(surfaces: Iterable<number>): { low: number[]; high: number[] } | null;
  dispose(): void;
}
