// The members that all objects have in common.

/** A list of numbers. */
export type Numbers = ArrayLike<number> & (readonly number[] | Float64Array | Float32Array | Uint32Array | Int32Array |
  Uint16Array | Int16Array | Uint8Array | Int8Array | Uint8ClampedArray);
/** Bytes of a file; a string stands for its UTF-8. */
export type Bytes = ArrayBufferView | ArrayBuffer | SharedArrayBuffer | string;
export type Vector = [number, number, number];
/** sRGB and opacity, 0 to 1. */
export type Colour = [number, number, number, number];

/** The kind of an error: a value outside its range, a file that does not follow its format, memory that is full, ... */
export type ErrorCode = 'invalid_argument' | 'non_finite' | 'invalid_weight' | 'unsupported_degree' | 'count_mismatch' |
  'buffer_too_small' | 'unsupported' | 'isa_unavailable' | 'stale' | 'parse_error' | 'io_error' | 'out_of_memory' |
  'cancelled' | 'internal' | 'invalid_handle' | 'in_use';

/**
 * An error of the library. `message` says what was found and what was wanted, and where: "part.step: ...".
 *
 * `out_of_memory`: a model or a mesh that is too large for 2 GB; the instance stays usable. `invalid_handle`: an object
 * that was disposed. `in_use`: `progress()` used the instance that calls it. `internal`: a fault of the library; if the
 * module trapped, every later call on the instance throws it, and a new {@link init} is needed.
 */
export class TesseraError extends Error {
  constructor(code: ErrorCode, message: string, index?: number);
  readonly name: 'TesseraError';
  readonly code: ErrorCode;
  /** The element that the sentence names, such as a surface or an entry of a list; -1: none. */
  readonly index: number;
}

/** Options of every long call. */
export interface Run {
  /**
   * Called with the share done, 0 to 1, rising. If it returns false the call ends with `cancelled`, and if it throws,
   * the call ends and throws that. It must not use the instance, which is busy. Reading reports STEP files alone.
   */
  progress?: (share: number) => boolean | void;
  /**
   * Ends the call with `cancelled` once it is aborted. No event reaches a thread that computes: in `tessera` itself a
   * signal counts that is aborted before the call or by `progress()`, in `tessera/worker` any.
   */
  signal?: AbortSignal;
}

export class Handle {
  /** Whether {@link dispose} was called; the object's use is `invalid_handle` then, its plain numbers stay. */
  get isDisposed(): boolean;
  /** Frees what the object alone holds. Further calls do nothing. */
  dispose(): void;
}
