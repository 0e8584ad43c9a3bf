// The camera of the 3D view: parallel rays, so that lengths can be read off the screen.
import * as THREE from "./three.module.min.js";
import { OrbitControls } from "./OrbitControls.js";

const SLANTED = [0.46, -0.84, 0.3];
export const VIEWS = {
  Slanted: SLANTED,
  Front: [0, -1, 0],
  Back: [0, 1, 0],
  Left: [-1, 0, 0],
  Right: [1, 0, 0],
  Top: [0, -1e-4, 1],
  Bottom: [0, -1e-4, -1],
};
const TURN = 0.1,
  SHIFT = 0.1,
  STEEPEST = 1.55;

export class Camera {
  // changed(): after every move of the mouse.
  constructor(canvas, changed) {
    this.canvas = canvas;
    this.isFitted = true; // as long as nobody has moved or zoomed
    this.away = 10;
    this.half = 0; // of the height that is seen, in mm
    this.lens = new THREE.OrthographicCamera();
    this.lens.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.lens, canvas);
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("end", () => {
      if (this.centre && this.controls.target.distanceTo(this.centre) > 0) this.isFitted = false;
    });
    this.look(SLANTED);
  }

  look(direction) {
    const away = new THREE.Vector3(...direction).normalize().multiplyScalar(this.away);
    this.lens.position.copy(this.controls.target).add(away);
    this.controls.update();
  }

  // So near that all corners are seen, in the direction in which it looks; room: px beside them for what is written.
  fit(corners, room) {
    const { lens, canvas } = this,
      size = corners[0].distanceTo(corners[7]);
    if (!canvas.clientHeight) return;
    lens.updateMatrixWorld();
    const back = lens.quaternion.clone().invert(),
      turned = corners.map((one) => one.clone().applyQuaternion(back));
    const end = (which) => ["x", "y", "z"].map((name) => which(...turned.map((one) => one[name])));
    const low = end(Math.min),
      high = end(Math.max);
    const wide = Math.max(60, canvas.clientWidth - room.left - room.right);
    const tall = Math.max(60, canvas.clientHeight - room.top - room.bottom);
    const unit = Math.max((high[0] - low[0]) / wide, (high[1] - low[1]) / tall); // mm of a px
    const middle = new THREE.Vector3(...low.map((one, i) => (one + high[i]) / 2));
    middle.x += ((room.right - room.left) * unit) / 2;
    middle.y += ((room.top - room.bottom) * unit) / 2;
    middle.applyQuaternion(lens.quaternion);
    const away = lens.position.clone().sub(this.controls.target).normalize();
    this.away = 3 * size;
    this.half = (unit * canvas.clientHeight) / 2;
    Object.assign(lens, { near: 0.01 * size, far: 12 * size, zoom: 1 });
    this.centre = middle;
    this.controls.target.copy(middle);
    lens.position.copy(middle).addScaledVector(away, this.away);
    this.controls.update();
    this.isFitted = true;
  }

  // The frame of a canvas of this size.
  frame(width, height) {
    const { half } = this,
      across = (half * width) / height;
    Object.assign(this.lens, { left: -across, right: across, top: half, bottom: -half });
    this.lens.updateProjectionMatrix();
  }

  // A point in mm -> its place in px.
  projection(width, height) {
    return (point) => {
      const at = new THREE.Vector3(...point).project(this.lens);
      return [((at.x + 1) / 2) * width, ((1 - at.y) / 2) * height];
    };
  }

  // A direction -> how far it goes to the right and up.
  turning() {
    const back = this.lens.quaternion.clone().invert();
    return (direction) => new THREE.Vector3(...direction).applyQuaternion(back).toArray().slice(0, 2);
  }

  // px of a mm.
  scale(height) {
    return (height * this.lens.zoom) / (2 * this.half);
  }

  ray(x, y, width, height) {
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.lens);
    return ray;
  }

  turn(right, up) {
    const offset = this.lens.position.clone().sub(this.controls.target),
      away = offset.length();
    const yaw = Math.atan2(offset.y, offset.x) - TURN * right;
    const steep = Math.atan2(offset.z, Math.hypot(offset.x, offset.y)) + TURN * up;
    const tilt = Math.max(-STEEPEST, Math.min(STEEPEST, steep)),
      flat = Math.cos(tilt);
    offset.set(Math.cos(yaw) * flat, Math.sin(yaw) * flat, Math.sin(tilt)).multiplyScalar(away);
    this.lens.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  zoom(factor) {
    this.lens.zoom *= factor;
    this.isFitted = false;
  }

  shift(x, y) {
    const side = (...axis) => new THREE.Vector3(...axis).applyQuaternion(this.lens.quaternion);
    const by = side(1, 0, 0)
      .multiplyScalar(-SHIFT * x * this.half)
      .addScaledVector(side(0, 1, 0), SHIFT * y * this.half);
    this.controls.target.add(by);
    this.lens.position.add(by);
    this.isFitted = false;
    this.controls.update();
  }
}
