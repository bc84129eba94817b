// Charts: the document's, and those of what one clicks; a cursor shows the frame in all of them.

import { powers, short, ticks } from './words.js';

const MARGIN = { left: 54, right: 10, top: 8, bottom: 34 };

/** A colour as it can be seen on the ground of the page: those that are dark on white are light on black. */
function seen(colour) {
  if (document.documentElement.dataset.theme !== 'dark') return colour;
  const parts = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  const bright = 0.3 * parts[0] + 0.6 * parts[1] + 0.1 * parts[2];
  const share = bright < 130 ? 0.55 * (1 - bright / 255) + 0.1 : 0;
  return `rgb(${parts.map((part) => Math.round(part + share * (255 - part))).join(',')})`;
}

/** One chart in the page. */
export class Chart {
  constructor(parent, about) {
    this.about = about;
    this.figure = document.createElement('figure');
    const caption = document.createElement('figcaption');
    caption.textContent = about.title;
    this.figure.append(caption);
    parent.append(this.figure);
    if (about.fault) {
      const fault = document.createElement('p');
      fault.className = 'fault';
      fault.textContent = about.fault;
      this.figure.append(fault);
    } else if (about.svg) {
      const image = document.createElement('img');
      image.alt = about.title || about.name;
      image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(about.svg)}`;
      this.figure.append(image);
    } else {
      this.canvas = document.createElement('canvas');
      this.canvas.setAttribute('role', 'img');
      this.figure.append(this.canvas);
    }
  }

  /** Ends of both axes over all that is drawn. */
  ends() {
    const found = { x: [Infinity, -Infinity], y: [Infinity, -Infinity] };
    const add = (axis, value) => {
      if (typeof value !== 'number' || !Number.isFinite(value) || (this.about[axis].log && value <= 0)) return;
      found[axis][0] = Math.min(found[axis][0], value);
      found[axis][1] = Math.max(found[axis][1], value);
    };
    for (const { points = [], bars = [] } of this.about.series) {
      for (const [x, ...ys] of points) {
        add('x', x);
        ys.forEach((y) => add('y', y));
      }
      bars.flat().forEach((y) => add('y', y));
    }
    for (const axis of ['x', 'y']) {
      let [low, high] = found[axis];
      if (!(low <= high)) [low, high] = [0, 1];
      const least = 1e-6 * Math.max(Math.abs(low), Math.abs(high), 1e-12);
      if (high - low < least) [low, high] = [low - Math.max(0.05 * Math.abs(low), 1e-9), high + Math.max(0.05 * Math.abs(high), 1e-9)];
      else if (axis === 'y' && !this.about.y.log) [low, high] = [low - 0.04 * (high - low), high + 0.04 * (high - low)];
      found[axis] = [low, high];
    }
    return found;
  }

  /** Draws it with the cursor at a frame of the result, whose time is this one, s. */
  draw(number, time) {
    if (!this.canvas) return;
    const scale = window.devicePixelRatio || 1;
    const [w, h] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (!w || !h) return;
    if (this.canvas.width !== Math.round(w * scale)) this.canvas.width = Math.round(w * scale);
    if (this.canvas.height !== Math.round(h * scale)) this.canvas.height = Math.round(h * scale);
    const context = this.canvas.getContext('2d');
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, w, h);
    const style = getComputedStyle(document.documentElement);
    const [ink, line, faint] = ['--ink', '--line', '--faint'].map((name) => style.getPropertyValue(name).trim());
    const area = { left: MARGIN.left, right: w - MARGIN.right, top: MARGIN.top, bottom: h - MARGIN.bottom };
    const ends = this.ends();
    const along = (axis) => {
      const bend = this.about[axis].log ? Math.log10 : (value) => value;
      const [low, high] = ends[axis].map(bend);
      const [from, to] = axis === 'x' ? [area.left, area.right] : [area.bottom, area.top];
      return (value) => from + ((bend(value) - low) / (high - low)) * (to - from);
    };
    const [px, py] = [along('x'), along('y')];
    this.frame(context, area, ends, px, py, { ink, line, faint });
    context.save();
    context.beginPath();
    context.rect(area.left, area.top, area.right - area.left, area.bottom - area.top);
    context.clip();
    const told = this.series(context, px, py, number);
    if (this.about.cursor === 'time' && time !== undefined) {
      context.strokeStyle = faint;
      context.setLineDash([3, 3]);
      context.beginPath();
      context.moveTo(px(time), area.top);
      context.lineTo(px(time), area.bottom);
      context.stroke();
      context.setLineDash([]);
    }
    context.restore();
    this.legend(context, area, ink);
    this.canvas.setAttribute('aria-label', `${this.about.title || this.about.name}: ${this.about.y.label} against ${this.about.x.label}${told}`);
  }

  frame(context, area, ends, px, py, { ink, line, faint }) {
    context.font = '11px system-ui, sans-serif';
    context.lineWidth = 1;
    context.fillStyle = ink;
    const marks = (axis, count) => {
      const [low, high] = ends[axis];
      return (this.about[axis].log ? powers : ticks)(low, high, count);
    };
    context.strokeStyle = line;
    context.textAlign = 'right';
    context.textBaseline = 'middle';
    for (const tick of marks('y', 4)) {
      context.beginPath();
      context.moveTo(area.left, py(tick));
      context.lineTo(area.right, py(tick));
      context.stroke();
      context.fillText(short(tick), area.left - 5, py(tick));
    }
    context.textAlign = 'center';
    context.textBaseline = 'top';
    for (const tick of marks('x', 5)) {
      context.beginPath();
      context.moveTo(px(tick), area.bottom);
      context.lineTo(px(tick), area.bottom + 3);
      context.stroke();
      context.fillText(short(tick), px(tick), area.bottom + 5);
    }
    context.strokeStyle = faint;
    context.strokeRect(area.left, area.top, area.right - area.left, area.bottom - area.top);
    context.fillText(this.about.x.label, 0.5 * (area.left + area.right), area.bottom + 19);
    context.save();
    context.translate(9, 0.5 * (area.top + area.bottom));
    context.rotate(-Math.PI / 2);
    context.textBaseline = 'middle';
    context.fillText(this.about.y.label, 0, 0);
    context.restore();
  }

  /** Draws all series; returns what the cursor says, in words. */
  series(context, px, py, number) {
    let told = '';
    let lines = 0;
    this.legends = [];
    for (const series of this.about.series) {
      const isFaint = series.kind === 'line' && series.width < 1;
      const colour = seen(series.colour);
      context.strokeStyle = colour;
      context.fillStyle = colour;
      if (series.label) this.legends.push([series.label, colour, series.kind]);
      if (series.kind === 'line') {
        context.lineWidth = isFaint ? 0.8 : 1.8;
        context.setLineDash(series.dashed ? [5, 4] : []);
        context.beginPath();
        let on = false;
        for (const [x, y] of series.points) {
          const known = typeof x === 'number' && typeof y === 'number';
          if (known && on) context.lineTo(px(x), py(y));
          else if (known) context.moveTo(px(x), py(y));
          on = known;
        }
        context.stroke();
        context.setLineDash([]);
        if (!isFaint) {
          const at = this.about.cursor === 'frame' ? this.about.at[lines] : series.points;
          lines += 1;
          if (at?.[number]) told += this.cursor(context, px, py, series, at[number]);
        }
      } else if (series.kind === 'points') {
        this.points(context, px, py, series);
      } else if (series.kind === 'band') {
        context.globalAlpha = 0.2;
        context.beginPath();
        series.points.forEach(([x, low]) => context.lineTo(px(x), py(low)));
        [...series.points].reverse().forEach(([x, , high]) => context.lineTo(px(x), py(high)));
        context.fill();
        context.globalAlpha = 1;
      }
    }
    return told;
  }

  cursor(context, px, py, series, [x, y]) {
    if (typeof x !== 'number' || typeof y !== 'number') return '';
    context.beginPath();
    context.arc(px(x), py(y), 4, 0, 2 * Math.PI);
    context.fill();
    return `; now ${series.label ? `${series.label} ` : ''}${short(y)} at ${short(x)}`;
  }

  points(context, px, py, { points, bars }) {
    context.lineWidth = 1;
    points.forEach(([x, y], k) => {
      if (bars[k]) {
        context.beginPath();
        context.moveTo(px(x), py(bars[k][0]));
        context.lineTo(px(x), py(bars[k][1]));
        context.stroke();
      }
      context.beginPath();
      context.arc(px(x), py(y), 2.6, 0, 2 * Math.PI);
      context.fill();
    });
  }

  legend(context, area, ink) {
    context.font = '11px system-ui, sans-serif';
    context.textAlign = 'left';
    context.textBaseline = 'middle';
    this.legends?.forEach(([label, colour, kind], row) => {
      const y = area.top + 11 + 14 * row;
      context.fillStyle = colour;
      if (kind === 'points') {
        context.beginPath();
        context.arc(area.left + 15, y, 3, 0, 2 * Math.PI);
        context.fill();
      } else context.fillRect(area.left + 8, y - 1, 14, 2);
      context.fillStyle = ink;
      context.fillText(label, area.left + 27, y);
    });
  }
}

/** A curve over the frames as a chart. */
export function curveChart({ name, label, values }, times, title) {
  return {
    name, title: title ?? '', cursor: 'time', x: { label: 'time (s)', log: false }, y: { label, log: false },
    series: [{ kind: 'line', label: '', width: 2, colour: '#0072b2', points: values.map((value, frame) => [times[frame], value]) }],
  };
}
