import type { Numbers, Vector } from './common.js';
import { Handle } from './common.js';
import type { Model } from './model.js';
import type { Plan, PlanOptions } from './plan.js';
import type { Scene, SceneOptions } from './rays.js';

/** A Bezier patch. */
export interface PatchInfo {
  degreeU: number;
  degreeV: number;
  surface: number;
  /** Its rectangle of the surface's parameters: u0, u1, v0, v1. */
  domain: [number, number, number, number];
  /** Whether trimming loops cut it. */
  isCut: boolean;
  /** Shape `[degreeU + 1][degreeV + 1][3]`. */
  points: Float64Array;
  /** Shape `[degreeU + 1][degreeV + 1]`; null: the patch is polynomial. */
  weights: Float64Array | null;
}

/** Quantities of points: vectors have three numbers, curvatures one; derivatives are by the surface's parameters. */
export type PointQuantity = 'position' | 'du' | 'dv' | 'duu' | 'duv' | 'dvv' | 'normal' | 'firstForm' | 'secondForm' |
  'gaussian' | 'mean' | 'firstCurvature' | 'secondCurvature' | 'firstDirection' | 'secondDirection';

/** Bezier patches of a model, packed for meshes, rays and points. */
export class Patches extends Handle {
  private constructor();
  readonly model: Model;
  readonly count: number;
  readonly surfaceCount: number;
  /** Patches that trimming loops cut. */
  readonly cutCount: number;
  readonly memoryBytes: number;
  /** Grows by one with each edit. */
  readonly revision: number;
  /** The box of all control points. */
  readonly box: { low: Vector; high: Vector };
  /** The point that positions of meshes are relative to. */
  readonly origin: Vector;
  /** How far patches lie from surfaces that have no exact ones; 0: all are exact. */
  readonly fitError: number;
  /** Surfaces whose loops could not be used; they are whole. */
  readonly unusedLoops: number;
  /** The surface of each patch. */
  get surfaces(): Uint32Array;
  /** @param index below count */
  patch(index: number): PatchInfo;
  /**
   * Sets all control points of some patches. Scenes are `stale` until {@link Scene.refit}, and the bounds of plans hold
   * again after {@link Plan.update}.
   * @param patches indices
   * @param points shape `[k][3]`: those of one patch after the other
   * @throws `count_mismatch`, `non_finite`; the patches before the one that `index` names are set
   */
  edit(patches: Numbers, points: Numbers): void;
  /** Divides the patches into triangles, by a tolerance or tolerances, an angle, pixels, `smallest`, or rates alone. */
  plan(options: PlanOptions): Plan;
  /** Prepares rays. */
  rays(options?: SceneOptions): Scene;
  /**
   * Evaluates points.
   * @param surface one for all points, or one each
   * @param u the surface's parameter, a number or one for each point
   * @param names quantities; by default position and normal
   * @returns a list for each quantity, of one or three numbers for each point
   */
  evaluate<Q extends PointQuantity = 'position' | 'normal'>(surface: number | Numbers, u: number | Numbers,
    v: number | Numbers, names?: readonly Q[]): Record<Q, Float64Array>;
}
