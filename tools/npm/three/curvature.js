// Curvatures at the vertices of a mesh, and their colours.
import { Color, SRGBColorSpace } from 'three';

/** Kinds of curvature: what is evaluated, the number of it, and whether it has a sign. */
export const curvatureKinds = {
  mean: { quantities: ['mean'], of: (k) => k, isSigned: true },
  gaussian: { quantities: ['gaussian'], of: (k) => k, isSigned: true },
  maximum: {
    quantities: ['firstCurvature', 'secondCurvature'], isSigned: false,
    of: (first, second) => Math.max(Math.abs(first), Math.abs(second)),
  },
};

const signed = ['#1d5fa8', '#7fb2dd', '#eceff1', '#f0a37f', '#b3261e'];
const unsigned = ['#eceff1', '#f3cf73', '#e48a2c', '#b3361e', '#5e0f2e'];
/** Colours of a kind in CSS, from -range (0 without sign) to range. */
export function curvatureStops(kind) { return curvatureKinds[kind].isSigned ? signed : unsigned; }

/**
 * Returns a curvature for each vertex, by the surfaces themselves; NaN where it is undefined. `parameters`: two numbers
 * each; `surfaces`: one each; `domains`: four for each surface, which numbers in float may leave by their rounding.
 * At a pole the curvature is that of a point near it.
 */
export async function curvaturesOf(patches, kind, { parameters, surfaces, domains }) {
  const rule = curvatureKinds[kind];
  if (!rule) throw new Error(`${kind} is no curvature; there are ${Object.keys(curvatureKinds).join(', ')}`);
  const values = new Float32Array(surfaces.length), all = Uint32Array.from(surfaces.keys());
  const evaluate = async (vertices, inwards) => {
    const at = samplesOf(vertices, { parameters, surfaces, domains }, inwards);
    const found = await patches.evaluate(at.surfaces, at.u, at.v, [...rule.quantities, 'firstForm']);
    const [first, second] = rule.quantities.map((name) => found[name]), { firstForm } = found;
    return vertices.filter((vertex, k) => {
      const [E, F, G] = firstForm.subarray(3 * k, 3 * k + 3);
      const isUndefined = !(E * G - F * F > 1e-18 * (E + G) ** 2);
      values[vertex] = isUndefined ? NaN : rule.of(first[k], second?.[k]);
      return isUndefined;
    });
  };
  const poles = all.length > 0 ? await evaluate(all, 0) : all;
  if (poles.length > 0) await evaluate(poles, 1e-3);
  return values;
}
/** The parameters of vertices, within the domains, and moved by a share of these towards their middle. */
function samplesOf(vertices, { parameters, surfaces, domains }, inwards) {
  const count = vertices.length;
  const at = { surfaces: new Uint32Array(count), u: new Float64Array(count), v: new Float64Array(count) };
  const moved = (value, low, high) => {
    const inside = Math.min(Math.max(value, low), high);
    return inside + inwards * ((low + high) / 2 - inside);
  };
  for (let k = 0; k < count; ++k) {
    const vertex = vertices[k], surface = surfaces[vertex], domain = 4 * surface;
    at.surfaces[k] = surface;
    at.u[k] = moved(parameters[2 * vertex], domains[domain], domains[domain + 1]);
    at.v[k] = moved(parameters[2 * vertex + 1], domains[domain + 2], domains[domain + 3]);
  }
  return at;
}

/**
 * The range that holds the values of 95 of 100 parts of the curved area; 1 where nothing is curved. Areas count, since
 * vertices lie close where surfaces are curved most.
 */
export function curvatureRange(values, { positions, triangles }) {
  const areas = areasOf(positions, triangles);
  const largest = values.reduce((most, value) => Math.max(most, Math.abs(value) || 0), 0);
  const isCurved = (k) => areas[k] > 0 && Math.abs(values[k]) > 1e-6 * largest && Number.isFinite(values[k]);
  const sorted = Uint32Array.from(values.keys()).filter(isCurved)
    .sort((a, b) => Math.abs(values[a]) - Math.abs(values[b]));
  const whole = sorted.reduce((sum, k) => sum + areas[k], 0);
  let sum = 0;
  for (const k of sorted) {
    sum += areas[k];
    if (sum >= 0.95 * whole) return Math.abs(values[k]);
  }
  return 1;
}
/** The area around each vertex: a third of its triangles'. */
function areasOf(positions, triangles) {
  const areas = new Float32Array(positions.length / 3);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const edge = (from, to, axis) => positions[to + axis] - positions[from + axis];
    const x = edge(a, b, 1) * edge(a, c, 2) - edge(a, b, 2) * edge(a, c, 1);
    const y = edge(a, b, 2) * edge(a, c, 0) - edge(a, b, 0) * edge(a, c, 2);
    const z = edge(a, b, 0) * edge(a, c, 1) - edge(a, b, 1) * edge(a, c, 0);
    for (let k = t; k < t + 3; ++k) areas[triangles[k]] += Math.hypot(x, y, z) / 6;
  }
  return areas;
}

/** Linear colours of a ramp of `steps` from stops in sRGB, 65535 at most. */
export function ramp(stops, steps = 256) {
  const table = new Uint16Array(3 * steps), colours = stops.map((each) => new Color().setStyle(each, SRGBColorSpace));
  const mixed = new Color();
  for (let k = 0; k < steps; ++k) {
    const at = k / (steps - 1) * (stops.length - 1), low = Math.min(Math.floor(at), stops.length - 2);
    mixed.lerpColors(colours[low], colours[low + 1], at - low).toArray().forEach((value, c) => {
      table[3 * k + c] = Math.round(65535 * value);
    });
  }
  return table;
}
const ramps = {};

/** Writes the colours of curvatures into `colours`, four numbers a vertex; grey where there is none. */
export function colourByCurvature(colours, values, kind, range) {
  const table = (ramps[kind] ??= ramp(curvatureStops(kind))), { isSigned } = curvatureKinds[kind];
  for (let k = 0; k < values.length; ++k) {
    const share = isSigned ? 0.5 + 0.5 * values[k] / range : values[k] / range;
    const at = 3 * Math.round(255 * Math.min(Math.max(share, 0), 1));
    const isNumber = share === share;
    for (let c = 0; c < 3; ++c) colours[4 * k + c] = isNumber ? table[at + c] : 14000;
    colours[4 * k + 3] = 65535;
  }
}
