// The page in a real browser: served, from the disk, and beside a run that goes on.

import assert from 'node:assert/strict';
import { readFile, stat, writeFile } from 'node:fs/promises';
import http from 'node:http';
import { after, before, describe, test } from 'node:test';
import { folder, openBrowser, openPage, pixels, run, serve } from './browser.mjs';

const DOCUMENT = `
title = "Two cells on glass"
seed = 7

[run]
until = "60 s"

[output]
every = "2 s"

[[planes]]
name = "glass"
point = ["0 um", "0 um", "0 um"]
normal = [0, 0, 1]

[cells.left]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["-8 um", "0 um", "6 um"]] }

[cells.left.mechanics]
drag = "20 pN s/um"
shape_memory = { stiffness = "4 pN/um" }

[cells.left.motility]
brownian = { speed = "12 um/min", persistence = "1 min" }

[cells.right]
mesh = { shape = "icosphere", radius = "4 um", level = 1 }
placement = { at = [["8 um", "0 um", "6 um"]] }

[cells.right.mechanics]
drag = "20 pN s/um"
shape_memory = { stiffness = "4 pN/um" }

[cells.right.motility]
brownian = { speed = "12 um/min", persistence = "1 min" }

[[plot]]
name = "energy"
kind = "series"
y = "energy"
`;

let [browser, files, result] = [];

before(async () => {
  browser = await openBrowser();
  files = await folder();
  await writeFile(files.file('two.toml'), DOCUMENT);
  result = files.file('two.h5');
  const made = await run('run', files.file('two.toml'), '-o', result, '--no-pictures', '--quiet');
  assert.equal(made.code, 0, made.err);
});

after(async () => {
  await browser?.close();
  await files?.remove();
});

/** What holds of the page wherever it comes from. */
async function looks(page, served) {
  assert.equal(await page.textContent('#title'), 'Two cells on glass');
  assert.equal(await page.textContent('#message'), '');
  assert.match(await page.textContent('#clock'), /t = 0\.0 s · frame 1 of 31/);
  const seen = await pixels(page);
  assert.ok(seen.unlike > 0.02 && seen.bluish > 0.005, `cells are seen: ${JSON.stringify(seen)}`);

  // Time goes on by keys, and the cells with it.
  await page.focus('#view');
  await page.keyboard.press('End');
  await page.waitForFunction(() => window.pseudopod.drawn.frame === 30);
  assert.match(await page.textContent('#clock'), /t = 60\.0 s · frame 31 of 31/);
  await page.keyboard.press('Home');
  await page.waitForFunction(() => window.pseudopod.drawn.frame === 0);
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction(() => window.pseudopod.drawn.frame === 1);
  await page.selectOption('#speed', '60');
  await page.keyboard.press('Space');
  await page.waitForFunction(() => window.pseudopod.drawn.frame > 5, null, { timeout: 20_000 });
  await page.keyboard.press('Space');

  // A type that is hidden is not seen; both hidden leave the plane.
  const both = await pixels(page);
  await page.getByLabel('left', { exact: false }).first().uncheck();
  const one = await pixels(page);
  assert.ok(one.bluish < 0.6 * both.bluish, `${one.bluish} of ${both.bluish}`);
  await page.getByLabel('left', { exact: false }).first().check();

  // Colours by a number, with its bar.
  await page.getByLabel('Colour by').selectOption('position_x');
  await page.waitForFunction(() => window.pseudopod.colours.scale?.label.startsWith('position x'));
  const ends = await page.evaluate(() => window.pseudopod.colours.scale.ends);
  assert.ok(ends[0] < -5 && ends[1] > 5, String(ends));

  // A cell that is clicked tells its numbers, which are those of the frame.
  await page.keyboard.press('Home');
  await page.evaluate(() => { window.pseudopod.transport.go(0); window.pseudopod.view('front'); });
  await page.waitForFunction(() => window.pseudopod.drawn.frame === 0);
  const at = await page.evaluate(() => {
    const viewer = window.pseudopod;
    viewer.draw();
    const [x, y, z] = viewer.cells.centre(1);
    const point = viewer.eye.controls.target.clone().set(x, y, z).project(viewer.eye.camera);
    const { left, top, width, height } = viewer.canvas.getBoundingClientRect();
    return [left + (0.5 + 0.5 * point.x) * width, top + (0.5 - 0.5 * point.y) * height];
  });
  await page.mouse.click(...at);
  await page.getByText('Cell 1 (right)').waitFor();
  const row = page.locator('#cell tr', { hasText: 'position x' });
  assert.match(await row.locator('td').nth(1).textContent(), /^8(\.0\d*)?$/);
  await row.click();
  await page.locator('#cell canvas').waitFor();

  // Charts follow the frame, and say so to those who do not see them.
  await page.getByRole('tab', { name: 'Charts' }).click();
  await page.locator('#charts canvas').first().waitFor();
  await page.waitForFunction(() => document.querySelector('#charts canvas').getAttribute('aria-label')?.includes('elastic energy'));

  await page.getByRole('tab', { name: 'About' }).click();
  assert.match(await page.textContent('#about'), /speed = "12 um\/min"/);

  // The address keeps what is seen.
  await page.waitForTimeout(400);
  const again = await openPage(browser, page.url());
  assert.equal(await again.evaluate(() => window.pseudopod.state.colour), 'position_x');
  assert.equal(await again.evaluate(() => window.pseudopod.state.cell), 1);
  const kept = await again.evaluate(() => window.pseudopod.eye.kept());
  (await page.evaluate(() => window.pseudopod.eye.kept())).forEach((part, k) => assert.ok(Math.abs(part - kept[k]) < 1e-3 * (1 + Math.abs(part)), `${k}: ${part} ${kept[k]}`));
  await again.context().close();

  // A picture is kept as a file of its own size.
  await page.getByRole('tab', { name: 'Look' }).click();
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save a picture' }).click()]);
  assert.equal(download.suggestedFilename(), 'Two_cells_on_glass.png');
  const png = await readFile(await download.path());
  assert.equal(png.subarray(1, 4).toString(), 'PNG');
  assert.equal(png.readUInt32BE(16), await page.evaluate(() => window.pseudopod.canvas.width));

  // Everything that can be used has a name.
  const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, select, [role="tab"], canvas:not([aria-hidden])')]
    .filter((control) => !(control.getAttribute('aria-label') || control.labels?.[0]?.textContent.trim() || control.textContent.trim() || control.title))
    .map((control) => control.outerHTML));
  assert.deepEqual(nameless, []);

  assert.deepEqual(page.errors, []);
  const elsewhere = page.requests.filter((url) => !(served ? url.startsWith(served) : url.startsWith('file:')) && !/^(data|blob):/.test(url));
  assert.deepEqual(elsewhere, [], 'nothing is asked for from elsewhere');
}

