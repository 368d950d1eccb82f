// What the page shows of maps of all sizes, by its pixels: node html_map_views_test.mjs, with CMAP_EVAL and what
// browser.mjs needs.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { colorAt, colorOffset, launch, openReady, pixels } from './browser.mjs';

const folder = mkdtempSync(join(tmpdir(), 'cmap-views-'));

/** A binary PLY of points [x, y, z, [red, green, blue]], in double precision. */
function writeMap(name, points) {
  const properties = ['double x', 'double y', 'double z', 'uchar red', 'uchar green', 'uchar blue'];
  const header = ['ply', 'format binary_little_endian 1.0', `element vertex ${points.length}`];
  const lines = [...header, ...properties.map((property) => `property ${property}`), 'end_header', ''];
  const rows = Buffer.alloc(27 * points.length);
  points.forEach(([x, y, z, color], i) => {
    [x, y, z].forEach((value, k) => rows.writeDoubleLE(value, 27 * i + 8 * k));
    color.forEach((value, k) => rows.writeUInt8(value, 27 * i + 24 + k));
  });
  const path = join(folder, name);
  writeFileSync(path, Buffer.concat([Buffer.from(lines.join('\n')), rows]));
  return path;
}

function pageOf(name, ...args) {
  const html = join(folder, `${name}.html`);
  execFileSync(process.env.CMAP_EVAL, [...args, '--html', html, '--quiet']);
  return html;
}

const gray = [128, 128, 128];
// By the corners of a map, as they lie from above with north up.
const corners = { left_low: [220, 0, 0], right_low: [0, 200, 0], left_high: [0, 0, 230], right_high: [210, 190, 0] };

/** A square of 120 x 120 points that is gray but for its corners, a tenth of its side each. */
function square(side, [x0, y0, z0] = [0, 0, 0]) {
  const n = 120;
  const third = (i) => (i < n / 10 ? 'low' : i >= (9 * n) / 10 ? 'high' : '');
  return Array.from({ length: n * n }, (_, index) => {
    const [i, j] = [index % n, Math.floor(index / n)];
    const color = corners[`${{ low: 'left', high: 'right' }[third(i)]}_${third(j)}`] ?? gray;
    return [x0 + (side * i) / (n - 1), y0 + (side * j) / (n - 1), z0, color];
  });
}

let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true });
});

/** Middle of the pixels of a color, by shares of the picture from its lower left; nothing where there are under 20. */
function placeOf(picture, color) {
  let [count, right, up] = [0, 0, 0];
  for (let y = 0; y < picture.height; ++y) {
    for (let x = 0; x < picture.width; ++x) {
      if (colorOffset(colorAt(picture, x, y), color) > 2) continue;
      ++count;
      right += x / picture.width;
      up += 1 - y / picture.height;
    }
  }
  return count < 20 ? undefined : { right: right / count, up: up / count };
}

/** The picture holds the whole square, and the square most of the picture's height. */
function checkCovered(picture, how) {
  const places = Object.entries(corners).map(([name, color]) => [name, placeOf(picture, color)]);
  for (const [name, place] of places) assert.ok(place, `${how}: the corner ${name} is not in the picture`);
  const { left_low, right_low, left_high, right_high } = Object.fromEntries(places);
  const [width, height] = [right_low.right - left_low.right, left_high.up - left_low.up];
  assert.ok(width > 0.25 && height > 0.3, `${how}: the map takes ${width} x ${height} of the picture`);
  return { left_low, right_low, left_high, right_high };
}

const maps = {
  '400 m wide': square(400),
  '2 cm wide': square(0.02),
  'with a stray 150 m below': [...square(20), [3, 3, -150, gray]],
  'with a stray 150 m below 400 m': [...square(400), [3, 3, -150, gray]],
  'with a stray 100 km off': [...square(20), [1e5, 0, 0, gray]],
  'with 2 % of strays': [...square(20), ...Array.from({ length: 290 }, (_, i) => [i, 4 * i, -7 * i, gray])],
  'at UTM': square(300, [452_000, 5_411_000, 250]),
};

for (const [name, points] of Object.entries(maps)) {
  test(`the first view and the one from above cover a map ${name}`, async () => {
    const page = await openReady(browser, pageOf('map', writeMap('map.ply', points)));
    const canvas = page.locator('#map canvas');
    checkCovered(await pixels(browser, page, canvas), 'first view');
    await page.locator('[data-action=top-view]').click();
    const above = checkCovered(await pixels(browser, page, canvas), 'from above');
    for (const [corner, place] of Object.entries(above)) {
      assert.equal(place.right > 0.5, corner.startsWith('right'), `${corner} is on its side`);
      assert.equal(place.up > 0.5, corner.endsWith('high'), `${corner} is at its end`);
    }
    assert.match(await page.locator('#points-shown').textContent(), new RegExp(`^${points.length.toLocaleString('en-US')} points`));
    await page.close();
  });
}

