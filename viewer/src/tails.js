// Where cells have been: lines behind their middles.

import { Lines } from './scenery.js';
import { frameOf } from './source.js';

/** Frames that a tail goes back. */
const LONG = 60;

export class Tails {
  constructor(viewer) {
    this.viewer = viewer;
    this.centres = new Map();
  }

  lines(screen) {
    this.drawn = new Lines('tails', screen);
    this.drawn.mesh.visible = false;
    return this.drawn;
  }

  hide() {
    this.drawn.mesh.visible = false;
  }

  /** The middles of the cells of a frame by their ids. */
  async of(number) {
    if (!this.centres.has(number)) {
      const frame = frameOf(await this.viewer.source.bytes(`frame/${number}`));
      const found = new Map();
      let atom = 0;
      for (let cell = 0; cell < frame.cells; cell += 1) {
        const end = atom + this.viewer.scene.types[frame.kinds[cell]].atoms;
        const count = end - atom;
        const sum = [0, 0, 0];
        for (; atom < end; atom += 1) for (let axis = 0; axis < 3; axis += 1) sum[axis] += frame.parts[axis][atom];
        found.set(frame.ids[cell], sum.map((part, axis) => frame.low[axis] + (part / count / 65535) * frame.sides[axis]));
      }
      this.centres.set(number, found);
    }
    return this.centres.get(number);
  }

  async show(number) {
    if (!this.viewer.state.tails) {
      this.hide();
      return;
    }
    const all = [];
    for (let frame = Math.max(1, number - LONG); frame <= number; frame += 1) {
      const [then, now] = [await this.of(frame - 1), await this.of(frame)];
      for (const [id, at] of now) if (then.has(id)) all.push(...then.get(id), ...at, 1);
    }
    if (number !== this.viewer.state.frame) return;
    this.drawn.show({ count: all.length / 7, all: new Float32Array(all) });
    this.viewer.dirty();
  }
}
