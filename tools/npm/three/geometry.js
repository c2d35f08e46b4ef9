// Geometries of three.js from meshes of the package.
import { BufferAttribute, BufferGeometry, Color, SRGBColorSpace } from 'three';

/** The arrays of a mesh, of the package or of its worker, as copies that stay. */
export async function arraysOf(mesh) { return mesh.copy(); }

/** The surface of each triangle, and of each vertex. `patchSurfaces`: the surface of each patch. */
export function surfacesOf({ positions, triangles, trianglePatches }, patchSurfaces) {
  const ofTriangles = new Uint32Array(trianglePatches.length), ofVertices = new Uint32Array(positions.length / 3);
  for (let t = 0; t < ofTriangles.length; ++t) {
    const surface = patchSurfaces[trianglePatches[t]];
    ofTriangles[t] = surface;
    for (let k = 3 * t; k < 3 * t + 3; ++k) ofVertices[triangles[k]] = surface;
  }
  return { ofTriangles, ofVertices };
}

/** Linear colours of surfaces, four numbers each to 65535. `plain`: of those without a colour. */
export function paletteOf(faces, plain) {
  const palette = new Uint16Array(4 * faces.length), colour = new Color();
  faces.forEach(({ colour: its }, k) => {
    if (its) colour.setRGB(its[0], its[1], its[2], SRGBColorSpace);
    else colour.set(plain);
    palette.set([colour.r, colour.g, colour.b, its?.[3] ?? 1].map((value) => Math.round(65535 * value)), 4 * k);
  });
  return palette;
}

export function colourBySurface(colours, surfaces, palette) {
  for (let k = 0; k < surfaces.length; ++k)
    for (let c = 4 * k, from = 4 * surfaces[k]; c < 4 * k + 4; ++c, ++from) colours[c] = palette[from];
}

/**
 * Returns the triangles of surfaces that are not hidden, in the order of `places` if there are any, and their surfaces.
 * `counts`: how many triangles each place has.
 */
function ordered(triangles, surfaces, hidden, places) {
  const counts = [];
  const placeOf = (surface) => (hidden?.[surface] ? -1 : places?.[surface] ?? 0);
  for (const surface of surfaces) {
    const place = placeOf(surface);
    if (place >= 0) counts[place] = (counts[place] ?? 0) + 1;
  }
  const next = [];
  let total = 0;
  for (let place = 0; place < counts.length; ++place) {
    next[place] = total;
    total += counts[place] ?? 0;
  }
  const index = new Uint32Array(3 * total), kept = new Uint32Array(total);
  for (let t = 0; t < surfaces.length; ++t) {
    const place = placeOf(surfaces[t]);
    if (place < 0) continue;
    const to = next[place]++;
    kept[to] = surfaces[t];
    for (let k = 0; k < 3; ++k) index[3 * to + k] = triangles[3 * t + k];
  }
  return { index, kept, counts };
}

/**
 * Makes the geometry of a mesh's arrays: positions (relative to the mesh's origin), normals, parameters as `uv`,
 * colours of vertices if `palette` is given, and userData.surfaces, the surface of each triangle.
 * `hidden`: 1 for each surface whose triangles are left out. `materials`: the material of each surface, for groups.
 */
export function geometryOf(arrays, { ofTriangles, ofVertices, palette, hidden, materials }) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(arrays.positions, 3));
  if (arrays.parameters) geometry.setAttribute('uv', new BufferAttribute(arrays.parameters, 2));
  const isWhole = !materials && !hidden?.includes(1);
  const { index, kept, counts } = isWhole ? { index: arrays.triangles, kept: ofTriangles, counts: [] } :
    ordered(arrays.triangles, ofTriangles, hidden, materials);
  geometry.setIndex(new BufferAttribute(index, 1));
  geometry.userData.surfaces = kept;
  if (arrays.normals) geometry.setAttribute('normal', new BufferAttribute(arrays.normals, 3));
  else geometry.computeVertexNormals();
  if (palette) {
    const colours = new Uint16Array(4 * ofVertices.length);
    colourBySurface(colours, ofVertices, palette);
    geometry.setAttribute('color', new BufferAttribute(colours, 4, true));
  }
  if (materials) {
    let first = 0;
    for (let place = 0; place < counts.length; ++place) {
      if (counts[place]) geometry.addGroup(3 * first, 3 * counts[place], place);
      first += counts[place] ?? 0;
    }
  }
  return geometry;
}

/** The colours that surfaces have, each once, and the place of each surface among them: for a material each. */
export function coloursOf(faces, plain = '#b8c0c8') {
  const places = new Map(), colours = [], ofSurfaces = new Uint32Array(faces.length);
  faces.forEach(({ colour }, k) => {
    const key = colour ? colour.join() : 'plain';
    if (!places.has(key)) {
      places.set(key, colours.length);
      colours.push(colour ? new Color().setRGB(colour[0], colour[1], colour[2], SRGBColorSpace) : new Color(plain));
    }
    ofSurfaces[k] = places.get(key);
  });
  return { colours, ofSurfaces };
}

/** The edges of shapes, for LineSegments over the same positions; none if the plan was made without `edges`. */
export function edgeGeometryOf(geometry, arrays, { ofVertices, hidden } = {}) {
  const lines = new BufferGeometry(), edges = arrays.edges ?? new Uint32Array(0);
  lines.setAttribute('position', geometry.getAttribute('position'));
  const isWhole = !hidden?.includes(1);
  lines.setIndex(new BufferAttribute(isWhole ? edges : shownEdges(edges, ofVertices, hidden), 1));
  return lines;
}
function shownEdges(edges, ofVertices, hidden) {
  const shown = [];
  for (let k = 0; k < edges.length; k += 2)
    if (!hidden[ofVertices[edges[k]]]) shown.push(edges[k], edges[k + 1]);
  return new Uint32Array(shown);
}
