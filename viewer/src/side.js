// The panels at the side: the look, charts, a cell, and where the result comes from.

import { Chart, curveChart } from './charts.js';
import { VIEWS } from './eye.js';
import { about, button, check, choice, element, numbersOf, range, row, tabs } from './panel.js';
import { json } from './source.js';

const byId = (id) => document.getElementById(id);

const LINES = { links: 'Links', linked: 'Links between cells', fibres: 'Fibres', contacts: 'Contacts', traction: 'Tractions', loads: 'Loads' };

export class Side {
  constructor(viewer) {
    this.viewer = viewer;
    this.charts = [];
    byId('title').textContent = viewer.scene.title || 'Pseudopod';
    document.title = `${viewer.scene.title || 'A result'} – Pseudopod`;
    this.tabs = tabs((panel) => this.opened(panel));
    this.look();
    byId('about').append(...about(viewer.scene));
    byId('cell').append(element('p', {}, 'Click a cell to see its numbers and curves.'));
    this.open = 'look';
  }

  look() {
    const { viewer } = this;
    const { scene, state } = viewer;
    const set = (key) => (value) => viewer.set(key, value);
    const parts = [];
    const views = element('div', { className: 'row', role: 'group', 'aria-label': 'Views' });
    for (const name of [...Object.keys(VIEWS), 'document']) views.append(button(name[0].toUpperCase() + name.slice(1), `The ${name === 'document' ? 'view of the document' : `view from the ${name}`}`, () => viewer.view(name)));
    views.append(button('Fit', 'Puts all cells into view (f)', () => viewer.fit()));
    parts.push(element('h2', {}, 'View'), views);
    parts.push(element('div', { className: 'row' }, check('Parallel', state.parallel, set('parallel')), check('Dark', state.theme === 'dark', (dark) => viewer.set('theme', dark ? 'dark' : 'light')), check('Smooth', state.smooth, set('smooth')), check('Title', state.title, set('title')), check('Axes', state.axes, set('axes'))));
    parts.push(element('h2', {}, 'Cells'));
    const colours = [['type', 'Type'], ['id', 'Cell'], ...scene.quantities.map(({ name, label }) => [name, label])];
    parts.push(row('Colour by', choice(colours, state.colour, (value) => this.colour(value))));
    this.ends = ['Lowest', 'Highest'].map((name) => element('input', { type: 'number', step: 'any', 'aria-label': `${name} number of the colours`, onchange: () => this.range() }));
    this.endsRow = element('div', { className: 'row' }, element('label', { for: 'low' }, 'From, to'), ...this.ends, button('Auto', 'The ends of all frames', () => viewer.set('range', undefined).then(() => this.tellEnds())));
    this.ends[0].id = 'low';
    parts.push(this.endsRow);
    parts.push(row('Opacity', range(0.1, 1, 0.05, state.opacity, set('opacity'))));
    const cut = range(-1, 1, 0.01, state.cut ?? 1, (value) => viewer.set('cut', value >= 1 ? undefined : value));
    parts.push(row('Cut', cut));
    parts.push(element('h2', {}, 'Types'), this.types());
    const lines = scene.lines.map((kind) => check(LINES[kind], state.lines.includes(kind), (on) => viewer.set('lines', on ? [...viewer.state.lines, kind] : viewer.state.lines.filter((other) => other !== kind))));
    lines.push(check('Tails', state.tails, set('tails')), check('Marks', state.marks, set('marks')));
    if (scene.obstacles.length) lines.push(check('Planes and tools', state.grid, set('grid')));
    parts.push(element('h2', {}, 'Also shown'), element('div', { className: 'row' }, ...lines));
    if (scene.fields.length) parts.push(...this.fields());
    parts.push(element('h2', {}, 'Keep'));
    parts.push(element('div', { className: 'row' }, button('Save a picture', 'What is seen, as PNG', () => viewer.picture()), button('Save a film', 'All frames as they are seen, as WebM', () => viewer.film()), button('Copy the address', 'The address holds what is seen', () => navigator.clipboard?.writeText(location.href))));
    byId('look').append(...parts);
    this.tellEnds();
  }

  types() {
    const { viewer } = this;
    this.counts = [];
    const list = element('div', { className: 'types' });
    viewer.scene.types.forEach(({ name, colour }, kind) => {
      const count = element('span', { className: 'count' });
      this.counts.push(count);
      const made = check('', !viewer.state.hidden.includes(kind), (shown) => viewer.hide(kind, !shown));
      const swatch = element('span', { className: 'swatch' });
      swatch.style.background = colour;
      made.append(swatch, name, count);
      list.append(made);
    });
    return list;
  }

  fields() {
    const { viewer } = this;
    const { scene, state } = viewer;
    const names = scene.fields.flatMap((field) => field.species.map((species) => [`${field.name}.${species.name}`, species.label]));
    const parts = [element('h2', {}, 'Field'), row('Show', choice([['none', 'None'], ...names], state.field, (value) => viewer.set('field', value)))];
    if (scene.fields.some((field) => field.cells[2] > 1)) {
      parts.push(row('Across', choice([[0, 'x'], [1, 'y'], [2, 'z']], state.axis, (value) => viewer.set('axis', Number(value)))));
      parts.push(row('At', range(0, 1, 0.005, state.share, (value) => viewer.set('share', value))));
    }
    parts.push(row('Opacity', range(0.1, 1, 0.05, state.alpha, (value) => viewer.set('alpha', value))));
    parts.push(element('div', { className: 'row' }, check('Colours in powers of ten', state.decades, (value) => viewer.set('decades', value))));
    return parts;
  }

  async colour(value) {
    await this.viewer.set('colour', value);
    this.tellEnds();
  }