test('a result that is served', { timeout: 120_000 }, async () => {
  const server = await serve('view', result);
  const page = await openPage(browser, server.address);
  await looks(page, server.address);
  await page.context().close();
  assert.equal((await server.stop()).code, 0);
});

const LINKED = `
title = "Linked cells"
[run]
until = "20 s"
integrator = { max_step = "1 s" }
[output]
every = "2 s"
[cells.a]
mesh = { shape = "icosphere", radius = "5 um", level = 0 }
placement = { at = [["-6 um", "0 um", "0 um"], ["6 um", "0 um", "0 um"]] }
[cells.a.mechanics]
drag = "20 pN s/um"
shape_memory = { stiffness = "6 pN/um" }
[cells.a.motility]
attraction = { to = ["0 um", "0 um", "0 um"], stiffness = "0.1 pN/um" }
[contact]
model = "links"
[[contact.between]]
types = ["a", "a"]
link = "2 pN/um"
[picture]
links = true
`;

/** How many pixels of what is written over the view have nearly a colour. */
const marked = (page, colour) => page.evaluate((colour) => {
  const { marks } = window.pseudopod;
  const { data } = marks.getContext('2d').getImageData(0, 0, marks.width, marks.height);
  let count = 0;
  for (let at = 0; at < data.length; at += 4) if (data[at + 3] > 200 && colour.every((part, k) => Math.abs(part - data[at + k]) < 12)) count += 1;
  return count;
}, colour);

