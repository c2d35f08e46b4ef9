// A model in a scene of three.js, whose triangles follow the camera.
import {
  BufferAttribute, Color, DoubleSide, Group, LineBasicMaterial, LineSegments, Mesh, MeshStandardMaterial,
} from 'three';
import { colourByCurvature, curvatureKinds, curvatureRange, curvaturesOf } from './curvature.js';
import { arraysOf, colourBySurface, edgeGeometryOf, geometryOf, paletteOf, surfacesOf } from './geometry.js';
import { viewOf } from './view.js';

const known = ['pixels', 'colours', 'edges', 'plain', 'highlight', 'plan'];

/**
 * Lets a material draw a thousandth of the distance nearer, so that lines lie before the faces that they bound. Polygons'
 * offsets will not do: they grow with the slope, which rounding makes large in slivers, and lines behind would show.
 */
export function drawnNearer(material) {
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace('#include <project_vertex>', `#include <project_vertex>
      if (isOrthographic) gl_Position.z -= 1e-3;
      else gl_Position = projectionMatrix * vec4(0.999 * mvPosition.xyz, 1.0);`);
  };
  return material;
}

export class ModelObject extends Group {
  #plan = null;
  #mesh = null;
  #arrays = null;
  #surfaces = null;  // { ofTriangles, ofVertices } of #arrays
  #patchSurfaces;
  #domains;
  #palette;
  #waiting = null;  // the view that is planned next
  #running = null;
  #isDisposed = false;

  /** Takes a model and its patches, from the package or from its worker. */
  static async make(model, patches, options = {}) {
    for (const name of Object.keys(options))
      if (!known.includes(name))
        throw new Error(`ModelObject: there is no option ${name}; there are ${known.join(', ')}`);
    const [faces, patchSurfaces, origin] = await Promise.all([model.surfaces(), patches.surfaces, patches.origin]);
    return new ModelObject(patches, { faces, patchSurfaces, origin, ...options });
  }

  /** Makes what draws triangles and edges, with the materials of all objects: to compile their programs early. */
  static drawables(triangles, edges) {
    const mesh = new Mesh(triangles, new MeshStandardMaterial({
      vertexColors: true, side: DoubleSide, roughness: 0.55, metalness: 0.05,
    }));
    return { mesh, lines: new LineSegments(edges, drawnNearer(new LineBasicMaterial({ color: 0x1a1f24 }))) };
  }

  constructor(patches, { faces, patchSurfaces, origin, pixels = 0.5, colours = 'surface', edges = true,
    plain = '#b8c0c8', highlight = '#ff9f2e', plan = {} }) {
    super();
    Object.assign(this, { patches, faces, pixels, colours, shown: null, curvatureRanges: {} });
    this.planOptions = { edges, ...plan };
    this.#patchSurfaces = patchSurfaces.slice();
    this.#domains = new Float64Array(faces.flatMap((face) => Array.from(face.domain)));
    this.#palette = paletteOf(faces, plain);
    this.hidden = new Uint8Array(faces.length);
    this.selected = new Uint8Array(faces.length);
    this.highlight = new Color(highlight);
    Object.assign(this, ModelObject.drawables());
    this.mesh.material.transparent = faces.some(({ colour }) => colour?.[3] < 1);
    for (const each of [this.mesh, this.lines]) {
      each.position.set(...origin);
      each.frustumCulled = false;
      this.add(each);
    }
  }

  /** Whether the triangles are those planned for exactly this picture. */
  isProvenFor(camera, width, height) {
    return this.shown !== null && this.shown.key === JSON.stringify(viewOf(camera, width, height, this));
  }

