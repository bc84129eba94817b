// Makes docs/pictures/view.png, the picture of the page in the book: PSEUDOPOD=PROGRAM node viewer/picture.mjs RESULT-OF-CHEMOTAXIS
import { openBrowser, openPage, serve } from './tests/browser.mjs';

const [, , result] = process.argv;
const server = await serve('view', result);
const browser = await openBrowser();
const page = await openPage(browser, server.address, { viewport: { width: 1200, height: 720 } });
await page.evaluate(async () => {
  const viewer = window.pseudopod;
  await viewer.set('tails', true);
  await viewer.transport.go(34);
  viewer.view('front');
  viewer.eye.turn(0.5, 0.6);
  viewer.eye.zoom(1.5);
  viewer.state.number = 'speed';
  viewer.choose(2);
});
await page.locator('#cell canvas').waitFor();
await page.waitForTimeout(1000);
await page.screenshot({ path: new URL('../docs/pictures/view.png', import.meta.url).pathname });
await browser.close();
await server.stop();