test('links between cells, marks on them, and axes', { timeout: 120_000 }, async () => {
  await writeFile(files.file('linked.toml'), LINKED);
  const linked = files.file('linked.h5');
  const made = await run('run', files.file('linked.toml'), '-o', linked, '--no-pictures', '--quiet');
  assert.equal(made.code, 0, made.err);
  const server = await serve('view', linked);
  const page = await openPage(browser, server.address);
  await page.focus('#view');
  await page.keyboard.press('End');
  await page.waitForFunction(() => window.pseudopod.drawn.frame === 10);
  assert.equal(await page.evaluate(() => window.pseudopod.lines.get('linked').geometry.instanceCount), 1);
  assert.ok(await page.getByLabel('Links between cells').isChecked());
  // Marks make a part of each cell paler.
  const plain = await pixels(page);
  await page.getByLabel('Marks').check();
  const paler = await pixels(page);
  assert.ok(paler.mean[0] > plain.mean[0] + 1, `${plain.mean} ${paler.mean}`);
  // The axes have the colours of pictures, and can be left out.
  await page.evaluate(() => window.pseudopod.view('front'));
  await page.evaluate(() => window.pseudopod.draw());
  for (const colour of [[0xd5, 0x5e, 0x00], [0x00, 0x72, 0xb2]]) assert.ok(await marked(page, colour) > 20, String(colour));
  await page.getByLabel('Axes').uncheck();
  await page.evaluate(() => window.pseudopod.draw());
  assert.equal(await marked(page, [0xd5, 0x5e, 0x00]), 0);
  assert.deepEqual(page.errors, []);
  await page.context().close();
  await server.stop();
});

test('a page from the disk', { timeout: 120_000 }, async () => {
  const path = files.file('two.html');
  const made = await run('export', result, '--html', path);
  assert.equal(made.code, 0, made.err);
  assert.match(made.out, /31 frames, 0\.\d MB/);
  const page = await openPage(browser, `file://${path}`);
  await looks(page);
  await page.context().close();
});

test('a film of all frames is kept', { timeout: 120_000 }, async () => {
  const server = await serve('view', result);
  const page = await openPage(browser, server.address);
  await page.selectOption('#speed', '30');
  const [download] = await Promise.all([page.waitForEvent('download', { timeout: 90_000 }), page.getByRole('button', { name: 'Save a film' }).click()]);
  assert.equal(download.suggestedFilename(), 'Two_cells_on_glass.webm');
  const film = await readFile(await download.path());
  assert.deepEqual([...film.subarray(0, 4)], [0x1a, 0x45, 0xdf, 0xa3], 'a file of Matroska or WebM');
  assert.ok(film.length > 5_000, `${film.length} bytes`);
  assert.equal(await page.evaluate(() => window.pseudopod.drawn.frame), 30);
  await page.context().close();
  await server.stop();
});

test('a page from the disk takes no more than it may', { timeout: 120_000 }, async () => {
  const path = files.file('small.html');
  // Meshes so fine that what is told of atoms, which no size leaves out, is most of a page; then between the smallest page and the whole one.
  const fine = files.file('fine.h5');
  const sets = ['cells.left.mesh.level=3', 'cells.right.mesh.level=3', 'run.until="20 s"'].flatMap((set) => ['--set', set]);
  assert.equal((await run('run', files.file('two.toml'), '-o', fine, '--no-pictures', '--quiet', ...sets)).code, 0);
  const write = (size) => run('export', fine, '--html', path, '--force', '--colours', 'height,displacement,curvature', '--size', size);
  const least = await write('1 B');
  assert.match(least.out, /^.*\n2 of 11 frames, .* no page is smaller/);
  const [smallest, whole] = [(await stat(path)).size, await write('20 MB').then(() => stat(path)).then((file) => file.size)];
  const size = Math.round(smallest + 0.3 * (whole - smallest));
  const made = await write(`${size} B`);
  assert.equal(made.code, 0, made.err);
  assert.match(made.out, /\d+ of 11 frames/);
  assert.ok((await stat(path)).size <= size, `${(await stat(path)).size} of ${size} bytes`);
  const page = await openPage(browser, `file://${path}`);
  const [first, last] = await page.evaluate(() => [window.pseudopod.course.times[0], window.pseudopod.course.times.at(-1)]);
  assert.deepEqual([first, last], [0, 20]);
  await page.context().close();
});

/** The status of an answer to a request with these headers. */
function status(address, headers, method = 'GET') {
  return new Promise((done, fail) => {
    const request = http.request(address, { headers, method }, (response) => { response.resume(); done(response.statusCode); });
    request.on('error', fail);
    request.end();
  });
}

