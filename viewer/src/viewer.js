// What is seen, and what follows when one of its parts changes.

import * as THREE from 'three';
import { fromAddress, toAddress } from './address.js';
import { Cells } from './cells.js';
import { Eye, VIEWS } from './eye.js';
import { savePicture, saveFilm } from './keep.js';
import { drawMarks } from './marks.js';
import { Side } from './side.js';
import { Lines, Obstacles, Slice } from './scenery.js';
import { fieldOf, frameOf, json, linesOf } from './source.js';
import { Tails } from './tails.js';
import { Transport } from './transport.js';
import { timeText } from './words.js';

const GROUND = { light: '#ffffff', dark: '#14171c' };

export class Viewer {
  constructor(source, scene, course, say) {
    Object.assign(this, { source, scene, course, say });
    const look = scene.look;
    const hasFibres = scene.lines.includes('fibres') && look.fibres;
    const kept = fromAddress();
    const isDark = window.matchMedia('(prefers-color-scheme: dark)').matches;
    const field = scene.fields.flatMap((field) => field.species.map((species) => `${field.name}.${species.name}`));
    const named = field.find((name) => name === look.field || name.startsWith(`${look.field}.`)) ?? field[0];
    // What the page finds by itself: links within cells, and cells by their ids.
    if (scene.types.some((type) => type.links.length)) scene.lines.unshift('links');
    const known = (name) => name === 'type' || name === 'id' || scene.quantities.some((quantity) => quantity.name === name);
    this.state = {
      frame: 0, colour: known(look.colour_by) ? look.colour_by : 'type', range: look.range ?? undefined,
      field: look.field === 'none' ? 'none' : named ?? 'none', axis: 2, share: 0.5, alpha: 1,
      lines: [scene.lines.includes('links') && 'links', hasFibres && 'fibres', look.loads && scene.lines.includes('loads') && 'loads'].filter(Boolean),
      opacity: hasFibres || scene.lines.includes('links') ? 0.35 : 1, cut: undefined, hidden: [], tails: false, parallel: true, theme: isDark ? 'dark' : 'light',
      cell: undefined, number: undefined, grid: true, title: true, smooth: true,
      ...kept,
    };
    this.drawn = { frame: undefined };
    this.isDirty = true;
    this.numbers = new Map();
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
    this.lines = new Map();
    this.tails = new Tails(this);
    this.space.add(this.tails.lines(this.screen).mesh);
    const first = frameOf(await this.source.bytes(`frame/${Math.min(state.frame, this.frames - 1)}`));
    this.box = this.around(first, frameOf(await this.source.bytes('frame/0')));
    this.theme(state.theme);
    this.cells.isSmooth = state.smooth && state.cut === undefined;
    for (const kind of state.hidden) this.cells.hide(kind, true);
    this.side = new Side(this);
    this.transport = new Transport(this);
    this.field(state.field);
    this.eye.isParallel = state.parallel;
    if (state.eye) this.eye.restore(state.eye);
    else this.fit(scene.look.from);
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    this.resize();
    this.hands();
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
    await this.paint(values);
    if (levels && this.slice) this.slice.show(fieldOf(levels), await this.endsOf(field, this.scene.look.field_range));
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

  async paint(values) {
    const { colour, range } = this.state;
    if (colour === 'id') {
      this.cells.colourByIds();
      this.scale = undefined;
      return;
    }
    this.cells.setMap(this.scene.maps.values);
    if (colour === 'type' || !values) {
      this.cells.colour(undefined);
      this.scale = undefined;
      return;
    }
    const about = this.scene.quantities.find((quantity) => quantity.name === colour);
    const ends = range ?? await this.endsOf(colour, colour === this.scene.look.colour_by ? this.scene.look.range : undefined);
    this.cells.colour(new Float32Array(values), about.of, spread(ends));
    this.scale = { ends, label: about.label, colours: this.scene.maps.values };
  }

  /** The ends of a scale: those that the document says, else those of all frames. */
  async endsOf(name, given) {
    const ends = given ?? await json(this.source, `range/${name}`) ?? [0, 1];
    return ends;
  }

  linesOf(kind) {
    if (!this.lines.has(kind)) {
      const lines = new Lines(kind, this.screen);
      this.lines.set(kind, lines);
      this.space.add(lines.mesh);
    }
    return this.lines.get(kind);
  }

  /** Shows a species of a field, or none. */
  field(name) {
    this.state.field = name;
    if (this.slice) {
      this.space.remove(this.slice.mesh);
      this.slice.dispose();
      this.slice = undefined;
    }
    const field = this.scene.fields.find((known) => name.startsWith(`${known.name}.`));
    if (!field) {
      this.fieldScale = undefined;
      return;
    }
    this.slice = new Slice(field);
    if (!this.slice.isFlat) this.slice.put(this.state.axis, this.state.share);
    this.fieldMap ??= this.map(this.scene.maps.field);
    this.slice.material.uniforms.map.value = this.fieldMap;
    this.slice.material.uniforms.alpha.value = this.state.alpha;
    this.space.add(this.slice.mesh);
    const species = field.species.find((known) => name === `${field.name}.${known.name}`);
    this.endsOf(name, this.scene.look.field_range).then((ends) => {
      this.fieldScale = { ends, label: species.label, colours: this.scene.maps.field };
      this.dirty();
    });
  }

  map(colours) {
    const map = new THREE.DataTexture(new Uint8Array(colours.flatMap((colour) => [...colour, 255])), colours.length, 1);
    map.minFilter = THREE.LinearFilter;
    map.magFilter = THREE.LinearFilter;
    map.needsUpdate = true;
    return map;
  }

  /** Changes a part of what is seen, and what follows from it. */
  async set(key, value) {
    this.state[key] = value;
    if (key === 'theme') this.theme(value);
    if (key === 'parallel') this.eye.isParallel = value;
    if (key === 'field') this.field(value);
    if (key === 'colour') this.state.range = undefined;
    if ((key === 'axis' || key === 'share') && this.slice) this.slice.put(this.state.axis, this.state.share);
    if (key === 'alpha' && this.slice) this.slice.material.uniforms.alpha.value = value;
    if (key === 'opacity') this.cells.hides(value);
    if (key === 'lines') for (const [kind, lines] of this.lines) lines.mesh.visible = value.includes(kind);
    if (key === 'tails') this.tails.show(this.state.frame);
    // Skins that are bent go into each other where cells press, and a cut would show that.
    if (key === 'smooth' || key === 'cut') this.cells.smooth(this.state.smooth && this.state.cut === undefined);
    if (key === 'grid') {
      this.obstacles.group.visible = value;
      this.cells.stand(value ? this.obstacles.floor : undefined);
    }
    if (['field', 'colour', 'range', 'lines'].includes(key)) await this.show(this.state.frame);
    this.keep();
    this.dirty();
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
    this.renderer.setClearColor(GROUND[theme], 1);
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
      scale: this.live ? undefined : this.scale,
      field: this.slice && this.fieldScale,
      axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => [new THREE.Vector3(...axis).dot(right), new THREE.Vector3(...axis).dot(up)]),
    });
    this.shown = (this.shown ?? 0) + 1;
  }

  /** The number of the cell in the frame under a point of the page; none where there is none. */
  pick(clientX, clientY) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    this.target ??= new THREE.WebGLRenderTarget(1, 1);
    const { camera } = this.eye;
    camera.setViewOffset(width, height, clientX - left, clientY - top, 1, 1);
    this.renderer.setRenderTarget(this.target);
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.clear();
    const alone = new THREE.Scene();
    this.cells.picking(() => {
      alone.add(this.cells.group);
      this.renderer.render(alone, camera);
    });
    this.space.add(this.cells.group);
    this.renderer.setRenderTarget(null);
    this.renderer.setClearColor(GROUND[this.state.theme], 1);
    camera.clearViewOffset();
    const pixel = new Uint8Array(4);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, 1, 1, pixel);
    const number = pixel[0] + 256 * pixel[1] + 65536 * pixel[2];
    this.dirty();
    return number > 0 ? number - 1 : undefined;
  }

  /** Chooses a cell by its number in the frame. */
  choose(number) {
    this.state.cell = number === undefined ? undefined : this.cells.frame.ids[number];
    this.side.cell(true);
    this.keep();
  }

  hands() {
    let down;
    this.canvas.addEventListener('pointerdown', (event) => { down = [event.clientX, event.clientY]; });
    this.canvas.addEventListener('pointerup', (event) => {
      if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4 && event.button === 0) this.choose(this.pick(event.clientX, event.clientY));
      down = undefined;
    });
    const turn = 0.1;
    const keys = {
      ' ': () => this.transport.toggle(), ArrowLeft: () => this.transport.go(this.state.frame - 1), ArrowRight: () => this.transport.go(this.state.frame + 1),
      Home: () => this.transport.go(0), End: () => this.transport.go(this.frames - 1), f: () => this.fit(), 0: () => this.view('document'),
      '+': () => this.eye.zoom(1.15), '=': () => this.eye.zoom(1.15), '-': () => this.eye.zoom(1 / 1.15),
      a: () => this.eye.turn(-turn, 0), d: () => this.eye.turn(turn, 0), w: () => this.eye.turn(0, turn), s: () => this.eye.turn(0, -turn),
    };
    Object.keys(VIEWS).forEach((name, k) => { keys[k + 1] = () => this.view(name); });
    document.addEventListener('keydown', (event) => {
      const isTyping = event.target.closest('input[type="number"], select, button, [role="tab"], tr') && event.key === ' ';
      const isSlider = event.target.closest('input, select') && event.key !== ' ';
      if (event.ctrlKey || event.metaKey || event.altKey || isTyping || isSlider || !keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
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

/** Ends that are apart, so that what does not change is in the middle of the scale. */
function spread([low, high]) {
  return high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high)) ? [low, high] : [low - Math.abs(low || 1), low + Math.abs(low || 1)];
}
