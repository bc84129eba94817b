// The controls at the side. Each has a label, and can be reached and used from the keyboard.

import { short } from './words.js';

/** An element with properties and children. */
export function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key.includes('-') || key === 'for' || key === 'role') made.setAttribute(key, value);
    else made[key] = value;
  }
  made.append(...children.filter((child) => child !== undefined));
  return made;
}

let numbers = 0;

/** A row with a label and a control. */
export function row(label, control, ...more) {
  numbers += 1;
  control.id ||= `control-${numbers}`;
  return element('div', { className: 'row' }, element('label', { for: control.id }, label), control, ...more);
}

export function choice(options, value, changed) {
  const made = element('select', { onchange: () => changed(made.value) });
  for (const [key, label] of options) made.append(element('option', { value: key, selected: key === value }, label));
  made.value = value;
  return made;
}

export function check(label, value, changed) {
  const box = element('input', { type: 'checkbox', checked: value, onchange: () => changed(box.checked) });
  return element('label', {}, box, ` ${label}`);
}

export function range(low, high, step, value, changed) {
  const made = element('input', { type: 'range', min: low, max: high, step, value, oninput: () => changed(Number(made.value)) });
  return made;
}

export function button(label, title, pressed) {
  return element('button', { type: 'button', title, onclick: pressed }, label);
}

/** Tabs, of which one is shown; arrows go from one to the next. */
export function tabs(changed) {
  const all = [...document.querySelectorAll('[role="tab"]')];
  const choose = (tab) => {
    for (const other of all) {
      other.setAttribute('aria-selected', String(other === tab));
      other.tabIndex = other === tab ? 0 : -1;
      document.getElementById(other.getAttribute('aria-controls')).hidden = other !== tab;
    }
    changed(tab.getAttribute('aria-controls'));
  };
  all.forEach((tab, number) => {
    tab.onclick = () => choose(tab);
    tab.onkeydown = (event) => {
      const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!by) return;
      event.stopPropagation();
      const next = all[(number + by + all.length) % all.length];
      next.focus();
      choose(next);
    };
  });
  return { show: (name) => choose(all.find((tab) => tab.getAttribute('aria-controls') === name)) };
}

/** The numbers of a cell as a table, of which one is chosen for a curve. */
export function numbersOf(cell, chosen, choose) {
  const body = element('tbody');
  for (const { name, label, value } of cell.numbers) {
    const made = element('tr', { className: name === chosen ? 'pick chosen' : 'pick', tabIndex: 0 }, element('td', { title: name }, label), element('td', {}, short(value)));
    made.onclick = () => choose(name);
    made.onkeydown = (event) => {
      if (event.key === 'Enter') choose(name);
    };
    body.append(made);
  }
  return element('table', { 'aria-label': 'Numbers of the cell; choose one for its curve' }, body);
}

/** Where the result comes from. */
export function about(scene) {
  const facts = [
    ['Document', scene.document], ['Seed', scene.seed], ['Version', `${scene.version} (${scene.commit})`], ['Begun', scene.started],
    ['Settings', scene.sets.join(', ')],
  ];
  const list = element('dl');
  for (const [name, value] of facts) if (value) list.append(element('dt', {}, name), element('dd', {}, value));
  const texts = [[scene.document, scene.experiment], ...scene.equations];
  const shown = texts.map(([name, text]) => element('details', { open: texts.length === 1 }, element('summary', {}, name), element('pre', {}, text)));
  const keys = [
    ['space', 'play, pause'], ['← →', 'a frame back, on'], ['Home End', 'first, last frame'], ['1 … 6', 'front, back, left, right, top, bottom'], ['0', 'the view of the document'],
    ['f', 'all of it'], ['+ −', 'nearer, farther'], ['w a s d', 'turn'],
  ];
  const help = element('dl');
  for (const [key, what] of keys) help.append(element('dt', {}, element('kbd', {}, key)), element('dd', {}, what));
  return [list, ...shown, element('h2', {}, 'Keys'), help];
}