const legendValue = (page, label) => page.locator(`#legend [data-class="${label}"] .number`).textContent();
const showLayer = (page, id) => page.locator(`label:has(input[value="${id}"])`).click();

/** 360,000 points on 10 x 10 m that are right, and 40,000 on 100 x 100 m beside them that are not. */
function denseAndSparse() {
  const grid = (n, side, x0, color) =>
    Array.from({ length: n * n }, (_, i) => [x0 + (side * (i % n)) / n, (side * Math.floor(i / n)) / n, 0, color]);
  return [...grid(600, 10, 0, [200, 0, 0]), ...grid(200, 100, 50, [0, 0, 200])];
}

test('shares in legends are the metric’s, though the page thins the map evenly', async () => {
  const reference = denseAndSparse();
  // The sparse part has another color, and lies 1 cm deeper.
  const estimate = reference.map(([x, y, z, color]) => (x < 50 ? [x, y, z, color] : [x, y, z - 0.01, [0, 200, 0]]));
  const page = await openReady(browser, pageOf('shares', writeMap('reference.ply', reference), writeMap('estimate.ply', estimate)));
  const recall = Number(await page.locator('tr[data-metric=local_color_recall] td.value').getAttribute('data-value'));
  assert.equal(recall, 0.9, 'the metric');
  assert.match(await page.locator('#points-shown').textContent(), /of 400,000 points/);
  await showLayer(page, 'lcr');
  assert.equal(await legendValue(page, 'recalled'), '90.0 %');
  assert.equal(await legendValue(page, 'wrong color'), '10.0 %');
  assert.equal(await legendValue(page, 'not covered'), '0.00 %');
  await showLayer(page, 'distance');
  const to = page.locator('#legend input[type=number]').nth(1);
  await to.fill('0.005');
  await to.press('Enter');
  assert.match(await page.locator('#legend .note').textContent(), /10\.0 % above$/);
  await page.close();
});

test('a patch of known value has the color of the color bar, from everywhere', async () => {
  const plane = square(20).map(([x, y]) => [x, y, 0, gray]);
  const above = plane.map(([x, y, , color]) => [x, y, 0.05, color]);
  const page = await openReady(browser, pageOf('patch', writeMap('reference.ply', plane), writeMap('estimate.ply', above)));
  await showLayer(page, 'distance');
  const to = page.locator('#legend input[type=number]').nth(1);
  await to.fill('0.1');
  await to.press('Enter');
  const half = [33, 145, 140]; // viridis(0.5), as published: 0.127568, 0.566949, 0.550556
  const middle = async (target) => {
    const picture = await pixels(browser, page, target);
    return colorAt(picture, picture.width >> 1, picture.height >> 1);
  };
  assert.ok(colorOffset(await middle(page.locator('#legend .bar')), half) <= 4, 'the bar');
  const canvas = page.locator('#map canvas');
  for (const key of ['r', 't', 'ArrowDown', 'ArrowLeft', '+']) {
    await canvas.focus();
    await page.keyboard.press(key);
    const color = await middle(canvas);
    assert.ok(colorOffset(color, half) <= 2, `after ${key} the patch is ${color}`);
  }
  await page.close();
});

test('one point is seen', async () => {
  const red = [200, 0, 0];
  const page = await openReady(browser, pageOf('point', writeMap('point.ply', [[500_000, 4_000_000, 3, red]])));
  const place = placeOf(await pixels(browser, page, page.locator('#map canvas')), red);
  assert.ok(place && Math.abs(place.right - 0.5) < 0.05 && Math.abs(place.up - 0.5) < 0.05, 'in the middle of the view');
  assert.match(await page.locator('#points-shown').textContent(), /^1 point$/);
  await page.close();
});

test('a map of one color, on one spot, of a name that is markup', async () => {
  const name = '<!--<script><img src=x onerror=alert(1)>&amp;.ply';
  const path = writeMap(name, Array.from({ length: 300 }, () => [1, 2, 3, gray]));
  const page = await openReady(browser, pageOf('markup', path, path));
  assert.equal(await page.locator('.message').count(), 0);
  assert.equal(await page.locator('h1').textContent(), `${name} against ${name}`);
  assert.equal(await page.locator('img').count(), 0);
  assert.ok(placeOf(await pixels(browser, page, page.locator('#map canvas')), gray), 'the spot is drawn');
  await page.close();
});
