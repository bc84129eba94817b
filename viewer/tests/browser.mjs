// A browser without a screen, which draws by software, and a page in it that keeps what it was told and asked for.

import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium } from 'playwright-core';

const BROWSERS = [process.env.PSEUDOPOD_BROWSER, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];

export const program = process.env.PSEUDOPOD ?? new URL('../../target/release/pseudopod', import.meta.url).pathname;

export async function openBrowser() {
  const executablePath = BROWSERS.find((path) => path && existsSync(path));
  if (!executablePath) throw new Error('no Chromium is here: install it, or name it in PSEUDOPOD_BROWSER');
  const args = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];
  return chromium.launch({ executablePath, args });
}

/** A page at an address, once it shows a frame. What it complained of and what it asked for is in `errors` and `requests`. */
export async function openPage(browser, address, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 640 }, acceptDownloads: true, colorScheme: 'light', ...options });
  const page = await context.newPage();
  page.errors = [];
  page.requests = [];
  page.on('console', (message) => { if (message.type() === 'error') page.errors.push(message.text()); });
  page.on('pageerror', (error) => page.errors.push(String(error)));
  page.on('request', (request) => page.requests.push(request.url()));
  await page.goto(address);
  await page.waitForFunction(() => window.pseudopod?.drawn.frame !== undefined, null, { timeout: 60_000 });
  return page;
}

/** Shares of pixels in the middle of the view by what they are: mean, and how many are unlike the ground. */
export async function pixels(page) {
  return page.evaluate(async () => {
    const viewer = window.pseudopod;
    viewer.draw();
    const [{ width, height }, context] = [viewer.canvas, document.createElement('canvas').getContext('2d', { willReadFrequently: true })];
    Object.assign(context.canvas, { width, height });
    context.drawImage(viewer.canvas, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    const ground = [...data.slice(0, 3)];
    let [unlike, bluish] = [0, 0];
    const mean = [0, 0, 0];
    for (let at = 0; at < data.length; at += 4) {
      const [r, g, b] = data.slice(at, at + 3);
      [r, g, b].forEach((part, k) => { mean[k] += part; });
      if (Math.abs(r - ground[0]) + Math.abs(g - ground[1]) + Math.abs(b - ground[2]) > 24) unlike += 1;
      if (b > r + 40) bluish += 1;
    }
    const count = data.length / 4;
    return { mean: mean.map((part) => part / count), unlike: unlike / count, bluish: bluish / count };
  });
}

/** A folder that is gone when the tests are over. */
export async function folder() {
  const path = await mkdtemp(join(tmpdir(), 'pseudopod-viewer-'));
  return { path, file: (name) => join(path, name), remove: () => rm(path, { recursive: true, force: true }) };
}

/** Runs the program to its end; what it said, and its exit code. */
export function run(...args) {
  return new Promise((done, fail) => {
    const child = spawn(program, args);
    let [out, err] = ['', ''];
    child.stdout.on('data', (text) => { out += text; });
    child.stderr.on('data', (text) => { err += text; });
    child.on('error', fail);
    child.on('close', (code) => done({ code, out, err }));
  });
}

/** Starts the program, and waits for the address that it prints. */
export function serve(...args) {
  return new Promise((done, fail) => {
    const child = spawn(program, args);
    let err = '';
    const ended = new Promise((over) => child.on('close', (code) => over({ code, err })));
    child.on('error', fail);
    child.stderr.on('data', (text) => {
      err += text;
      const [address] = err.match(/http:\/\/127\.0\.0\.1:\d+\/[0-9a-f]+\//) ?? [];
      if (address) done({ address, ended, child, stop: () => { child.kill('SIGINT'); return ended; } });
    });
    child.on('close', () => fail(new Error(`it ended: ${err}`)));
  });
}