  /**
   * Plans the triangles for what a camera shows, and takes them. Resolves to true once they are shown, to false if a
   * later call came before its turn: one plan is made at a time, and always for the newest view.
   */
  update(camera, width, height) {
    const view = viewOf(camera, width, height, this), key = JSON.stringify(view);
    if (!this.#running && this.shown?.key === key) return Promise.resolve(true);
    return new Promise((resolve, reject) => {
      this.#waiting?.resolve(false);
      this.#waiting = { view, key, resolve, reject };
      this.#running ??= this.#run();
    });
  }
  /** Plans anew at the next update(): after edits of the patches, or another `pixels`. */
  async invalidate() {
    while (this.#running) await this.#running;
    this.#plan?.dispose();
    this.#plan = this.shown = null;
  }

  async #run() {
    while (this.#waiting && !this.#isDisposed) {
      const { view, key, resolve, reject } = this.#waiting;
      this.#waiting = null;
      try {
        await this.#follow(view, key);
        resolve(!this.#isDisposed);
      } catch (error) {
        this.#plan?.dispose();  // which may be without its mesh now
        this.#plan = null;
        reject(error);
      }
    }
    this.#waiting?.resolve(false);
    this.#running = null;
    if (this.#isDisposed) this.#release();
  }
  async #follow(view, key) {
    const start = performance.now();
    if (this.#plan) {
      await this.#plan.update(this.#mesh, { view });
    } else {
      this.#plan = await this.patches.plan({ pixels: this.pixels, view, parameters: 'surface', ...this.planOptions });
      this.#mesh = await this.#plan.write(this.#mesh);
    }
    const arrays = await arraysOf(this.#mesh), numbers = numbersOf(this.#plan);
    const milliseconds = performance.now() - start;
    const surfaces = surfacesOf(arrays, this.#patchSurfaces);
    let curvatures, kind;
    do {  // another kind may be chosen meanwhile
      kind = this.colours;
      curvatures = await this.#curvatures(arrays, surfaces);
    } while (kind !== this.colours && !this.#isDisposed);
    if (this.#isDisposed) return;
    this.#arrays = arrays;
    this.#surfaces = surfaces;
    this.#take(curvatures);
    this.shown = { ...numbers, milliseconds, view, key };
  }

  async #curvatures(arrays, { ofVertices }) {
    const kind = this.colours;
    if (!curvatureKinds[kind]) return null;
    const values = await curvaturesOf(this.patches, kind,
      { parameters: arrays.parameters, surfaces: ofVertices, domains: this.#domains });
    this.curvatureRanges[kind] ??= curvatureRange(values, arrays);
    return { kind, values };
  }
  #take(curvatures) {
    const geometry = geometryOf(this.#arrays, { ...this.#surfaces, palette: this.#palette, hidden: this.hidden });
    const lines = edgeGeometryOf(geometry, this.#arrays, { ...this.#surfaces, hidden: this.hidden });
    if (curvatures) {
      const { kind, values } = curvatures;
      geometry.setAttribute('curvature', Object.assign(new BufferAttribute(values, 1), { kind }));
    }
    for (const [object, its] of [[this.mesh, geometry], [this.lines, lines]]) {
      object.geometry.dispose();
      object.geometry = its;
    }
    this.#colour();
  }
  #colour() {
    const { geometry } = this.mesh, colours = geometry.getAttribute('color'), { array } = colours;
    const curvature = geometry.getAttribute('curvature'), { ofVertices } = this.#surfaces;
    const kind = curvature && curvature.kind;
    if (kind) colourByCurvature(array, curvature.array, kind, this.curvatureRanges[kind]);
    else colourBySurface(array, ofVertices, this.#palette);
    const mark = this.highlight.toArray().map((value) => 65535 * value), share = kind ? 0.25 : 0.85;
    if (this.selected.includes(1))
      for (let k = 0; k < ofVertices.length; ++k)
        if (this.selected[ofVertices[k]])
          for (let c = 0; c < 3; ++c) array[4 * k + c] += share * (mark[c] - array[4 * k + c]);
    colours.needsUpdate = true;
  }

  /** Colours the surfaces by their own colours ('surface') or by a curvature ('mean', 'gaussian' or 'maximum'). */
  async colourBy(colours) {
    if (colours !== 'surface' && !curvatureKinds[colours])
      throw new Error(`${colours} is no colouring; there are surface, ${Object.keys(curvatureKinds).join(', ')}`);
    this.colours = colours;
    const arrays = this.#arrays, surfaces = this.#surfaces;
    if (!arrays) return;
    const curvatures = await this.#curvatures(arrays, surfaces);
    if (arrays === this.#arrays && colours === this.colours && !this.#isDisposed) this.#take(curvatures);
  }
  /** Marks these surfaces, and no others, by the colour `highlight`. */
  select(surfaces) {
    this.selected.fill(0);
    for (const surface of surfaces) this.selected[surface] = 1;
    if (this.#arrays) this.#colour();
  }
  /** Hides surfaces, or shows them again. */
  hide(surfaces, isHidden = true) {
    for (const surface of surfaces) this.hidden[surface] = isHidden ? 1 : 0;
    if (!this.#arrays) return;
    const curvature = this.mesh.geometry.getAttribute('curvature');
    this.#take(curvature && { kind: curvature.kind, values: curvature.array });
  }
  /** The surface of a triangle, as an intersection of three's Raycaster names it by faceIndex. */
  surfaceOf(faceIndex) { return this.mesh.geometry.userData.surfaces?.[faceIndex] ?? null; }

  /** The box { low, high } of the triangles of surfaces, in the model's coordinates; null where they have none. */
  boxOf(surfaces) {
    if (!this.#arrays) return null;
    const { positions } = this.#arrays, { ofVertices } = this.#surfaces, wanted = new Set(surfaces);
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let k = 0; k < ofVertices.length; ++k) {
      if (!wanted.has(ofVertices[k])) continue;
      for (let c = 0; c < 3; ++c) {
        low[c] = Math.min(low[c], positions[3 * k + c]);
        high[c] = Math.max(high[c], positions[3 * k + c]);
      }
    }
    if (low[0] > high[0]) return null;
    const place = this.mesh.position.toArray();
    return { low: low.map((value, c) => value + place[c]), high: high.map((value, c) => value + place[c]) };
  }

  /** Lets go of geometries, materials, plan and mesh; the patches stay. */
  dispose() {
    this.#isDisposed = true;
    for (const each of [this.mesh, this.lines]) {
      each.geometry.dispose();
      each.material.dispose();
    }
    if (!this.#running) this.#release();
  }
  #release() {
    this.#plan?.dispose();
    this.#mesh?.dispose();
    this.#plan = this.#mesh = null;
  }
}

const planNumbers = [
  'triangles', 'vertices', 'pixels', 'bound', 'seenBound', 'gap', 'openEdges', 'crossedPatches', 'isCertified',
];
function numbersOf(plan) { return Object.fromEntries(planNumbers.map((name) => [name, plan[name]])); }
