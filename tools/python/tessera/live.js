// The source of meshes of a live view: Tessera itself, as WebAssembly, which makes a mesh for each camera.
const often = 40;  // ms; a plan that takes longer waits until the camera rests
const rest = 150;  // ms

async function unpacked(text) {
  const stream = new Blob([bytes(text)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Imports the package, whose modules name each other as tessera/....
async function imported(scripts) {
  const imports = {};
  for (const [path, text] of Object.entries(scripts))
    imports["tessera/" + path] = "data:text/javascript;charset=utf-8," + encodeURIComponent(text);
  const map = document.createElement("script");
  map.type = "importmap";
  map.textContent = JSON.stringify({ imports });
  document.head.append(map);
  return import("tessera/index.js");
}

// The colour of each vertex, or null if no surface has one.
function coloursOf(model, patches, mesh) {
  const usual = [92, 140, 191, 255], surfaces = patches.surfaces, ofSurface = new Map();
  let isColoured = false;
  for (const surface of new Set(surfaces)) {
    const { colour } = model.surface(surface);
    isColoured = isColoured || colour !== null;
    ofSurface.set(surface, colour ? colour.map(part => Math.round(255 * part)) : usual);
  }
  if (!isColoured) return () => null;
  const ofPatch = Uint8Array.from(Array.from(surfaces, surface => ofSurface.get(surface)).flat());
  return ({ vertexCount, triangles, trianglePatches }) => {
    const colours = new Uint8Array(4 * vertexCount);
    for (let k = 0; k < triangles.length; ++k) {
      const from = 4 * trianglePatches[k / 3 | 0], to = 4 * triangles[k];
      for (let part = 0; part < 4; ++part) colours[to + part] = ofPatch[from + part];
    }
    return colours;
  };
}

function boxOf(positions) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let k = 0; k < positions.length; ++k) {
    low[k % 3] = Math.min(low[k % 3], positions[k]);
    high[k % 3] = Math.max(high[k % 3], positions[k]);
  }
  const middle = low.map((least, axis) => (least + high[axis]) / 2);
  return { middle, size: Math.hypot(...low.map((least, axis) => high[axis] - least)) || 1 };
}

function tessellated(model, title) {
  const patches = model.patches();
  let plan = patches.plan({ tolerance: 0.01, relative: true }), mesh = plan.write();
  const { middle, size } = boxOf(mesh.positions), half = size / 2, colours = coloursOf(model, patches);
  const placed = point => point.map((part, axis) => patches.origin[axis] + middle[axis] + half * part);
  let isForView = false, last = "", cost = 0, timer = null, isAtRest = false;
  const remake = view => {
    if (isForView) return plan.update(mesh, { view });
    const coarse = plan;
    plan = patches.plan({ pixels: 0.5, view });
    coarse.dispose();
    plan.write(mesh);
    isForView = true;
  };
  const source = {
    scale: [1 / half, 1 / half, 1 / half], offset: middle.map(part => -part / half), folded: false,
    mesh: () => ({
      positions: mesh.positions, normals: mesh.normals, faces: mesh.triangles, colours: colours(mesh),
    }),
    follow(camera) {
      const said = JSON.stringify(camera);
      if (said === last) return false;
      if (cost > often && !isAtRest) {
        clearTimeout(timer);
        timer = setTimeout(() => { isAtRest = true; source.redraw(); }, rest);
        return false;
      }
      isAtRest = false;
      last = said;
      const begin = performance.now();
      const view = { ...camera, eye: placed(camera.eye), target: placed(camera.target), nearDistance: 0.05 * half };
      try {
        remake(view);
      } catch (error) {
        isForView = false;  // the mesh may be none now
        caption.textContent = `${title}: ${error.message}`;
        return false;
      }
      cost = performance.now() - begin;
      caption.textContent = `${title}; ${mesh.triangleCount.toLocaleString("en")} triangles, within ` +
        `${plan.pixels.toFixed(2)} pixels`;
      return true;
    },
  };
  return source;
}

async function live({ scripts, module, name, format, file, join, title }) {
  const { init } = await imported(JSON.parse(new TextDecoder().decode(await unpacked(scripts))));
  const tessera = await init(await unpacked(module));
  let model = await tessera.open(name, await unpacked(file), format ? { format } : {});
  for (const distance of join) model = model.join(distance);
  return tessellated(model, title);
}

live(data).then(showInSight, error => { caption.textContent += `: ${error.message}`; });
