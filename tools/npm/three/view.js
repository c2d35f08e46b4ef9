// The view of a camera of three.js, as plan({ view }) takes it.
import { Matrix4, Vector3 } from 'three';

const local = new Matrix4(), inverse = new Matrix4();
const vectorAt = (matrix, column) => new Vector3().setFromMatrixColumn(matrix, column);

/** The factor by which a matrix scales all lengths; an error if there is none. */
function scaleOf(matrix) {
  const lengths = [0, 1, 2].map((column) => vectorAt(matrix, column).length());
  const [least, largest] = [Math.min(...lengths), Math.max(...lengths)];
  if (!(least > 0 && largest - least <= 1e-6 * largest))
    throw new Error(`the object must be scaled alike in all directions, found ${lengths.join(', ')}`);
  return largest;
}

/**
 * Returns the view of a camera whose picture has `width` x `height` pixels, in the coordinates of `object`. Where the
 * picture's pixels are no squares, the view has as many as its finer direction needs, so that a bound in pixels holds.
 * Errors: a perspective camera off its axis (setViewOffset), a transform that scales unevenly.
 */
export function viewOf(camera, width, height, object = null) {
  if (!(width >= 1 && height >= 1)) throw new Error(`the picture has ${width} x ${height} pixels, expected 1 or more`);
  camera.updateWorldMatrix(true, false);
  local.copy(camera.matrixWorld);
  if (object) {
    object.updateWorldMatrix(true, false);
    local.premultiply(inverse.copy(object.matrixWorld).invert());
  }
  const scale = scaleOf(local), p = camera.projectionMatrix.elements, isParallel = p[15] === 1;
  const across = vectorAt(local, 0), up = vectorAt(local, 1), ahead = vectorAt(local, 2).divideScalar(-scale);
  const eye = vectorAt(local, 3);
  // Pixels for a length of 1 at a distance of 1, and the sides of a picture of square pixels that shows all.
  const focus = Math.max(width * p[0], height * p[5]) / 2;
  const whole = (length) => Math.ceil(length * (1 - 1e-12));  // 1280 stays 1280 after its roundings
  const sides = { width: whole(2 * focus / p[0]), height: whole(2 * focus / p[5]) };
  const shorter = Math.min(sides.width, sides.height);
  const view = { up: up.toArray(), ...sides };
  if (isParallel) {
    eye.addScaledVector(across, -p[12] / p[0]).addScaledVector(up, -p[13] / p[5]);
    view.extent = scale * shorter / focus;
    // Far enough back that the near distance, a thousandth of the target's, leaves nothing out.
    eye.addScaledVector(ahead, scale * camera.near - (eye.length() + view.extent));
  } else {
    if (p[8] !== 0 || p[9] !== 0) throw new Error('the view of a perspective camera must be centred on its axis');
    view.fieldOfView = 2 * Math.atan(shorter / (2 * focus));
    view.nearDistance = scale * camera.near;
  }
  view.eye = eye.toArray();
  view.target = eye.addScaledVector(ahead, eye.length() + scale).toArray();
  return view;
}
