// Holds every link of the site: node links.mjs SITE. Files are there, anchors too, no page loads from elsewhere, and no mark is left over.

import { existsSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { dirname, join, normalize } from 'node:path';

const site = process.argv[2];
const all = (folder) => readdirSync(folder, { withFileTypes: true }).flatMap((entry) => (entry.isDirectory() ? all(join(folder, entry.name)) : [join(folder, entry.name)]));
const ids = new Map();
const idsOf = (path) => {
  if (!ids.has(path)) ids.set(path, new Set([...readFileSync(path, 'utf8').matchAll(/\sid="([^"]+)"/g)].map((found) => found[1])));
  return ids.get(path);
};
const plain = (text) => text.replaceAll('&amp;', '&').replaceAll('&#x2F;', '/').replaceAll('&quot;', '"').replaceAll('&#39;', "'");

const faults = [];
let links = 0;
// The page of all pages has links of the others; pages to mail carry everything and lead nowhere.
const pages = all(site).filter((path) => path.endsWith('.html') && !/\/(print|404|toc)\.html$/.test(path) && !path.startsWith(join(site, 'live')));
for (const path of pages) {
  const html = readFileSync(path, 'utf8');
  const name = path.slice(site.length + 1);
  if (/PPFORMULA|\$\$|\\\\\(/.test(html.replace(/<code[\s\S]*?<\/code>/g, ''))) faults.push(`${name}: a formula was not drawn`);
  for (const [, attribute, written] of html.matchAll(/\s(href|src)="([^"]*)"/g)) {
    const target = plain(written);
    if (/^(mailto:|data:|javascript:)/.test(target)) continue;
    if (/^[a-z]+:\/\//i.test(target)) {
      if (attribute === 'src') faults.push(`${name} loads ${target}`);
      continue;
    }
    links += 1;
    const [file, fragment] = target.split('#');
    let there = file === '' ? path : normalize(join(dirname(path), decodeURI(file.split('?')[0])));
    if (existsSync(there) && statSync(there).isDirectory()) there = join(there, 'index.html');
    if (!existsSync(there)) faults.push(`${name} leads to ${target}, which is not there`);
    else if (fragment && there.endsWith('.html') && !idsOf(there).has(decodeURI(fragment))) faults.push(`${name} leads to ${target}, and there is no such heading`);
  }
}
if (faults.length) {
  console.error([...new Set(faults)].sort().join('\n'));
  process.exit(1);
}
console.log(`${links} links of ${pages.length} pages lead somewhere`);
