// Which texts of the repository are pages of the site, and where each of them lies in it.

import { existsSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { dirname, join, normalize, relative } from 'node:path/posix';

/** The folder of the repository. */
export const root = new URL('..', import.meta.url).pathname.replace(/\/$/, '');

/** The text of a file of the repository. */
export const read = (path) => readFileSync(join(root, path), 'utf8');

/** All files below a folder of the repository that a test accepts, by their paths from it, sorted. */
function files(folder, accepts) {
  const found = [];
  for (const entry of readdirSync(join(root, folder), { withFileTypes: true })) {
    const path = `${folder}/${entry.name}`;
    if (entry.isDirectory()) found.push(...files(path, accepts));
    else if (accepts(path)) found.push(path);
  }
  return found.sort();
}

const numbered = (path) => /\/\d{4}-[^/]*\.md$/.test(path);

/** READMEs of experiments, decisions, and what stands at the top, each with its path in the site. */
const experiments = files('experiments', (path) => path.endsWith('/README.md') && !path.includes('/results/'));
const decisions = files('docs/decisions', numbered);
const project = new Map([
  ['README.md', 'project/readme.md'],
  ['docs/architecture.md', 'project/architecture.md'],
  ['docs/benchmarks.md', 'project/benchmarks.md'],
  ['docs/decisions/README.md', 'project/decisions.md'],
  ['CONTRIBUTING.md', 'project/contributing.md'],
  ['CHANGELOG.md', 'project/changelog.md'],
]);

/** Where a file of the repository lies in the site. */
export function placeOf(path) {
  if (path === 'docs/src/SUMMARY.md') return 'introduction.md';
  if (project.has(path)) return project.get(path);
  if (path.startsWith('docs/src/')) return path.slice('docs/src/'.length);
  if (path.startsWith('docs/pictures/')) return path.slice('docs/'.length);
  if (numbered(path)) return path.replace('docs/', 'project/');
  if (/^experiments\/.*\/README\.md$/.test(path)) return `${dirname(path)}.md`;
  return `files/${path}`;
}

/** Every page, by its path in the repository. */
export const pages = [...files('docs/src', (path) => path.endsWith('.md')), ...experiments, ...project.keys(), ...decisions];

/** The contents: those of the book, then experiments and the project. */
export function summary() {
  const title = (path) => read(path).match(/^# (.*)$/m)[1];
  const line = (path, depth = 0) => `${'  '.repeat(depth)}- [${title(path)}](${placeOf(path)})`;
  const inner = (path) => (path === 'docs/decisions/README.md' ? decisions.map((one) => line(one, 1)) : []);
  const others = [...project.keys()].flatMap((path) => [line(path), ...inner(path)]);
  return `${read('docs/src/SUMMARY.md').trimEnd()}\n\n# Experiments\n\n${experiments.map((path) => line(path)).join('\n')}\n\n# Project\n\n${others.join('\n')}\n`;
}

/** A link of a page of the repository as one of the site, and the file that must be there for it, if it is no page. */
export function follow(page, target) {
  if (/^([a-z]+:|#)/i.test(target)) return { target };
  const [path, fragment] = target.split(/(?=#)/);
  let wanted = normalize(join(dirname(page), decodeURI(path))).replace(/\/$/, '');
  if (!existsSync(join(root, wanted))) throw new Error(`${page} leads to ${target}, which is not there`);
  if (statSync(join(root, wanted)).isDirectory()) wanted += '/README.md';
  const place = placeOf(wanted);
  const from = dirname(placeOf(page));
  return { target: `${encodeURI(relative(from, place))}${fragment ?? ''}`, file: wanted.endsWith('.md') ? undefined : wanted, place };
}