  tellEnds() {
    const { state, colours: { scale } } = this.viewer;
    this.endsRow.hidden = state.colour === 'type' || state.colour === 'id';
    if (scale) scale.ends.forEach((end, k) => { this.ends[k].value = String(Number(end.toPrecision(5))); });
  }

  range() {
    const ends = this.ends.map((end) => Number(end.value));
    if (ends[0] < ends[1]) this.viewer.set('range', ends);
  }

  opened(panel) {
    this.open = panel;
    if (panel === 'charts' && !this.charts.length) this.makeCharts();
    this.settled();
  }

  async makeCharts() {
    const { viewer } = this;
    const panel = byId('charts');
    panel.replaceChildren();
    this.charts = [];
    for (const { name } of viewer.scene.charts) {
      const found = await json(viewer.source, `chart/${name}`);
      if (found) this.charts.push(new Chart(panel, found));
    }
    if (viewer.scene.series.length) {
      const options = [['', '…'], ...viewer.scene.series.map(({ name, label }) => [name, label])];
      const more = element('div');
      panel.append(row('Another', choice(options, '', async (name) => {
        const found = name && await json(viewer.source, `curve/${name}`);
        more.replaceChildren();
        if (found) {
          this.more = new Chart(more, curveChart(found, this.times(), found.label));
          this.settled();
        }
      })), more);
    } else if (!this.charts.length) panel.append(element('p', {}, 'The document asks for no charts.'));
    this.settled();
  }

  /** The times of the frames of the result, of which a film may have some only. */
  times() {
    const { course } = this.viewer;
    return course.all ?? course.times;
  }

  /** The result has more frames. */
  grown() {
    if (this.open === 'charts') this.makeCharts();
    else this.charts = [];
    if (this.viewer.state.cell !== undefined && this.open === 'cell') this.cell();
  }

  /** A frame is drawn. */
  settled() {
    const { viewer } = this;
    const { course, state } = viewer;
    viewer.cells.counts?.forEach((count, kind) => { if (this.counts[kind]) this.counts[kind].textContent = String(count); });
    const number = course.numbers?.[state.frame] ?? state.frame;
    if (this.open === 'charts') for (const chart of [...this.charts, this.more]) chart?.draw(number, viewer.time);
    const { cell } = state;
    const { ids } = viewer.cells.frame;
    viewer.cells.shared.chosen.value = cell === undefined ? -1 : ids.indexOf(cell);
    if (this.open === 'cell' && cell !== undefined && !viewer.live) this.numbers();
  }

  /** Shows the numbers of the chosen cell. */
  async cell(isNew = false) {
    const { viewer } = this;
    if (viewer.state.cell === undefined) {
      byId('cell').replaceChildren(element('p', {}, 'Click a cell to see its numbers and curves.'));
      this.settled();
      viewer.dirty();
      return;
    }
    if (isNew) this.tabs.show('cell');
    await this.curve();
    await this.numbers();
    viewer.dirty();
  }

  async numbers() {
    const { viewer } = this;
    const { cell, frame, number } = viewer.state;
    const found = await this.numbersIn(cell, frame);
    if (cell !== viewer.state.cell || frame !== viewer.state.frame) return;
    const panel = byId('cell');
    if (!found) {
      panel.replaceChildren(element('p', {}, `Cell ${cell} is not there in this frame.`));
      return;
    }
    const parent = found.parent === null || found.parent === undefined ? '' : `, born from ${found.parent}`;
    const head = element('h2', {}, `Cell ${cell} (${found.type}${parent})`);
    const table = numbersOf(found, number, (name) => {
      viewer.state.number = name;
      viewer.keep();
      this.cell();
    });
    panel.replaceChildren(head, ...(this.curveOf ? [this.curveOf.figure] : []), table);
    this.curveOf?.draw(viewer.course.numbers?.[frame] ?? frame, viewer.time);
  }

  /** The numbers of a cell: as the program tells them, or those that stand in the page. */
  async numbersIn(cell, frame) {
    const { source, scene, cells } = this.viewer;
    const told = source.isServed ? await json(source, `cell/${frame}/${cell}`) : undefined;
    if (told || source.isServed) return told;
    const at = cells.frame.ids.indexOf(cell);
    if (at < 0) return undefined;
    const numbers = [];
    for (const { name, label } of scene.quantities.filter(({ of }) => of === 'cells')) {
      const bytes = await source.bytes(`values/${frame}/${name}`);
      if (bytes) numbers.push({ name, label, value: new Float32Array(bytes)[at] });
    }
    return { type: scene.types[cells.frame.kinds[at]].name, numbers };
  }

  /** The curve of the chosen number of the chosen cell. */
  async curve() {
    const { viewer } = this;
    const { cell, number } = viewer.state;
    this.curveOf = undefined;
    if (!number) return;
    const found = viewer.source.isServed ? await json(viewer.source, `curve/${number}/${cell}`) : await this.curveIn(cell, number);
    if (found) this.curveOf = new Chart(element('div'), curveChart(found, viewer.course.times, found.label));
  }

  async curveIn(cell, name) {
    const { source, scene, frames, tails } = this.viewer;
    const about = scene.quantities.find((quantity) => quantity.name === name && quantity.of === 'cells');
    if (!about) return undefined;
    const values = [];
    for (let frame = 0; frame < frames; frame += 1) {
      const at = [...(await tails.of(frame)).keys()].indexOf(cell);
      const bytes = await source.bytes(`values/${frame}/${name}`);
      values.push(at < 0 || !bytes ? null : new Float32Array(bytes)[at]);
    }
    return { name, label: about.label, values };
  }
}
