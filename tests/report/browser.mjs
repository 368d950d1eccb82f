// What the tests in a browser share. Needs `npm ci` in lib/report/web or a copy of it (CMAP_WEB_FOLDER), and Chromium
// (CMAP_CHROMIUM, by default /usr/bin/chromium).
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

export const source = fileURLToPath(new URL('../../', import.meta.url));
const web = process.env.CMAP_WEB_FOLDER ?? join(source, 'lib/report/web');
const { chromium } = createRequire(join(web, 'package.json'))('playwright-core');

/** A browser that draws WebGL in software and asks nobody for anything. */
export function launch() {
  return chromium.launch({
    executablePath: process.env.CMAP_CHROMIUM ?? '/usr/bin/chromium',
    args: [
      '--no-sandbox',
      '--use-gl=angle',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
      '--no-first-run',
      '--disable-quic',
    ],
  });
}

/** Opens a file once it has said that it is ready. */
export async function openReady(browser, path, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, ...options });
  await page.goto(pathToFileURL(path).href);
  await page.locator('html[data-ready]').waitFor({ state: 'attached', timeout: 60_000 });
  return page;
}

/** Pixels of what is on the screen there: { width, height, data } with four bytes each. */
export async function pixels(browser, page, target) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const png = await target.screenshot({ caret: 'initial' });
  const helper = await (await browser.newContext()).newPage();
  const picture = await helper.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const pen = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    pen.drawImage(bitmap, 0, 0);
    const { data } = pen.getImageData(0, 0, bitmap.width, bitmap.height);
    let text = '';
    for (let i = 0; i < data.length; i += 32768) text += String.fromCharCode(...data.subarray(i, i + 32768));
    return { width: bitmap.width, height: bitmap.height, base64: btoa(text) };
  }, png.toString('base64'));
  await helper.context().close();
  return { ...picture, data: Buffer.from(picture.base64, 'base64') };
}

/** What of a page screen readers go by is amiss: landmarks, and headings that skip a level. */
export function outlineFaults(page) {
  return page.evaluate(() => {
    const faults = [];
    const all = (selector) => [...document.querySelectorAll(selector)];
    if (all('main').length !== 1) faults.push(`${all('main').length} main landmarks`);
    const outside = [...document.body.children].filter(
      (child) => child.checkVisibility() && child.textContent.trim() && !child.matches('main, header, footer, nav, script, noscript'),
    );
    faults.push(...outside.map((child) => `${child.outerHTML.slice(0, 60)} is in no landmark`));
    const levels = all('h1, h2, h3, h4, h5, h6').filter((heading) => heading.checkVisibility()).map((heading) => Number(heading.tagName[1]));
    if (levels.filter((level) => level === 1).length !== 1) faults.push('not one h1');
    levels.forEach((level, i) => level > (levels[i - 1] ?? 0) + 1 && faults.push(`heading ${i + 1} of ${levels} skips a level`));
    if (!document.title) faults.push('no title');
    return faults;
  });
}

/** Contrast of two CSS colors rgb(...), as WCAG defines it. */
export function contrast(a, b) {
  const luminance = (text) => {
    const channels = text.match(/\d+(\.\d+)?/g).slice(0, 3).map((value) => Number(value) / 255);
    const linear = channels.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
  };
  const [light, dark] = [luminance(a), luminance(b)].sort((x, y) => y - x);
  return (light + 0.05) / (dark + 0.05);
}

export const colorAt = ({ data, width }, x, y) => [...data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3)];
export const colorOffset = (a, b) => Math.max(...a.map((value, k) => Math.abs(value - b[k])));
