// Time: playing, stepping, and a run that goes on.

import { json } from './source.js';
import { timeText } from './words.js';

const byId = (id) => document.getElementById(id);

/** Time between two looks at a run that goes on, ms. */
const NOW = 90;

export class Transport {
  constructor(viewer) {
    this.viewer = viewer;
    this.isPlaying = false;
    byId('play').onclick = () => this.toggle();
    byId('back').onclick = () => this.go(viewer.state.frame - 1);
    byId('on').onclick = () => this.go(viewer.state.frame + 1);
    byId('frame').oninput = () => this.go(Number(byId('frame').value));
    byId('speed').value = String(viewer.state.speed ?? 10);
    byId('speed').onchange = () => viewer.set('speed', Number(byId('speed').value));
    byId('hold').onclick = () => viewer.source.want(this.run?.phase === 'paused' ? 'go' : 'pause');
    byId('stop').onclick = () => viewer.source.want('stop');
    this.told();
  }

  get perSecond() {
    return Number(byId('speed').value);
  }

  get follows() {
    return this.run && this.run.phase !== 'ended' && byId('follow').checked;
  }

  /** Goes to a frame, and no longer with the run. */
  go(frame) {
    byId('follow').checked = false;
    this.pause();
    return this.viewer.show(frame);
  }

  toggle() {
    if (this.isPlaying) this.pause();
    else this.play();
  }

  pause() {
    this.isPlaying = false;
    this.told();
  }

  async play() {
    const { viewer } = this;
    if (this.isPlaying) return;
    this.isPlaying = true;
    byId('follow').checked = false;
    if (viewer.state.frame >= viewer.frames - 1) await viewer.show(0);
    while (this.isPlaying && viewer.state.frame < viewer.frames - 1) {
      const wait = new Promise((done) => { setTimeout(done, 1000 / this.perSecond); });
      await viewer.show(viewer.state.frame + 1);
      this.fetchAhead();
      await wait;
    }
    this.pause();
  }

  /** Asks for the next frames while this one is shown. */
  fetchAhead() {
    const { source, state, frames } = this.viewer;
    for (let frame = state.frame + 1; frame < Math.min(frames, state.frame + 4); frame += 1) {
      source.bytes(`frame/${frame}`);
      if (state.colour !== 'type' && state.colour !== 'id') source.bytes(`values/${frame}/${state.colour}`);
      if (state.field !== 'none') source.bytes(`field/${frame}/${state.field}`);
    }
  }

  /** Says where one is. */
  told() {
    const { viewer } = this;
    const { frames, state } = viewer;
    const slider = byId('frame');
    slider.max = String(Math.max(0, frames - 1));
    slider.value = String(state.frame);
    const where = viewer.live ? 'now' : `frame ${state.frame + 1} of ${frames}`;
    slider.setAttribute('aria-valuetext', `${where}, ${timeText(viewer.time, viewer.scene.until, viewer.scene.clock)}`);
    byId('clock').textContent = `${timeText(viewer.time, viewer.scene.until, viewer.scene.clock)} · ${where}`;
    const play = byId('play');
    byId('sign').setAttribute('d', this.isPlaying ? 'M3 2h4v12H3zM9 2h4v12H9z' : 'M3 1.5v13L14 8z');
    play.setAttribute('aria-label', this.isPlaying ? 'Pause' : 'Play');
    play.disabled = frames < 2;
    byId('back').disabled = state.frame <= 0;
    byId('on').disabled = state.frame >= frames - 1;
  }

  /** Takes in what the program tells of a result that grows. */
  listen() {
    this.viewer.source.listen((news) => this.news(news), () => {
      byId('progress').textContent = 'The program that served this page has ended.';
      byId('run').hidden = false;
      for (const id of ['hold', 'stop']) byId(id).hidden = true;
      byId('follow').parentElement.hidden = true;
    });
  }

  async news({ frames, running, run }) {
    const { viewer } = this;
    this.run = run;
    byId('run').hidden = !run && !running;
    const isOver = !run || run.phase === 'ended';
    for (const id of ['hold', 'stop']) byId(id).hidden = isOver;
    byId('follow').parentElement.hidden = isOver && !running;
    byId('hold').textContent = run?.phase === 'paused' ? 'Let the run go on' : 'Pause the run';
    byId('progress').textContent = this.progress(run, running);
    if (frames > viewer.frames) {
      viewer.course = await json(viewer.source, 'course');
      viewer.side.grown();
      this.told();
    }
    if (this.follows && !this.isWatching) this.watch();
    // The last frame that there is, unless what is seen is newer.
    const isBehind = viewer.state.frame < viewer.frames - 1 || viewer.live;
    const isFollowed = (run || running || this.wasRunning) && byId('follow').checked && !this.isPlaying;
    const showsNow = this.follows && viewer.state.colour === 'type';
    if (isFollowed && isBehind && !showsNow) await viewer.show(viewer.frames - 1);
    this.wasRunning = running;
  }

  progress(run, running) {
    if (!run) return running ? 'A run writes this result.' : '';
    if (run.phase === 'preparing') return run.words || 'The run is being prepared.';
    if (run.phase === 'ended') return `The run has ended after ${run.steps} steps.`;
    const share = run.until > 0 ? Math.round((100 * run.time) / run.until) : 0;
    return `${run.phase === 'paused' ? 'The run waits' : 'Running'}: ${timeText(run.time, run.until, this.viewer.scene.clock)}, ${share} %`;
  }

  /** Shows the run as it goes on, for as long as it is followed. */
  async watch() {
    const { viewer } = this;
    this.isWatching = true;
    let last;
    while (this.follows) {
      const wait = new Promise((done) => { setTimeout(done, NOW); });
      const asks = viewer.state.colour === 'type' && !document.hidden;
      // A program that has ended answers no more, and the events tell so.
      const bytes = asks ? await viewer.source.now().catch(() => undefined) : undefined;
      const time = bytes && new DataView(bytes).getFloat64(0, true);
      if (bytes && this.follows && time !== last) viewer.showNow(bytes);
      last = time ?? last;
      await wait;
    }
    this.isWatching = false;
    if (viewer.live) await viewer.show(viewer.frames - 1).catch(() => {});
  }
}
