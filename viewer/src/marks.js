// What is written over the view: title, time, scale bar, axes, and what colours mean. A picture that is saved has it, too.

import { nice } from './scenery.js';
import { isConstant, powers, short, ticks } from './words.js';

const FONT = 'system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif';

/** Draws the marks for `what` into a context of so many pixels, `scale` of the screen's for each of the page's. */
export function drawMarks(context, width, height, scale, what) {
  const ink = what.dark ? '#e6e9ee' : '#1c2026';
  context.setTransform(scale, 0, 0, scale, 0, 0);
  const [w, h] = [width / scale, height / scale];
  context.clearRect(0, 0, w, h);
  context.fillStyle = ink;
  context.strokeStyle = ink;
  context.textBaseline = 'alphabetic';
  const write = (text, x, y, align = 'left', font = '13px') => {
    context.font = `${font} ${FONT}`;
    context.textAlign = align;
    // Read on whatever is behind it.
    context.lineJoin = 'round';
    context.lineWidth = 3;
    context.strokeStyle = what.dark ? 'rgba(20, 23, 28, 0.75)' : 'rgba(255, 255, 255, 0.75)';
    context.strokeText(text, x, y);
    context.fillStyle = ink;
    context.fillText(text, x, y);
  };
  if (what.title) write(what.title, 16, 26, 'left', '600 15px');
  write(what.time, w - 16, 26, 'right', '14px');
  // A bar of a round length, about a fifth of the width.
  const perMicron = what.perMicron;
  if (what.bar && perMicron > 0) {
    const length = nice((0.12 * w) / perMicron);
    const x = 18;
    context.fillRect(x, h - 22, length * perMicron, 4);
    write(length < 1 ? `${Number((1000 * length).toPrecision(3))} nm` : `${Number(length.toPrecision(3))} µm`, x, h - 29);
  }
  if (what.axes) axes(context, w - 44, h - 44, what.axes, write);
  context.fillStyle = ink;
  let top = 48;
  if (what.names.length > 1 && !what.scale) {
    for (const { name, colour, count } of what.names.slice(0, 14)) {
      context.fillStyle = colour;
      context.fillRect(16, top - 10, 11, 11);
      context.fillStyle = ink;
      write(`${name} (${count})`, 33, top);
      top += 19;
    }
  }
  let x = w - 26;
  for (const scale_ of [what.scale, what.field].filter(Boolean)) {
    bar(context, x, 56, Math.min(180, h - 180), scale_, ink, write);
    x -= 92;
  }
}

/** Which way x, y and z go: lines with letters, as in pictures that `render` makes. */
function axes(context, x, y, all, write) {
  const rim = context.strokeStyle;
  const away = ([right, up], far) => {
    const length = Math.max(Math.hypot(right, up), 1e-9);
    return [(right * far) / length, (up * far) / length];
  };
  // What points away is drawn first.
  for (const { name, colour, end: [right, up] } of [...all].sort((one, other) => one.end[2] - other.end[2])) {
    const length = Math.hypot(right, up);
    const isEndOn = length < 0.15;
    context.lineCap = 'round';
    for (const [paint, wide] of [[rim, 5], [colour, 2]]) {
      context.strokeStyle = context.fillStyle = paint;
      context.lineWidth = wide;
      context.beginPath();
      if (isEndOn) context.arc(x, y, 2 + wide / 2, 0, 2 * Math.PI);
      else {
        context.moveTo(x, y);
        context.lineTo(x + 24 * right, y - 24 * up);
      }
      if (isEndOn) context.fill();
      else context.stroke();
    }
    // The letter of a dot stands where the other lines are not.
    const sum = [0, 1].map((part) => all.reduce((so_far, axis) => so_far + axis.end[part], 0));
    const [across, above] = isEndOn ? away([right - sum[0], up - sum[1]], 12) : away([right, up], 24 * length + 9);
    write(name, x + across, y - above + 4, 'center', '12px');
  }
  context.lineCap = 'butt';
}

/** A bar of colours with round numbers, its label above. */
function bar(context, right, top, height, { colours, ends: [low, high], label, isLog }, ink, write) {
  const [x, width] = [right - 12, 12];
  const colour = (share) => `rgb(${colours[Math.round(share * (colours.length - 1))].join(',')})`;
  write(label, right, top - 12, 'right', '12px');
  if (isConstant([low, high])) {
    context.fillStyle = colour(0.5);
    context.fillRect(x, top, width, 18);
    context.fillStyle = ink;
    write(`${short(low)} everywhere`, x - 6, top + 13, 'right', '12px');
    return;
  }
  for (let row = 0; row < height; row += 1) {
    context.fillStyle = colour(1 - row / (height - 1));
    context.fillRect(x, top + row, width, 1.5);
  }
  context.fillStyle = ink;
  const bend = isLog ? Math.log : (value) => value;
  for (const tick of (isLog ? powers : ticks)(low, high, 5)) {
    const y = top + height * (1 - (bend(tick) - bend(low)) / (bend(high) - bend(low)));
    context.fillRect(x - 4, y - 0.5, 4, 1);
    write(short(tick), x - 7, y + 4, 'right', '12px');
  }
}
