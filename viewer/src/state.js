// What can be chosen of what is seen: as the document asks for it, and as the address says.

import { fromAddress } from './address.js';

/** The state that the page begins with. */
export function stateOf(scene) {
  const look = scene.look;
  const hasFibres = scene.lines.includes('fibres') && look.fibres;
  const hasLinked = scene.lines.includes('linked') && look.links;
  const kept = fromAddress();
  const isDark = window.matchMedia('(prefers-color-scheme: dark)').matches;
  const field = scene.fields.flatMap((field) => field.species.map((species) => `${field.name}.${species.name}`));
  const named = field.find((name) => name === look.field || name.startsWith(`${look.field}.`)) ?? field[0];
  // What the page finds by itself: links within cells, and cells by their ids.
  if (scene.types.some((type) => type.links.length)) scene.lines.unshift('links');
  const known = (name) => name === 'type' || name === 'id' || scene.quantities.some((quantity) => quantity.name === name);
  return {
    frame: 0, colour: known(look.colour_by) ? look.colour_by : 'type', range: look.range ?? undefined,
    field: look.field === 'none' ? 'none' : named ?? 'none', axis: 2, share: 0.5, alpha: 1, decades: look.field_log,
    lines: [scene.lines.includes('links') && 'links', hasLinked && 'linked', hasFibres && 'fibres', look.loads && scene.lines.includes('loads') && 'loads'].filter(Boolean),
    opacity: hasFibres || hasLinked || scene.lines.includes('links') ? 0.35 : 1, cut: undefined, hidden: [], tails: false, parallel: true, theme: isDark ? 'dark' : 'light',
    cell: undefined, number: undefined, marks: Boolean(look.marks), grid: true, title: true, axes: true, smooth: true,
    ...kept,
  };
}
