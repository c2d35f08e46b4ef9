import type { Numbers, Run, Vector } from './common.js';
import { Handle } from './common.js';
import type { Patches } from './patches.js';

export interface SceneOptions extends Run {
  /** How far a point may lie from the ray, a length; by default 2e-12 of the size. */
  tolerance?: number;
  /** Pieces of a patch in each direction: 1 (default), 2, 4 or 8. */
  pieces?: 1 | 2 | 4 | 8;
  /** Prepared for {@link Scene.refit}; rays take a fifth longer. */
  editable?: boolean;
}
export interface RayOptions extends Run {
  /** Distances along the ray, in lengths of the direction: one for all rays or one each; by default 0 and infinity. */
  near?: number | Numbers;
  far?: number | Numbers;
  /** How far from the origin surfaces do not count: {@link SceneInfo.spawnOffset} for rays that start on a surface. */
  spawnOffset?: number | Numbers;
}
/** Lists of hits, one record for each ray. A miss has t = Infinity, indices of 0xffffffff and 0 elsewhere. */
export interface Hits {
  /** 0: a miss, 1: a hit, 2: the ray is invalid. */
  kind: Uint8Array;
  /**
   * A sum: 2, the normal is a limit or 0; 4, uncertified: within the tolerance, but not proven the only root nearby; 8,
   * there may be other hits; 16, uncertified along the tangent plane; 32, uncertified, off the ray by more than
   * rounding; 64, the ray passes an edge within its gap.
   */
  flags: Uint8Array;
  surface: Uint32Array;
  patch: Uint32Array;
  /** The hit is origin + t * direction. */
  t: Float64Array;
  /** Shape `[k][2]`: the surface's parameters. */
  uv: Float64Array;
  /** Shape `[k][2]`: the patch's, 0 to 1. */
  patchUv: Float64Array;
  /** Shape `[k][3]`, in the model. */
  position: Float64Array;
  /** Shape `[k][3]`, unit, along du x dv. */
  normal: Float64Array;
  /** Shape `[k][3]`: derivatives by the surface's parameters. */
  du: Float64Array;
  dv: Float64Array;
  /** Distance from the ray. */
  residual: Float64Array;
}
export type HitQuantity = keyof Hits;
type UsualHits = 'kind' | 'flags' | 'surface' | 'patch' | 't' | 'uv' | 'position' | 'normal';

export interface SceneInfo {
  memoryBytes: number;
  /** The box of all that rays can meet. */
  low: Vector;
  high: Vector;
  spawnOffset: number;
}

/** Patches prepared for rays, which meet the surfaces themselves, within their trimming loops. */
export class Scene extends Handle {
  private constructor();
  readonly patches: Patches;
  get info(): SceneInfo;
  /** Follows edits of the patches. */
  refit(): void;
  /**
   * Finds the closest hit of each ray.
   * @param origins shape `[k][3]`, or one for all rays
   * @param directions shape `[k][3]`, of any length but 0
   */
  closest<Q extends HitQuantity = UsualHits>(origins: Numbers, directions: Numbers,
    options?: RayOptions & { quantities?: readonly Q[] }): Pick<Hits, Q>;
  /** Returns 1 for each ray that meets anything, else 0. */
  occluded(origins: Numbers, directions: Numbers, options?: RayOptions): Uint8Array;
}
