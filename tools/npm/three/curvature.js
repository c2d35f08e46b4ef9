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
 */
export async function curvaturesOf(patches, kind, { parameters, surfaces, domains }) {
  const rule = curvatureKinds[kind];
  if (!rule) throw new Error(`${kind} is no curvature; there are ${Object.keys(curvatureKinds).join(', ')}`);
  const count = surfaces.length, u = new Float64Array(count), v = new Float64Array(count);
  for (let k = 0; k < count; ++k) {
    const at = 4 * surfaces[k];
    u[k] = Math.min(Math.max(parameters[2 * k], domains[at]), domains[at + 1]);
    v[k] = Math.min(Math.max(parameters[2 * k + 1], domains[at + 2]), domains[at + 3]);
  }
  if (count === 0) return new Float32Array(0);
  const found = await patches.evaluate(surfaces, u, v, rule.quantities);
  const [first, second] = rule.quantities.map((name) => found[name]), values = new Float32Array(count);
  for (let k = 0; k < count; ++k) values[k] = rule.of(first[k], second?.[k]);
  return values;
}

/** The range that 95 of 100 values stay within; 1 where all are 0. */
export function curvatureRange(values) {
  const step = Math.max(1, Math.floor(values.length / 20000)), sizes = [];
  for (let k = 0; k < values.length; k += step) {
    const size = Math.abs(values[k]);
    if (Number.isFinite(size) && size > 1e-12) sizes.push(size);
  }
  if (sizes.length === 0) return 1;
  return sizes.sort((a, b) => a - b)[Math.floor(0.95 * (sizes.length - 1))];
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
