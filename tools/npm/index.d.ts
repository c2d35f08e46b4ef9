/**
 * Tessera: parametric surfaces and STEP files to meshes whose error is proven, and rays that meet the surfaces.
 *
 * - **Numbers** are in the file's unit of length ({@link Model.unit}) and in radians. A shape `[k][3]` stands for a
 *   flat list: three numbers for each k. Lists are typed arrays or arrays of numbers.
 * - **Errors** are exceptions of {@link TesseraError}, with the sentences of the library.
 * - **Memory**: objects live in the module's memory, at most 2 GB, until their `dispose()`. An object may be disposed
 *   while others that were made of it are in use: a mesh keeps its patches, patches keep their model.
 * - **Threads**: a call blocks its thread until it returns. `tessera/worker` has the same interface with promises.
 */
import type { Bytes, Run } from './src/common.js';
import type { Model, Spline } from './src/model.js';

export * from './src/mesh.js';
export * from './src/model.js';
export * from './src/patches.js';
export * from './src/plan.js';
export * from './src/rays.js';
export { TesseraError } from './src/common.js';
export type { Bytes, Colour, ErrorCode, Numbers, Run, Vector } from './src/common.js';

/** Where tessera.wasm is: its bytes, an address (a string is relative to the page), or compiled already. */
export type Source = string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module;

/**
 * Makes an instance, with memory of its own. Objects of one instance are errors in another.
 * @param source the module; by default the file tessera.wasm beside index.js
 * @throws `WebAssembly.CompileError` where the host lacks SIMD; `Error` where the module cannot be loaded
 */
export function init(source?: Source): Promise<Tessera>;
/** Compiles the module once, for several calls of {@link init}. */
export function compile(source?: Source): Promise<WebAssembly.Module>;

export interface ReadOptions extends Run {
  /** The extension that states the format, such as "step"; by default that of the name. */
  format?: string;
}

/** An instance of the module. */
export class Tessera {
  private constructor();
  /** The library's version, "1.2.3". */
  readonly version: string;
  /** Bytes of the module's memory, which grows to 2 GB at most and never shrinks. */
  get memoryBytes(): number;
  /**
   * Reads a file: .step, .stp, .p21, .json, .g2, .obj, .rib, .bpt, .bv.
   * @param name stands for the file in messages; its extension states the format
   * @param bytes are copied
   * @throws `parse_error`, `unsupported` (the format; packed files: see {@link open}), `out_of_memory`, `cancelled`,
   *   errors of surfaces
   */
  read(name: string, bytes: Bytes, options?: ReadOptions): Model;
  /** Reads a file that may be packed: .gz, .stpz, .zip of one file. Errors: as {@link read}. */
  open(name: string, bytes: Bytes, options?: ReadOptions): Promise<Model>;
  /** Makes a model of spline surfaces. Errors: those of splines; `index` is the surface. */
  bspline(splines: Spline[]): Model;
}
