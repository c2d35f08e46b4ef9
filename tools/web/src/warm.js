// The graphics card's programs, made before there is a model: the first picture does not wait for them.
import {
  BufferAttribute, BufferGeometry, DirectionalLight, HemisphereLight, Mesh, Points, Scene,
} from 'three';
import { ModelObject } from 'tessera/three';

const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

/** The lights of every picture: `lamp` goes with the camera. */
export function lights() {
  const lamp = new DirectionalLight(0xffffff, 1.7), sky = new HemisphereLight(0xffffff, 0x8f979f, 1.9);
  lamp.position.set(-0.5, 0.7, 1);
  sky.position.set(0, 0, 1);
  return { lamp, sky };
}

/**
 * Draws a triangle of no size by each material, one after the other, for as long as `isIdle()`. Returns the scene, which
 * keeps the programs alive.
 */
export async function warm(renderer, camera, { surfaces, points }, isIdle) {
  const geometry = new BufferGeometry(), { lamp, sky } = lights();
  for (const [name, size] of [['position', 3], ['normal', 3], ['uv', 2]])
    geometry.setAttribute(name, new BufferAttribute(new Float32Array(9), size));
  geometry.setAttribute('color', new BufferAttribute(new Uint16Array(12), 4, true));
  const places = new BufferGeometry().setAttribute('position', geometry.getAttribute('position'));
  const { mesh, lines } = ModelObject.drawables(geometry, places), scene = new Scene();
  const drawn = [mesh, lines, ...surfaces.map((each) => new Mesh(geometry, each)), new Points(places, points)];
  scene.add(lamp, lamp.target, sky, ...drawn);
  for (const each of drawn) Object.assign(each, { frustumCulled: false, visible: false });
  await pause(50);
  if (renderer.extensions.has('KHR_parallel_shader_compile')) await renderer.compileAsync(scene, camera);
  else renderer.compile(scene, camera);
  for (const each of drawn) {
    await pause(40);
    if (!isIdle()) break;
    each.visible = true;
    renderer.render(scene, camera);
    each.visible = false;
  }
  return scene;
}
