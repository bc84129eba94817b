// What is written over the view: title, time, scale bar, axes, and what colours mean. A picture that is saved has it, too.

import { nice } from './scenery.js';
import { isConstant, short, ticks } from './words.js';

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
  axes(context, w - 44, h - 44, what.axes, ink);
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

function axes(context, x, y, directions, ink) {
  context.lineWidth = 1.5;
  context.font = `11px ${FONT}`;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  ['x', 'y', 'z'].forEach((name, axis) => {
    const [dx, dy] = directions[axis];
    context.strokeStyle = ['#c0392b', '#2e8b57', '#2a6fbb'][axis];
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + 24 * dx, y - 24 * dy);
    context.stroke();
    context.fillStyle = ink;
    if (Math.hypot(dx, dy) > 0.15) context.fillText(name, x + 32 * dx, y - 32 * dy);
  });
  context.textBaseline = 'alphabetic';
}

/** A bar of colours with round numbers, its label above. */
function bar(context, right, top, height, { colours, ends: [low, high], label }, ink, write) {
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
  for (const tick of ticks(low, high, 5)) {
    const y = top + height * (1 - (tick - low) / (high - low));
    context.fillRect(x - 4, y - 0.5, 4, 1);
    write(short(tick), x - 7, y + 4, 'right', '12px');
  }
}
