// Keys and the pointer: time, views, and the choice of a cell.

import { VIEWS } from './eye.js';
import { cellAt } from './pick.js';

/** Lets keys and the pointer act on a viewer. */
export function listen(viewer) {
  let down;
  viewer.canvas.addEventListener('pointerdown', (event) => { down = [event.clientX, event.clientY]; });
  viewer.canvas.addEventListener('pointerup', (event) => {
    if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4 && event.button === 0) viewer.choose(cellAt(viewer, event.clientX, event.clientY));
    down = undefined;
  });
  const turn = 0.1;
  const keys = {
    ' ': () => viewer.transport.toggle(), ArrowLeft: () => viewer.transport.go(viewer.state.frame - 1), ArrowRight: () => viewer.transport.go(viewer.state.frame + 1),
    Home: () => viewer.transport.go(0), End: () => viewer.transport.go(viewer.frames - 1), f: () => viewer.fit(), 0: () => viewer.view('document'),
    '+': () => viewer.eye.zoom(1.15), '=': () => viewer.eye.zoom(1.15), '-': () => viewer.eye.zoom(1 / 1.15),
    a: () => viewer.eye.turn(-turn, 0), d: () => viewer.eye.turn(turn, 0), w: () => viewer.eye.turn(0, turn), s: () => viewer.eye.turn(0, -turn),
  };
  Object.keys(VIEWS).forEach((name, k) => { keys[k + 1] = () => viewer.view(name); });
  document.addEventListener('keydown', (event) => {
    const isTyping = event.target.closest('input[type="number"], select, button, [role="tab"], tr') && event.key === ' ';
    const isSlider = event.target.closest('input, select') && event.key !== ' ';
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping || isSlider || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });
}
