// The site as a reader has it, opened from the disk in Chromium: BOOK names its folder.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { openBrowser } from '../../viewer/tests/browser.mjs';

const site = process.env.BOOK ?? new URL('../../target/book/html', import.meta.url).pathname;
let browser;
before(async () => { browser = await openBrowser(); });
after(() => browser?.close());

/** A page, and what it asked for or complained of. */
async function open(path, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1200, height: 900 }, ...options });
  const page = await context.newPage();
  page.faults = [];
  page.on('pageerror', (error) => page.faults.push(String(error)));
  page.on('request', (request) => { if (!/^(file|data|blob):/.test(request.url())) page.faults.push(`asked for ${request.url()}`); });
  page.on('requestfailed', (request) => page.faults.push(`did not get ${request.url()}`));
  await page.goto(pathToFileURL(join(site, path)).href);
  return page;
}

test('the first page has contents that lead to every other', async () => {
  const page = await open('index.html');
  await page.waitForSelector('.sidebar .chapter a');
  const links = await page.$$eval('.sidebar .chapter a', (all) => all.map((link) => link.textContent.trim()));
  for (const title of ['Getting started', 'Gallery', 'Documents', 'The step', 'Architecture']) assert.ok(links.some((link) => link.endsWith(title)), `${title} of ${links.length}`);
  assert.equal(await page.title(), 'Introduction - Pseudopod');
  assert.deepEqual(page.faults, []);
});

test('the search finds a page by its words', async () => {
  const page = await open('index.html');
  await page.click('#mdbook-search-toggle');
  await page.locator('#mdbook-searchbar').pressSequentially('haptotaxis');
  // Either the last key finds it, or the index does once it is there.
  await page.waitForSelector('#mdbook-searchresults a', { timeout: 60_000 });
  const found = await page.$$eval('#mdbook-searchresults a', (all) => all.map((link) => link.getAttribute('href')));
  assert.ok(found.some((link) => link.includes('experiments/haptotaxis')), found.join('\n'));
  assert.ok(!(await page.textContent('#mdbook-searchresults')).includes('PPFORMULA'));
  assert.deepEqual(page.faults, []);
});

test('formulas are drawn in their font and can be led to by their number', async () => {
  const page = await open('adhesion.html');
  const first = await page.$('.katex-display .katex');
  const box = await first.boundingBox();
  assert.ok(box.width > 60 && box.height > 20, JSON.stringify(box));
  assert.ok(await page.evaluate(() => document.fonts.ready.then(() => document.fonts.check('16px KaTeX_Main'))));
  const covered = await page.$$eval('.katex-display .katex-tag', (all) => all.filter((tag) => {
    const [own, parts] = [tag.getBoundingClientRect(), [...tag.parentElement.querySelectorAll('.katex-base')].map((part) => part.getBoundingClientRect())];
    return parts.some((part) => part.right > own.left + 2 && part.left < own.right && part.bottom > own.top + 2 && part.top < own.bottom - 2);
  }).map((tag) => tag.textContent));
  assert.deepEqual(covered, [], 'numbers that lie over their formulas');
  await page.goto(pathToFileURL(join(site, 'viscosity.html')).href);
  const link = await page.$('main a[href*="step.html#eq-"]');
  assert.ok(link, 'a formula of another page is led to');
  await link.click();
  await page.waitForURL(/step\.html#eq-step-/);
  await page.waitForFunction(() => document.getElementById(location.hash.slice(1))?.querySelector('.katex-tag'));
  assert.deepEqual(page.faults, []);
});

test('every picture of the gallery is there and none is wider than a telephone', async () => {
  const page = await open('gallery.html', { viewport: { width: 390, height: 800 } });
  await page.evaluate(() => Promise.all([...document.images].map((image) => { image.loading = 'eager'; return image.decode(); })));
  const pictures = await page.$$eval('main img', (all) => all.map((image) => ({ name: image.src, there: image.naturalWidth, alt: image.alt, width: image.getBoundingClientRect().width })));
  assert.ok(pictures.length >= 40, `${pictures.length} pictures`);
  for (const { name, there, alt, width } of pictures) assert.ok(there > 0 && alt && width <= 390, name);
  assert.deepEqual(page.faults, []);
});

test('an experiment that was run can be played from the gallery', async (context) => {
  if (!existsSync(join(site, 'live/chemotaxis.html'))) return context.skip('made without --live chemotaxis');
  const page = await open('gallery.html');
  await page.click('a[href="live/chemotaxis.html"]');
  await page.waitForFunction(() => window.pseudopod?.drawn.frame !== undefined, null, { timeout: 60_000 });
  assert.deepEqual(page.faults, []);
  const film = await open('films/chemotaxis.gif');
  assert.ok(await film.evaluate(() => document.images[0].naturalWidth > 300));
});
