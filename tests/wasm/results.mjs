// Results of tessera.wasm for files, and those of the native program results.c.
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';

const relative = 1, warningText = 1;  // TSR_PLAN_RELATIVE, TSR_TEXT_WARNING

function meshOf(tessera, set) {
  const options = tessera.struct('tsr_plan_options', 'tsr_plan_defaults');
  tessera.set(options, 'tolerance', 1e-3);
  tessera.set(options, 'flags', relative);
  const plan = tessera.make('tsr_plan_new', set, options.at, 0);
  const info = tessera.struct('tsr_plan_info'), mesh = tessera.struct('tsr_mesh');
  const memory = [];
  let file = 0;
  try {
    tessera.call('tsr_plan_describe', plan, info.at);
    const vertices = tessera.get(info, 'vertices'), triangles = tessera.get(info, 'triangles');
    const sizes = [12 * vertices, 12 * vertices, 12 * triangles];
    for (const size of sizes) memory.push(tessera.allocate(size));
    tessera.set(mesh, 'position.data', memory[0]);
    tessera.set(mesh, 'position.count', vertices);
    tessera.set(mesh, 'normal.data', memory[1]);
    tessera.set(mesh, 'normal.count', vertices);
    tessera.set(mesh, 'triangles', memory[2]);
    tessera.set(mesh, 'triangle_count', triangles);
    tessera.call('tsr_plan_write', plan, mesh.at, 0);
    const name = tessera.copy(new TextEncoder().encode('model.glb'));
    memory.push(name);
    file = tessera.make('tsr_mesh_bytes', mesh.at, set, name);
    const size = tessera.allocate(4);
    memory.push(size);
    const data = tessera.exports.tsr_bytes_data(file, size);
    const [positions, normals, corners] = sizes.map((bytes, k) => tessera.bytes(memory[k], bytes).slice());
    return { positions, normals, corners, glb: tessera.bytes(data, tessera.view.getUint32(size, true)).slice() };
  } finally {
    tessera.free(options.at, info.at, mesh.at, ...memory);
    if (file) tessera.exports.tsr_release(file);
    tessera.exports.tsr_release(plan);
  }
}

function warningsOf(tessera, model) {
  const info = tessera.struct('tsr_model_info');
  tessera.call('tsr_model_describe', model, info.at);
  const count = tessera.get(info, 'warnings');
  tessera.free(info.at);
  let text = '';
  for (let k = 0; k < count; ++k) text += tessera.text(tessera.exports.tsr_model_text(model, warningText, k)) + '\n';
  return text;
}

/** Reads and meshes a file by the module: { code, message }, or { warnings, positions, normals, corners, glb }. */
export function resultOf(tessera, path, bytes = readFileSync(path)) {
  const content = tessera.copy(bytes), name = tessera.copy(new TextEncoder().encode(basename(path)));
  const handles = [];
  try {
    const model = tessera.make('tsr_model_read_bytes', content, bytes.length, name, 0, 0);
    handles.push(model);
    const set = tessera.make('tsr_set_new', model, 0, 0);
    handles.push(set);
    const mesh = meshOf(tessera, set);
    return { warnings: warningsOf(tessera, model), ...mesh };
  } catch (error) {
    if (error.code === undefined) throw error;
    return { code: error.code, message: error.message };
  } finally {
    for (const handle of handles.reverse()) tessera.exports.tsr_release(handle);
    tessera.free(content, name);
  }
}

/** The same by the native program, with SSE2: a result per file. */
export function nativeResults(program, paths) {
  const ran = spawnSync(program, paths, { maxBuffer: 2 ** 31, env: { ...process.env, TESSERA_ISA: 'sse2' } });
  if (ran.error) throw ran.error;
  if (ran.status !== 0) throw new Error(`${program} ended with ${ran.status ?? ran.signal}: ${ran.stderr}`);
  const out = ran.stdout;
  let at = 0;
  const take = (bytes) => out.subarray(at, (at += bytes));
  return paths.map(() => {
    const line = out.indexOf(10, at), words = out.toString('utf8', at, line).split(' ');
    at = line + 1;
    if (words[0] === 'error') return { code: Number(words[1]), message: take(Number(words[2])).toString() };
    const [warnings, vertices, triangles, glb] = words.slice(1).map(Number);
    return {
      warnings: take(warnings).toString(), positions: take(12 * vertices), normals: take(12 * vertices),
      corners: take(12 * triangles), glb: take(glb),
    };
  });
}

function floatsOf(bytes) {
  return new Float32Array(Uint8Array.from(bytes).buffer);
}

/**
 * Compares two results. `fault`: the first thing in which they differ that must be the same; null if there is none.
 * `isSame`: whether every byte is. Normals may differ by 2^-40, and with them the .glb, because glibc does not round
 * every sine and power correctly: what differs are components of normals that are 0, and the last bit of an origin.
 */
export function comparison(found, wanted) {
  const faulty = (fault) => ({ fault, isSame: false });
  for (const part of ['code', 'message', 'warnings'])
    if (found[part] !== wanted[part]) return faulty(`${part} is ${found[part]}, natively ${wanted[part]}`);
  if (found.code !== undefined) return { fault: null, isSame: true };
  for (const part of ['positions', 'corners'])
    if (Buffer.compare(found[part], wanted[part]) !== 0) return faulty(`${part} have other bytes than natively`);
  const normals = floatsOf(found.normals), others = floatsOf(wanted.normals);
  if (normals.length !== others.length) return faulty('there are more or fewer normals than natively');
  const apart = normals.reduce((most, x, k) => Math.max(most, Object.is(x, others[k]) ? 0 : Math.abs(x - others[k])), 0);
  if (!(apart <= 2 ** -40)) return faulty(`normals differ by ${apart}`);
  return { fault: null, isSame: apart === 0 && Buffer.compare(found.glb, wanted.glb) === 0 };
}
