// The picture: a scene of three.js, a camera that orbits, and pictures that are drawn when their triangles are proven.
import {
  BufferAttribute, BufferGeometry, CanvasTexture, DoubleSide, Mesh, MeshBasicMaterial, PerspectiveCamera, Points,
  PointsMaterial, Scene, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { drawnNearer } from 'tessera/three';
import { lights, warm } from './warm.js';

const fieldOfView = 30, patience = 80;  // degrees; milliseconds that a picture waits for its proof
const isCalm = () => matchMedia('(prefers-reduced-motion: reduce)').matches;

/** A round dot with a white rim, over everything. */
function dotMaterial() {
  const picture = Object.assign(document.createElement('canvas'), { width: 32, height: 32 });
  const pen = picture.getContext('2d');
  for (const [radius, colour] of [[15, '#ffffff'], [10, '#d9480f']]) {
    pen.fillStyle = colour;
    pen.beginPath();
    pen.arc(16, 16, radius, 0, 2 * Math.PI);
    pen.fill();
  }
  const map = new CanvasTexture(picture);
  return new PointsMaterial({ size: 13, sizeAttenuation: false, depthTest: false, map, transparent: true });
}

export class Viewer {
  #canvas;
  #renderer;
  #scene = new Scene();
  #camera = new PerspectiveCamera(fieldOfView, 1, 0.01, 100);
  #controls;
  #eye = new PerspectiveCamera();  // the camera of the last picture, with a lamp
  #wire = new Mesh(undefined,
    drawnNearer(new MeshBasicMaterial({ wireframe: true, transparent: true, opacity: 0.55 })));
  #flat = new MeshBasicMaterial({ side: DoubleSide });
  #dot = new Points(new BufferGeometry(), dotMaterial());
  #object = null;
  #shaded = null;  // the object's own material
  #box = { low: [-1, -1, -1], high: [1, 1, 1] };
  #centre = new Vector3();
  #radius = 1;
  #mode = 'edges';
  #motion = null;
  #frame = 0;
  #drawn = 0;  // when
  #flight = null;
  #failed = null;
  #kept = null;  // what keeps programs alive

  /** `onPicture({ isProven })` is called for each picture, `onError(error)` if a plan fails. */
  constructor(canvas, { onPicture, onError }) {
    Object.assign(this, { onPicture, onError });
    this.#canvas = canvas;
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.#renderer.setClearAlpha(0);
    this.#camera.up.set(0, 0, 1);
    const { lamp, sky } = lights();
    this.#eye.add(lamp, lamp.target);
    this.#scene.add(this.#eye, sky, this.#wire, this.#dot);
    this.#dot.geometry.setAttribute('position', new BufferAttribute(new Float32Array(3), 3));
    for (const each of [this.#wire, this.#dot]) {
      each.frustumCulled = false;
      each.visible = false;
    }
    this.#dot.renderOrder = 2;
    this.#controls = new OrbitControls(this.#camera, canvas);
    Object.assign(this.#controls,
      { enableDamping: !isCalm(), dampingFactor: 0.2, zoomToCursor: true, rotateSpeed: 0.9 });
    this.#controls.addEventListener('change', () => this.redraw());
    canvas.addEventListener('webglcontextrestored', () => this.redraw());
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
    const materials = { surfaces: [this.#wire.material, this.#flat], points: this.#dot.material };
    this.#kept = warm(this.#renderer, new PerspectiveCamera(), materials, () => this.#object === null);
  }
  get object() { return this.#object; }
  get mode() { return this.#mode; }
  get size() {
    const { width, height } = this.#canvas;
    return { width, height };
  }

  /** Shows an object with its box, in place of the former, which is disposed; resolves once it is drawn. */
  async show(object, { low, high }) {
    this.clear();
    this.#resize();
    this.#object = object;
    this.#shaded = object.mesh.material;
    this.#scene.add(object);
    this.#box = { low, high };
    this.#centre.set(...low.map((value, k) => (value + high[k]) / 2));
    this.#radius = Math.hypot(...low.map((value, k) => high[k] - value)) / 2 || 1;
    this.#dress();
    this.look([0.62, -1, 0.62], false);
    this.#clip();
    const camera = this.#camera.clone();
    const { width, height } = this.size;
    await object.update(camera, width, height);
    if (this.#object === object) this.#draw(camera, true);
  }
  clear() {
    if (!this.#object) return;
    this.#scene.remove(this.#object);
    this.#object.mesh.material = this.#shaded;
    this.#object.dispose();
    this.#object = this.#failed = null;
    this.mark(null);
    this.#wire.visible = false;
  }

  /** Turns to a direction from the centre, at the distance that shows all; `box`: of what is fitted. */
  look(direction, isSmooth = true, box = null) {
    const { low, high } = box ?? this.#box;
    const centre = new Vector3(...low).add(new Vector3(...high)).multiplyScalar(0.5);
    const back = direction ? new Vector3(...direction) : this.#camera.position.clone().sub(this.#controls.target);
    back.normalize();
    const right = new Vector3().crossVectors(this.#camera.up, back).normalize();
    const up = new Vector3().crossVectors(back, right);
    const half = Math.tan(fieldOfView * Math.PI / 360), corner = new Vector3();
    let distance = this.#radius * 2e-3;
    for (let k = 0; k < 8; ++k) {
      corner.set(...[0, 1, 2].map((c) => (k >> c & 1 ? high : low)[c])).sub(centre).multiplyScalar(1.08);
      const across = Math.abs(corner.dot(right)) / this.#camera.aspect, above = Math.abs(corner.dot(up));
      distance = Math.max(distance, corner.dot(back) + Math.max(across, above) / half);
    }
    this.#move(centre.clone().addScaledVector(back, distance), centre, isSmooth && !isCalm());
  }
  #move(position, target, isSmooth) {
    const controls = this.#controls, camera = this.#camera;
    const start = performance.now(), from = { position: camera.position.clone(), target: controls.target.clone() };
    const motion = (this.#motion = {});  // a later one ends it
    const step = () => {
      if (motion !== this.#motion) return;
      const share = isSmooth ? Math.min((performance.now() - start) / 260, 1) : 1, eased = share * (2 - share);
      camera.position.lerpVectors(from.position, position, eased);
      controls.target.lerpVectors(from.target, target, eased);
      controls.minDistance = this.#radius * 1e-3;
      controls.maxDistance = this.#radius * 60;
      controls.update();
      this.redraw();
      if (share < 1) requestAnimationFrame(step);
    };
    step();
  }
  /** Turns by angles in radians, moves by shares of the picture, zooms by a factor. */
  turn(across, up) {
    const arm = this.#camera.position.clone().sub(this.#controls.target), length = arm.length();
    const longitude = Math.atan2(arm.y, arm.x) + across;
    const latitude = Math.min(Math.max(Math.asin(arm.z / length) + up, -1.5707), 1.5707);
    arm.set(Math.cos(latitude) * Math.cos(longitude), Math.cos(latitude) * Math.sin(longitude), Math.sin(latitude));
    this.#camera.position.copy(this.#controls.target).addScaledVector(arm, length);
    this.#controls.update();
    this.redraw();
  }
  pan(right, up) {
    const camera = this.#camera, length = camera.position.distanceTo(this.#controls.target);
    const shift = new Vector3(right, up, 0).multiplyScalar(length).transformDirection(camera.matrixWorld)
      .multiplyScalar(length * Math.hypot(right, up));
    camera.position.add(shift);
    this.#controls.target.add(shift);
    this.#controls.update();
    this.redraw();
  }
  zoom(factor) {
    const arm = this.#camera.position.clone().sub(this.#controls.target);
    this.#camera.position.copy(this.#controls.target).addScaledVector(arm, factor);
    this.#controls.update();
    this.redraw();
  }

  /** The ray through a place of the picture, from 0 to 1 rightwards and downwards. */
  ray(x, y) {
    const camera = this.#camera, p = camera.projectionMatrix.elements;
    camera.updateMatrixWorld();
    const direction = new Vector3((2 * x - 1) / p[0], (1 - 2 * y) / p[5], -1).transformDirection(camera.matrixWorld);
    return { origin: camera.position.toArray(), direction: direction.toArray() };
  }
  /** Puts a dot at a point of the model; null: nowhere. */
  mark(point) {
    this.#dot.visible = point !== null;
    if (point) this.#dot.position.set(...point);
    this.redraw();
  }

  setMode(mode) {
    this.#mode = mode;
    this.#dress();
    this.redraw();
  }
  /** Takes the colours of the page. */
  setColours({ ground, line, wire }) {
    this.#flat.color.set(ground);
    this.#wire.material.color.set(wire);
    this.lineColour = line;
    this.#dress();
    this.redraw();
  }
  #dress() {
    const object = this.#object, isWire = this.#mode === 'wireframe';
    if (!object) return;
    object.mesh.material = isWire ? this.#flat : this.#shaded;
    object.lines.visible = this.#mode === 'edges' || this.#mode === 'curvature';
    object.lines.material.color.set(this.lineColour);
    this.#wire.visible = isWire;
  }

  #resize() {
    const { width, height } = this.size, ratio = Math.min(devicePixelRatio, 2);
    const { clientWidth, clientHeight } = this.#canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    if (width === Math.floor(clientWidth * ratio) && height === Math.floor(clientHeight * ratio)) return;
    this.#renderer.setPixelRatio(ratio);
    this.#renderer.setSize(clientWidth, clientHeight, false);
    this.#camera.aspect = clientWidth / clientHeight;
    this.#camera.updateProjectionMatrix();
    // The picture is empty now: what is there is drawn at once.
    this.#drawn = 0;
    this.redraw();
  }
  redraw() { this.#frame ||= requestAnimationFrame(() => this.#onFrame()); }

  // Near and far follow the box, so that depths keep their digits.
  #clip() {
    const camera = this.#camera, distance = camera.position.distanceTo(this.#centre), reach = 1.05 * this.#radius;
    camera.near = Math.max(distance - reach, this.#radius * 1e-3);
    camera.far = Math.max(distance + reach, 2 * camera.near);
    camera.updateProjectionMatrix();
  }
  #onFrame() {
    this.#frame = 0;
    if (this.#controls.update()) this.redraw();
    const object = this.#object;
    if (!object) return this.#renderer.clear();
    if (!object.shown) return undefined;
    this.#clip();
    const camera = this.#camera, { width, height } = this.size;
    if (object.isProvenFor(camera, width, height) && !this.#flight) return this.#draw(camera, true);
    this.#follow(object, camera.clone(), width, height);
    if (performance.now() - this.#drawn > patience) this.#draw(camera, false);
  }
  // A picture is drawn from where its triangles are proven, a frame or so later.
  async #follow(object, camera, width, height) {
    const flight = (this.#flight = {});
    try {
      const isProven = await object.update(camera, width, height);
      if (isProven && this.#object === object) this.#draw(camera, true);
    } catch (error) {
      if (this.#object === object && this.#failed !== error.message) this.onError(error);
      this.#failed = error.message;
    } finally {
      if (this.#flight === flight) this.#flight = null;
    }
  }
  #draw(camera, isProven) {
    const object = this.#object;
    this.#eye.copy(camera, false);
    if (this.#wire.visible) {
      this.#wire.geometry = object.mesh.geometry;
      this.#wire.position.copy(object.mesh.position);
    }
    this.#renderer.render(this.#scene, this.#eye);
    this.#drawn = performance.now();
    this.onPicture({ isProven });
  }
}
