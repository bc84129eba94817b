// Makes the site: node make.mjs OUT MDBOOK. OUT/src are the texts as mdBook takes them, OUT/html the pages.

import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { relative as relativePath } from 'node:path/posix';
import { fileURLToPath } from 'node:url';
import { hide, refer, show, tell } from './formulas.mjs';
import { follow, pages, placeOf, read, root, summary } from './pages.mjs';

const [out, mdbook] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const [source, site] = [join(out, 'src'), join(out, 'html')];

function write(path, text) {
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(path, text);
}

/** The text of a page with its links as those of the site; what they lead to that is no page is copied. */
function linked(page) {
  const files = new Set();
  const text = read(page).replace(/\]\(([^()\s]+)\)/g, (whole, target) => {
    const { target: there, file, place } = follow(page, target);
    if (file && !files.has(file)) {
      files.add(file);
      mkdirSync(dirname(join(source, place)), { recursive: true });
      cpSync(join(root, file), join(source, place));
    }
    return `](${there})`;
  });
  return text;
}

/** What was made of an experiment besides its picture: a page that plays it, and a film. */
function played(text) {
  return text.replace(/^\*\*\[([\w]+)\]\([^)]*\)\*\*.*$/gm, (line, name) => {
    const links = [['live', 'html', 'in the browser'], ['films', 'gif', 'as a film']]
      .filter(([folder, ending]) => existsSync(join(out, folder, `${name}.${ending}`)))
      .map(([folder, ending, words]) => `[${words}](${folder}/${name}.${ending})`);
    return links.length ? `${line} Look at it ${links.join(' or ')}.` : line;
  });
}

rmSync(source, { recursive: true, force: true });
rmSync(site, { recursive: true, force: true });
const numbers = new Map();
const texts = new Map();
for (const page of pages.filter((page) => page !== 'docs/src/SUMMARY.md')) texts.set(page, hide(linked(page), placeOf(page), numbers));
const between = (page, other) => relativePath(dirname(placeOf(page)), other);
for (const [page, text] of texts) {
  const referred = refer(text, page, numbers, between);
  write(join(source, placeOf(page)), page === 'docs/src/gallery.md' ? played(referred) : referred);
}
write(join(source, 'SUMMARY.md'), summary());
cpSync(join(here, 'book.toml'), join(out, 'book.toml'));
cpSync(join(here, 'style.css'), join(out, 'style.css'));

const made = spawnSync(mdbook, ['build', out], { encoding: 'utf8' });
const said = `${made.stdout ?? ''}${made.stderr ?? ''}`;
if (made.status !== 0 || /\b(WARN|ERROR)\b/.test(said)) {
  console.error(said || made.error);
  process.exit(1);
}

/** All files below a folder. */
function all(folder) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => (entry.isDirectory() ? all(join(folder, entry.name)) : [join(folder, entry.name)]));
}
let formulas = 0;
for (const path of all(site)) {
  if (path.endsWith('.html')) {
    const { html, count } = show(readFileSync(path, 'utf8'));
    formulas += count;
    const style = `${relativePath(dirname(path), site) || '.'}/katex/katex.min.css`;
    if (count) writeFileSync(path, html.replace('<head>', `<head><link rel="stylesheet" href="${style}">`));
  } else if (/searchindex[^/]*\.js(on)?$/.test(path)) {
    writeFileSync(path, tell(readFileSync(path, 'utf8')));
  }
}
const katex = join(here, 'node_modules/katex/dist');
cpSync(join(katex, 'katex.min.css'), join(site, 'katex/katex.min.css'));
for (const font of readdirSync(join(katex, 'fonts')).filter((name) => name.endsWith('.woff2'))) {
  mkdirSync(join(site, 'katex/fonts'), { recursive: true });
  cpSync(join(katex, 'fonts', font), join(site, 'katex/fonts', font));
}
for (const folder of ['live', 'films']) {
  if (existsSync(join(out, folder))) cpSync(join(out, folder), join(site, folder), { recursive: true });
}
console.log(`${texts.size} pages, ${numbers.size} numbered formulas, ${formulas} formulas drawn: ${join(site, 'index.html')}`);