describe('who is answered', { timeout: 60_000 }, () => {
  test('pages of this machine with the key, and nobody else', async () => {
    const server = await serve('view', result);
    const { origin, host } = new URL(server.address);
    assert.equal(await status(server.address, {}), 200);
    assert.equal(await status(server.address, { Host: host.replace('127.0.0.1', 'localhost') }), 200);
    // A name that somebody has made to mean this machine.
    assert.equal(await status(server.address, { Host: 'attacker.example' }), 403);
    assert.equal(await status(server.address, { Origin: 'http://attacker.example' }), 403);
    assert.equal(await status(`${origin}/`, {}), 404);
    assert.equal(await status(`${origin}/data/scene`, {}), 404);
    for (const request of ['data/frame/31', 'data/frame/-1', 'data/values/0/no_such', 'data/frame/0/../../x', 'data/%2e%2e/x', 'data/field/0/none.c', 'data/lines/0/fibres']) {
      assert.equal(await status(server.address + request, {}), 404, request);
    }
    assert.equal(await status(`${server.address}stop`, {}, 'POST'), 404, 'no run goes on');
    await server.stop();
  });
});

/** Steps so short that the fastest machine is at them for longer than a page takes to open. */
const LONG = ['--set', 'run.integrator.max_step="0.01 s"'];

test('a run that goes on is watched, paused, let go on and stopped', { timeout: 120_000 }, async () => {
  const path = files.file('live.h5');
  // Cells that stay where they can be seen.
  const slow = ['left', 'right'].flatMap((name) => ['--set', `cells.${name}.motility.brownian.speed="0.05 um/min"`]);
  const server = await serve('run', files.file('two.toml'), '-o', path, '--no-pictures', '--view', '--set', 'run.until="20 h"', '--set', 'output.every="60 s"', ...LONG, ...slow);
  const page = await openPage(browser, server.address);
  await page.waitForFunction(() => /Running: t = /.test(document.getElementById('progress').textContent), null, { timeout: 30_000 });
  // What is seen is where the run is, between frames.
  await page.waitForFunction(() => window.pseudopod.live?.time > 0, null, { timeout: 30_000 });
  await page.evaluate(() => window.pseudopod.fit());
  const seen = await pixels(page);
  assert.ok(seen.unlike > 0.005 && seen.bluish > 1e-4, JSON.stringify(seen));
  await page.getByRole('button', { name: 'Pause the run' }).click();
  await page.getByText('The run waits').waitFor();
  const time = () => page.evaluate(() => window.pseudopod.transport.run.time);
  const waits = await time();
  await page.waitForTimeout(1200);
  assert.equal(await time(), waits);
  await page.getByRole('button', { name: 'Let the run go on' }).click();
  await page.waitForFunction((then) => window.pseudopod.transport.run.time > then, waits);
  await page.getByRole('button', { name: 'Stop the run' }).click();
  const { code, err } = await server.ended;
  assert.equal(code, 130, err);
  assert.match(err, /pseudopod resume/);
  await page.getByText('The program that served this page has ended.').waitFor();
  assert.deepEqual(page.errors.filter((text) => !/ERR_|Failed to load/.test(text)), []);
  await page.context().close();
});

test('a run to its end: its page stays until it is closed, and its bits are those of one that nobody watched', { timeout: 120_000 }, async () => {
  const path = files.file('watched.h5');
  const alone = files.file('alone.h5');
  assert.equal((await run('run', files.file('two.toml'), '-o', alone, '--no-pictures', '--quiet', ...LONG)).code, 0);
  const server = await serve('run', files.file('two.toml'), '-o', path, '--no-pictures', '--view', ...LONG);
  // It waits until the page is open, however fast it is.
  assert.equal((await fetch(`${server.address}pause`, { method: 'POST' })).status, 200);
  const page = await openPage(browser, server.address);
  await page.getByRole('button', { name: 'Let the run go on' }).click();
  await page.getByText('The run has ended').waitFor({ timeout: 60_000 });
  await page.waitForFunction(() => window.pseudopod.frames === 31 && window.pseudopod.drawn.frame === 30, null, { timeout: 20_000 });
  await page.context().close();
  const { code } = await server.ended;
  assert.equal(code, 0);
  const tables = await Promise.all([path, alone].map(async (file, k) => {
    const table = files.file(`series${k}.csv`);
    assert.equal((await run('export', file, '-o', table)).code, 0);
    return readFile(table, 'utf8');
  }));
  assert.equal(tables[0], tables[1]);
});
