// A picture of a page in headless Chromium, and what its pictures cost while it plays:
// picture.mjs PAGE.html PICTURE.png [time=S] [quality=0..4] [on=strain,wire] [pixels=1280x800] [look=NAME] [play=SECONDS].
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';

const [file, picture, ...options] = process.argv.slice(2);
const asked = {time: '0', quality: '0', on: '', pixels: '1280x800', look: '', play: '0',
               ...Object.fromEntries(options.map((option) => option.split('=')))};
const [width, height] = asked.pixels.split('x').map(Number);
const profile = mkdtempSync(join(tmpdir(), 'avbd-picture-'));
const browser = await chromium.launchPersistentContext(profile, {
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', headless: true, viewport: {width, height}, colorScheme: 'dark',
  args: ['--headless', '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
         '--disable-component-update', '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
try {
  const page = await browser.newPage();
  page.on('pageerror', (error) => console.error(String(error)));
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForFunction(() => window.avbdViewer, null, {timeout: 60000});
  const settle = () => page.evaluate(
      () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 100)))));
  await page.evaluate(({time, quality, on}) => {
    window.avbdViewer.setQuality(quality);
    window.avbdViewer.seek(Number(time));
    for (const name of on.split(',').filter(Boolean)) window.avbdViewer.toggle(name, true);
  }, asked);
  await settle();
  if (asked.look) {
    await page.evaluate((name) => {
      const viewer = window.avbdViewer;
      viewer.select(viewer.recording.names.indexOf(name));
      viewer.lookAtSelected();
      viewer.select(-1);
    }, asked.look);
    await settle();
  }
  if (Number(asked.play) > 0) {
    await page.evaluate(() => window.avbdViewer.play());
    await page.waitForTimeout(1000 * Number(asked.play));
    const {updateMs, drawMs, perSecond} = await page.evaluate(() => window.avbdViewer.stats);
    console.log(`${updateMs.toFixed(1)} ms of the page's own code a picture, ${drawMs.toFixed(1)} ms of drawing calls, ` +
                `${perSecond.toFixed(1)} pictures/s without a GPU`);
    await page.evaluate((time) => { window.avbdViewer.pause(); window.avbdViewer.seek(Number(time)); }, asked.time);
    await settle();
  }
  await page.screenshot({path: picture});
} finally {
  await browser.close();
  rmSync(profile, {recursive: true, force: true});
}
