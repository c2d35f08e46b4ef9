/**
 * Tessera in a worker: the interface of `tessera`, where each method and each list is a promise, so that a page never
 * stalls. Plain numbers, such as `mesh.triangleCount`, are values as they were after the latest call.
 *
 * - **Order**: calls on one instance run one after the other, as they were made. Arguments are copied when a call is
 *   made, results are copies.
 * - **Cancelling**: an aborted `signal`, or a `progress` that returns false, ends a call with `cancelled`. A call that
 *   waits is left out. A call that runs sees it within milliseconds to a second, where the page may have shared memory
 *   (it is cross-origin isolated; Node). Elsewhere the worker is ended: its objects are disposed ones then, the use of
 *   which is `invalid_handle`, and the next call starts a worker anew.
 * - **Errors** are those of `tessera`: rejections by a {@link TesseraError} of the same code, sentence and index.
 * - **Memory**: objects live in the worker until `dispose()`, all of them until `terminate()`.
 */
import type * as core from '../index.js';

export { TesseraError, compile } from '../index.js';

/** A result as it is sent: objects stay in the worker, and others stand for them. */
type Result<R> = [R] extends [core.Model] ? Model : [R] extends [core.Patches] ? Patches
  : [R] extends [core.Plan] ? Plan : [R] extends [core.Mesh] ? Mesh : [R] extends [core.Scene] ? Scene : R;
type Arguments<A> = { [K in keyof A]: A[K] extends core.Mesh ? Mesh : A[K] extends core.Mesh | null | undefined
  ? Mesh | Exclude<A[K], core.Mesh> : A[K] };
type Method<F> = F extends (...values: infer A) => infer R
  ? (...values: Arguments<A>) => Promise<Result<Awaited<R>>> : never;
/** The members of a class: values stay values, lists and methods become promises. */
type Remote<T, Lists extends keyof T = never, Generic extends keyof T = never> = {
  readonly [K in Exclude<keyof T, 'dispose' | 'isDisposed' | Generic>]:
    T[K] extends (...values: never[]) => unknown ? Method<T[K]> : K extends Lists ? Promise<T[K]> : Result<T[K]>;
} & Disposed;
interface Disposed {
  readonly isDisposed: boolean;
  /** Frees the object in the worker, after the calls that were made before. Never rejects. */
  dispose(): Promise<void>;
}

export interface Model extends Remote<core.Model, 'warnings'> {}
export interface Patches extends Remote<core.Patches, 'surfaces', 'evaluate'> {
  evaluate<Q extends core.PointQuantity = 'position' | 'normal'>(surface: number | core.Numbers,
    u: number | core.Numbers, v: number | core.Numbers, names?: readonly Q[]): Promise<Record<Q, Float64Array>>;
}
export interface Plan extends Remote<core.Plan> {}
export interface Mesh extends Remote<core.Mesh, 'positions' | 'normals' | 'parameters' | 'triangles' |
  'trianglePatches' | 'edges'> {}
export interface Scene extends Remote<core.Scene, 'info', 'closest'> {
  closest<Q extends core.HitQuantity = 'kind' | 'flags' | 'surface' | 'patch' | 't' | 'uv' | 'position' | 'normal'>(
    origins: core.Numbers, directions: core.Numbers, options?: core.RayOptions & { quantities?: readonly Q[] },
  ): Promise<Pick<core.Hits, Q>>;
}
export interface Tessera extends Remote<core.Tessera, 'memoryBytes'> {
  /**
   * Ends the worker and all its objects. The call that runs is rejected with `cancelled`, those that wait with
   * `invalid_handle`.
   */
  terminate(): void;
}
interface Class<T> { new (...values: never[]): T; readonly prototype: T }
export const Model: Class<Model>, Patches: Class<Patches>, Plan: Class<Plan>, Mesh: Class<Mesh>, Scene: Class<Scene>;
export const Tessera: Class<Tessera>;

/**
 * Starts a worker with an instance of its own.
 * @param source the module: as `init()` of `tessera` takes it
 * @param options `shared`: whether calls that run are cancelled through shared memory, where the host has it; by
 *   default true
 */
export function init(source?: core.Source, options?: { shared?: boolean }): Promise<Tessera>;
