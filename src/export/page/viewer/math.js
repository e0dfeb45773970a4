'use strict';
// Vectors, quaternions (x, y, z, w) and matrices (column-major) of the viewer.
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const subtract = (a, b) => add(a, scale(b, -1));
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const lengthOf = (a) => Math.sqrt(dot(a, a));
const unit = (a) => scale(a, 1 / (lengthOf(a) || 1));
const product = (a, b) => [
  a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
  a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]];
const about = (axis, angle) => [...scale(axis, Math.sin(angle / 2)), Math.cos(angle / 2)];
/** Returns a vector turned by a quaternion. */
function turned(q, v) {
  const t = scale(cross(q, v), 2);
  return add(v, add(scale(t, q[3]), cross(q, t)));
}
/** Returns the matrix of a pose. */
function poseMatrix(position, q) {
  const x = turned(q, [1, 0, 0]), y = turned(q, [0, 1, 0]), z = turned(q, [0, 0, 1]);
  return [...x, 0, ...y, 0, ...z, 0, ...position, 1];
}
/** Returns the matrix of the inverse of a pose. */
function inverseMatrix(position, q) {
  const back = [-q[0], -q[1], -q[2], q[3]];
  return poseMatrix(scale(turned(back, position), -1), back);
}
/** Returns the product of two matrices. */
function times(a, b) {
  const out = new Array(16).fill(0);
  for (let column = 0; column < 4; ++column)
    for (let row = 0; row < 4; ++row)
      for (let k = 0; k < 4; ++k) out[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return out;
}
/** Returns the projection of an optical frame: x right, y down, z forward. */
function projection(focal_px, width, height, near, far) {
  return [2 * focal_px / width, 0, 0, 0, 0, -2 * focal_px / height, 0, 0, 0, 0, (far + near) / (far - near), 1, 0, 0,
    -2 * far * near / (far - near), 0];
}

/** View of the session: it turns about a target. */
class Orbit {
  constructor() { this.look({position: [0, -0.3, 0.1], orientation: about([1, 0, 0], -Math.PI / 2), target: [0, 0, 0.1], focal_px: 480, width: 640, height: 480}); }
  /** Looks through a camera of the scene. */
  look(camera) {
    this.orientation = camera.orientation;
    this.position = camera.position;
    this.distance = Math.max(lengthOf(subtract(camera.target, camera.position)), 1e-4);
    this.lens = camera;
  }
  get target() { return add(this.position, scale(turned(this.orientation, [0, 0, 1]), this.distance)); }
  /** Turns about the target. Angles in radians. */
  turn(aside, up) {
    const target = this.target;
    this.orientation = product(product(about([0, 0, 1], -aside), this.orientation), about([1, 0, 0], up));
    this.orientation = scale4(this.orientation);
    this.position = subtract(target, scale(turned(this.orientation, [0, 0, 1]), this.distance));
  }
  /** Moves by pixels of the picture. */
  move(right, down, focal_px) {
    const by = this.distance / focal_px;
    this.position = subtract(this.position, turned(this.orientation, [right * by, down * by, 0]));
  }
  zoom(factor) {
    const target = this.target;
    this.distance = Math.min(Math.max(this.distance * factor, 1e-3), 1e3);
    this.position = subtract(target, scale(turned(this.orientation, [0, 0, 1]), this.distance));
  }
  /** Returns the focal length with which all that the camera sees fits into a picture. */
  focalIn(width, height) { return this.lens.focal_px * Math.min(width / this.lens.width, height / this.lens.height); }
}
const scale4 = (q) => {
  const length = Math.hypot(...q);
  return q.map((x) => x / length);
};
