// Results of tessera.wasm for files, and those of the native program results.c.
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';

const relative = 1, warningText = 1;  // TSR_PLAN_RELATIVE, TSR_TEXT_WARNING
const rayCount = 200;
// Members of tsr_hits_out in the order of results.c, with the bytes of a ray.
const hitParts = [['t', 8], ['patch_uv', 16], ['patch', 4], ['kind', 1], ['flags', 1]];

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

/** Rays from points in and around the set's box to points in it, as aim() of results.c makes them. */
function raysOf(tessera, set) {
  const info = tessera.struct('tsr_set_info');
  tessera.call('tsr_set_describe', set, info.at);
  const box = (member) => Array.from(new Float32Array(new Float64Array(
    tessera.bytes(tessera.place(info, member).at, 24).slice().buffer)));
  const low = box('low'), high = box('high');
  tessera.free(info.at);
  let state = 1;
  const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
  const origin = new Float64Array(3 * rayCount), direction = new Float64Array(3 * rayCount);
  for (let k = 0; k < 3 * rayCount; ++k) {
    const size = high[k % 3] - low[k % 3], from = random(), to = random();
    origin[k] = low[k % 3] + size * (3 * from - 1);
    direction[k] = low[k % 3] + size * to - origin[k];
  }
  return { origin, direction };
}

/** The closest hits of these rays: an array of bytes for each of `hitParts`. */
function hitsOf(tessera, set) {
  const { origin, direction } = raysOf(tessera, set);
  const scene = tessera.make('tsr_scene_new', set, 0, 0);
  const rays = tessera.struct('tsr_rays'), out = tessera.struct('tsr_hits_out');
  const memory = [];
  const view = (struct, member, at) => {
    memory.push(at);
    tessera.set(struct, `${member}.data`, at);
    tessera.set(struct, `${member}.count`, rayCount);
    return at;
  };
  try {
    for (const struct of [rays, out]) tessera.set(struct, 'is_double', 1);
    view(rays, 'origin', tessera.copy(new Uint8Array(origin.buffer)));
    view(rays, 'direction', tessera.copy(new Uint8Array(direction.buffer)));
    const places = hitParts.map(([member, bytes]) => view(out, member, tessera.allocate(bytes * rayCount)));
    tessera.call('tsr_scene_closest', scene, rays.at, out.at, 0);
    return hitParts.map(([, bytes], k) => tessera.bytes(places[k], bytes * rayCount).slice());
  } finally {
    tessera.free(rays.at, out.at, ...memory);
    tessera.exports.tsr_release(scene);
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

/** Reads and meshes a file by the module: { code, message }, or { warnings, positions, normals, corners, glb, hits } */
export function resultOf(tessera, path, bytes = readFileSync(path)) {
  const content = tessera.copy(bytes), name = tessera.copy(new TextEncoder().encode(basename(path)));
  const handles = [];
  try {
    const model = tessera.make('tsr_model_read_bytes', content, bytes.length, name, 0, 0);
    handles.push(model);
    const set = tessera.make('tsr_set_new', model, 0, 0);
    handles.push(set);
    const mesh = meshOf(tessera, set);
    return { warnings: warningsOf(tessera, model), ...mesh, hits: hitsOf(tessera, set) };
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
    const [warnings, vertices, triangles, glb, rays] = words.slice(1).map(Number);
    return {
      warnings: take(warnings).toString(), positions: take(12 * vertices), normals: take(12 * vertices),
      corners: take(12 * triangles), glb: take(glb), hits: hitParts.map(([, bytes]) => take(bytes * rays)),
    };
  });
}

function floatsOf(bytes) {
  return new Float32Array(Uint8Array.from(bytes).buffer);
}
function doublesOf(bytes) {
  return new Float64Array(Uint8Array.from(bytes).buffer);
}

/** How far numbers are apart at most; NaN where there are more in one list. */
function distanceOf(found, wanted) {
  if (found.length !== wanted.length) return NaN;
  return found.reduce((most, x, k) => Math.max(most, Object.is(x, wanted[k]) ? 0 : Math.abs(x - wanted[k])), 0);
}

/**
 * Compares two results. `fault`: the first thing in which they differ that must be the same; null if there is none.
 * `isSame`: whether every byte of the mesh is; `hasSameHits`: whether every byte of the hits is. Normals, and t, u and
 * v of hits, may differ by 2^-40, and with normals the .glb, where control points have other last bits: glibc does not
 * round every sine and power correctly, and the long double that some surfaces are converted in has more bits here.
 */
export function comparison(found, wanted) {
  const faulty = (fault) => ({ fault, isSame: false, hasSameHits: false });
  for (const part of ['code', 'message', 'warnings'])
    if (found[part] !== wanted[part]) return faulty(`${part} is ${found[part]}, natively ${wanted[part]}`);
  if (found.code !== undefined) return { fault: null, isSame: true, hasSameHits: true };
  for (const part of ['positions', 'corners'])
    if (Buffer.compare(found[part], wanted[part]) !== 0) return faulty(`${part} have other bytes than natively`);
  const apart = distanceOf(floatsOf(found.normals), floatsOf(wanted.normals));
  if (!(apart <= 2 ** -40)) return faulty(`normals differ by ${apart}`);
  let hasSameHits = true;
  for (const [k, [part, bytes]] of hitParts.entries()) {
    if (Buffer.compare(found.hits[k], wanted.hits[k]) === 0) continue;
    hasSameHits = false;
    if (bytes < 8) return faulty(`${part} of hits has other bytes than natively`);
    const most = distanceOf(doublesOf(found.hits[k]), doublesOf(wanted.hits[k]));
    if (!(most <= 2 ** -40)) return faulty(`${part} of hits differs by ${most}`);
  }
  return { fault: null, isSame: apart === 0 && Buffer.compare(found.glb, wanted.glb) === 0, hasSameHits };
}
