// The eye: parallel or perspective, turned, moved and zoomed by hand, or put to a named view.

import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

/** Directions from the cells to the eye, by their names, and what is up there. */
export const VIEWS = {
  front: [[0, -1, 0], [0, 0, 1]], back: [[0, 1, 0], [0, 0, 1]], left: [[-1, 0, 0], [0, 0, 1]], right: [[1, 0, 0], [0, 0, 1]],
  top: [[0, 0, 1], [0, 1, 0]], bottom: [[0, 0, -1], [0, 1, 0]],
};

export class Eye {
  constructor(canvas, changed) {
    this.parallel = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
    this.deep = new THREE.PerspectiveCamera(30, 1, 0.1, 10000);
    for (const camera of [this.parallel, this.deep]) camera.up.set(0, 0, 1);
    this.camera = this.parallel;
    this.height = 10;
    this.aspect = 1;
    this.size = 10;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.screenSpacePanning = true;
    this.controls.addEventListener('change', changed);
    this.changed = changed;
  }

  /** Looks at the middle of a box so that all of it is seen, from a direction or from where the eye is. */
  fit(low, sides, from) {
    const middle = new THREE.Vector3(...low).addScaledVector(new THREE.Vector3(...sides), 0.5);
    const size = Math.max(Math.hypot(...sides), 1e-6);
    const back = from ? new THREE.Vector3(...from).normalize() : this.back();
    // Straight from above or below nothing would tell what is up.
    if (Math.abs(back.z) > 0.9999) back.set(0, -1e-4 * Math.sign(back.z), back.z).normalize();
    this.size = size;
    this.height = 1.15 * size;
    this.controls.target.copy(middle);
    this.put(back, size);
  }

  put(back, size = this.size) {
    const { target } = this.controls;
    const distance = (0.5 * this.height) / Math.tan((0.5 * this.deep.fov * Math.PI) / 180);
    this.parallel.zoom = 1;
    this.parallel.position.copy(target).addScaledVector(back, 20 * size);
    this.deep.position.copy(target).addScaledVector(back, distance);
    for (const camera of [this.parallel, this.deep]) camera.lookAt(target);
    this.frame();
    this.controls.update();
    this.changed();
  }

  /** Unit vector from what is looked at to the eye. */
  back() {
    return this.camera.position.clone().sub(this.controls.target).normalize();
  }

  /** Fits the cameras to the window. */
  frame(aspect = this.aspect) {
    this.aspect = aspect;
    // A high window shows as much across as a square one.
    const half = 0.5 * this.height * Math.max(1, 1 / aspect);
    Object.assign(this.parallel, { left: -half * aspect, right: half * aspect, top: half, bottom: -half, near: -100 * this.size, far: 100 * this.size });
    Object.assign(this.deep, { aspect, near: 0.01 * this.size, far: 200 * this.size });
    for (const camera of [this.parallel, this.deep]) camera.updateProjectionMatrix();
  }

  get isParallel() {
    return this.camera === this.parallel;
  }

  set isParallel(wanted) {
    if (wanted === this.isParallel) return;
    const back = this.back();
    this.height = this.seen();
    this.camera = wanted ? this.parallel : this.deep;
    this.controls.object = this.camera;
    this.put(back);
  }

  /** How much of the scene is seen from top to bottom at what is looked at, µm. */
  seen() {
    if (this.isParallel) return (this.parallel.top - this.parallel.bottom) / this.parallel.zoom / Math.max(1, 1 / this.aspect);
    return 2 * this.camera.position.distanceTo(this.controls.target) * Math.tan((0.5 * this.deep.fov * Math.PI) / 180);
  }

  /** Turns the eye about what is looked at, rad. */
  turn(around, up) {
    const offset = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target).applyAxisAngle(new THREE.Vector3(1, 0, 0), -Math.PI / 2));
    offset.theta += around;
    offset.phi = Math.min(Math.PI - 1e-3, Math.max(1e-3, offset.phi - up));
    const to = new THREE.Vector3().setFromSpherical(offset).applyAxisAngle(new THREE.Vector3(1, 0, 0), Math.PI / 2);
    this.camera.position.copy(this.controls.target).add(to);
    this.controls.update();
    this.changed();
  }

  zoom(by) {
    if (this.isParallel) {
      this.parallel.zoom *= by;
      this.parallel.updateProjectionMatrix();
    } else {
      const offset = this.camera.position.clone().sub(this.controls.target).divideScalar(by);
      this.camera.position.copy(this.controls.target).add(offset);
    }
    this.controls.update();
    this.changed();
  }

  /** What an address keeps of the eye. */
  kept() {
    const round = (number) => Number(number.toPrecision(5));
    return [...this.back().toArray(), ...this.controls.target.toArray(), this.seen()].map(round);
  }

  restore([bx, by, bz, x, y, z, seen]) {
    this.height = seen;
    this.controls.target.set(x, y, z);
    this.put(new THREE.Vector3(bx, by, bz).normalize());
  }
}
