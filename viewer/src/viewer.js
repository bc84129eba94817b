// What is seen, and what follows when one of its parts changes.

import * as THREE from 'three';
import { toAddress } from './address.js';
import { Cells } from './cells.js';
import { Colours } from './colours.js';
import { Eye, VIEWS } from './eye.js';
import { listen } from './hands.js';
import { savePicture, saveFilm } from './keep.js';
import { drawMarks } from './marks.js';
import { Side } from './side.js';
import { Lines, Obstacles } from './scenery.js';
import { fieldOf, frameOf, linesOf } from './source.js';
import { stateOf } from './state.js';
import { Tails } from './tails.js';
import { Transport } from './transport.js';
import { timeText } from './words.js';

const GROUND = { light: '#ffffff', dark: '#14171c' };

export class Viewer {
  constructor(source, scene, course, say) {
    Object.assign(this, { source, scene, course, say });
    this.state = stateOf(scene);
    this.drawn = { frame: undefined };
    this.isDirty = true;
    this.numbers = new Map();
  }

  /** The colour behind everything. */
  get ground() {
    return GROUND[this.state.theme];
  }

  get frames() {
    return this.course.times.length;
  }

  get time() {
    return this.live?.time ?? this.course.times[this.state.frame];
  }

  async start() {
    const { scene, state } = this;
    this.canvas = document.getElementById('view');
    this.marks = document.getElementById('marks');
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, stencil: true, preserveDrawingBuffer: true, powerPreference: 'high-performance' });
    this.space = new THREE.Scene();
    this.cells = new Cells(scene.types);
    this.eye = new Eye(this.canvas, () => this.dirty());
    this.screen = { value: new THREE.Vector2(1, 1) };
    this.space.add(this.cells.group, this.cells.shadows);
    this.colours = new Colours(this);
    this.lines = new Map();
    this.tails = new Tails(this);
    this.space.add(this.tails.lines(this.screen).mesh);
    const first = frameOf(await this.source.bytes(`frame/${Math.min(state.frame, this.frames - 1)}`));
    this.begin = frameOf(await this.source.bytes('frame/0'));
    this.box = this.around(first, this.begin);
    this.mark();
    this.theme(state.theme);
    this.cells.isSmooth = state.smooth && state.cut === undefined;
    for (const kind of state.hidden) this.cells.hide(kind, true);
    this.side = new Side(this);
    this.transport = new Transport(this);
    this.colours.field(state.field);
    this.eye.isParallel = state.parallel;
    if (state.eye) this.eye.restore(state.eye);
    else this.fit(scene.look.from);
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    this.resize();
    listen(this);
    await this.show(state.frame);
    if (state.cell !== undefined) await this.side.cell();
    const draw = () => {
      if (this.isDirty) this.draw();
      requestAnimationFrame(draw);
    };
    requestAnimationFrame(draw);
    if (this.source.isServed) this.transport.listen();
  }

  /** The box around some frames and what stands in the scene. */
  around(...frames) {
    const low = [0, 1, 2].map((axis) => Math.min(...frames.map((frame) => frame.low[axis])));
    const high = [0, 1, 2].map((axis) => Math.max(...frames.map((frame) => frame.low[axis] + frame.sides[axis])));
    return { low, sides: high.map((end, axis) => end - low[axis]) };
  }

  dirty() {
    this.isDirty = true;
  }

  /** Shows a frame of the result, with all that belongs to it. */
  async show(number) {
    const frame = Math.max(0, Math.min(this.frames - 1, Math.round(number)));
    this.state.frame = frame;
    this.live = undefined;
    const turn = (this.turn = (this.turn ?? 0) + 1);
    const { colour, field, lines } = this.state;
    const asked = [this.source.bytes(`frame/${frame}`)];
    asked.push(colour === 'type' || colour === 'id' ? undefined : this.source.bytes(`values/${frame}/${colour}`));
    asked.push(field === 'none' ? undefined : this.source.bytes(`field/${frame}/${field}`));
    lines.forEach((kind) => asked.push(kind === 'links' ? undefined : this.source.bytes(`lines/${frame}/${kind}`)));
    let answers;
    try {
      answers = await Promise.all(asked);
      this.say('');
    } catch (error) {
      // A damaged result, or a program that has ended: what is seen stays.
      this.say(error.message, true);
      this.transport?.pause();
      return;
    }
    const [atoms, values, levels, ...found] = answers;
    // Whoever goes on meanwhile sees the later one.
    if (turn !== this.turn || !atoms) return;
    this.cells.show(frameOf(atoms));
    await this.colours.paint(values);
    if (levels && this.colours.slice) this.colours.slice.show(fieldOf(levels), await this.colours.endsOfField(field));
    lines.forEach((kind, k) => found[k] && this.linesOf(kind).show(linesOf(found[k])));
    if (lines.includes('links')) this.linesOf('links').show(this.cells.links());
    this.obstacles.move(this.course.gone.map((gone) => gone?.[frame]));
    this.tails.show(frame);
    this.drawn.frame = frame;
    this.settled();
  }

  /** Shows where a run is that goes on, between two of its frames. */
  showNow(bytes) {
    const frame = frameOf(bytes, 8);
    this.live = { time: new DataView(bytes).getFloat64(0, true) };
    this.turn = (this.turn ?? 0) + 1;
    this.cells.show(frame);
    // What colours show and the lines are known of frames that are recorded.
    this.cells.colour(undefined);
    for (const lines of this.lines.values()) lines.mesh.visible = false;
    this.tails.hide();
    this.settled();
  }

  settled() {
    this.transport.told();
    this.side.settled();
    this.dirty();
    this.keep();
  }

  linesOf(kind) {
    if (!this.lines.has(kind)) {
      const lines = new Lines(kind, this.screen);
      this.lines.set(kind, lines);
      this.space.add(lines.mesh);
    }
    return this.lines.get(kind);
  }

  /** Changes a part of what is seen, and what follows from it. */
  async set(key, value) {
    this.state[key] = value;
    const { slice } = this.colours;
    if (key === 'theme') this.theme(value);
    if (key === 'parallel') this.eye.isParallel = value;
    if (key === 'field' || key === 'decades') this.colours.field(this.state.field);
    if (key === 'colour') this.state.range = undefined;
    if ((key === 'axis' || key === 'share') && slice) slice.put(this.state.axis, this.state.share);
    if (key === 'alpha' && slice) slice.material.uniforms.alpha.value = value;
    if (key === 'opacity') this.cells.hides(value);
    if (key === 'marks') this.mark();
    if (key === 'lines') for (const [kind, lines] of this.lines) lines.mesh.visible = value.includes(kind);
    if (key === 'tails') this.tails.show(this.state.frame);
    // Skins that are bent go into each other where cells press, and a cut would show that.
    if (key === 'smooth' || key === 'cut') this.cells.smooth(this.state.smooth && this.state.cut === undefined);
    if (key === 'grid') {
      this.obstacles.group.visible = value;
      this.cells.stand(value ? this.obstacles.floor : undefined);
    }
    if (['field', 'decades', 'colour', 'range', 'lines'].includes(key)) await this.show(this.state.frame);
    this.keep();
    this.dirty();
  }

  /** Paints cells in two tones, or not: of the types that the document names, or of all. */
  mark() {
    const named = [this.scene.look.marks ?? this.scene.types.map(({ name }) => name)].flat();
    const kinds = this.scene.types.map((_, kind) => kind).filter((kind) => named.includes(this.scene.types[kind].name));
    this.cells.mark(this.state.marks ? kinds : [], this.begin);
  }

  hide(kind, isHidden) {
    const hidden = new Set(this.state.hidden);
    if (isHidden) hidden.add(kind);
    else hidden.delete(kind);
    this.cells.hide(kind, isHidden);
    this.set('hidden', [...hidden]);
  }

  theme(theme) {
    document.documentElement.dataset.theme = theme;
    this.renderer.setClearColor(this.ground, 1);
    if (this.obstacles) this.space.remove(this.obstacles.group);
    const { light, sky } = this.cells.shared;
    this.obstacles = new Obstacles(this.scene.obstacles, this.box, { light, sky }, theme === 'dark');
    this.obstacles.group.visible = this.state.grid;
    this.obstacles.move(this.course.gone.map((gone) => gone?.[this.state.frame]));
    this.space.add(this.obstacles.group);
    this.cells.stand(this.state.grid ? this.obstacles.floor : undefined);
    this.cells.hides(this.state.opacity);
    this.dirty();
  }

  /** Puts all cells into view, from a direction where one is named. */
  fit(from) {
    const frame = this.cells.frame;
    const box = frame ? this.around(frame) : this.box;
    this.eye.fit(box.low, box.sides, from);
    this.keep();
  }

  view(name) {
    this.fit(VIEWS[name] ? VIEWS[name][0] : this.scene.look.from);
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    this.renderer.setPixelRatio(scale);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.marks.width = this.canvas.width;
    this.marks.height = this.canvas.height;
    this.screen.value.set(clientWidth / 2, clientHeight / 2);
    this.eye.frame(clientWidth / clientHeight);
    this.dirty();
  }

  draw() {
    this.isDirty = false;
    const { camera } = this.eye;
    camera.updateMatrixWorld();
    const [right, up, back] = [0, 1, 2].map((column) => new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, column));
    const { light, cut } = this.cells.shared;
    // Over the viewer's left shoulder, and always well above the floor.
    light.value.copy(back).multiplyScalar(0.75).addScaledVector(right, -0.62).addScaledVector(up, 0.5).add(new THREE.Vector3(0, 0, 0.75)).normalize();
    if (this.state.cut === undefined) cut.value.set(0, 0, 0, 1e30);
    else {
      const middle = new THREE.Vector3(...this.box.low).addScaledVector(new THREE.Vector3(...this.box.sides), 0.5);
      cut.value.set(back.x, back.y, back.z, middle.dot(back) + this.state.cut * 0.5 * this.eye.size);
    }
    this.renderer.render(this.space, camera);
    const scale = this.canvas.width / this.canvas.clientWidth;
    drawMarks(this.marks.getContext('2d'), this.marks.width, this.marks.height, scale, {
      dark: this.state.theme === 'dark',
      title: this.state.title ? this.scene.title : '',
      time: timeText(this.time, this.scene.until, this.scene.clock),
      bar: true,
      perMicron: this.canvas.clientHeight / (this.eye.seen() * Math.max(1, 1 / this.eye.aspect)),
      // Colours that are those of ids tell no type.
      names: this.state.colour === 'id' ? [] : this.scene.types.map(({ name, colour }, kind) => ({ name, colour, count: this.cells.counts?.[kind] ?? 0 })),
      scale: this.live ? undefined : this.colours.scale,
      field: this.colours.slice && this.colours.fieldScale,
      axes: this.state.axes && this.scene.axes.map((axis, k) => ({ ...axis, end: [right, up, back].map((side) => side.getComponent(k)) })),
    });
    this.shown = (this.shown ?? 0) + 1;
  }

  /** Chooses a cell by its number in the frame. */
  choose(number) {
    this.state.cell = number === undefined ? undefined : this.cells.frame.ids[number];
    this.side.cell(true);
    this.keep();
  }

  /** Keeps what is seen in the address, a moment later. */
  keep() {
    clearTimeout(this.keeping);
    this.keeping = setTimeout(() => {
      const { ...state } = this.state;
      toAddress({ ...state, eye: this.eye.kept() });
    }, 250);
  }

  async picture() {
    this.draw();
    await savePicture(this.canvas, this.marks, this.name());
  }

  async film() {
    await saveFilm(this.canvas, this.marks, this.name(), this.frames, this.transport.perSecond, async (frame) => {
      await this.show(frame);
      this.draw();
    });
  }

  name() {
    return (this.scene.title || 'pseudopod').replace(/[^\p{L}\p{N}]+/gu, '_').slice(0, 60);
  }
}
