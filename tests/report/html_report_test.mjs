// The HTML report in a real browser: node html_report_test.mjs [REPORT.html REPORT.json], by default the report that
// CMAP_EVAL makes of the tum_fr1 pair, or of the town where that is absent. Needs what browser.mjs says.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { colorAt, colorOffset, contrast, launch, outlineFaults, pixels as pixelsOf, source } from './browser.mjs';

function makeReport() {
  const program = process.env.CMAP_EVAL;
  assert.ok(program, 'usage: node html_report_test.mjs REPORT.html REPORT.json, or set CMAP_EVAL');
  const real = join(process.env.CMAP_DATA_DIR ?? join(source, '../shared/data'), 'tum_fr1');
  const maps = existsSync(real) ? real : join(source, 'data_samples/town');
  console.log(`# the pair of ${maps}`);
  const folder = mkdtempSync(join(tmpdir(), 'cmap-html-'));
  process.on('exit', () => rmSync(folder, { recursive: true }));
  const [html, json] = ['report.html', 'report.json'].map((name) => join(folder, name));
  const pair = ['reference.ply', 'estimate.ply'].map((name) => join(maps, name));
  execFileSync(program, [...pair, '--metrics', 'all', '--html', html, '-o', json, '--quiet']);
  return [html, json];
}

const [htmlPath, jsonPath] = process.argv.length > 2 ? process.argv.slice(2) : makeReport();
const url = pathToFileURL(resolve(htmlPath)).href;
const reportText = await readFile(jsonPath, 'utf8');
const report = JSON.parse(reportText);

const firstFrameLimitMs = 3000;
const whenReady = (opened) => opened.locator('html[data-ready]').waitFor({ timeout: 30_000 });

let browser;
let page; // the report, for all tests that leave it as it was
const messages = [];
const requests = [];

/** Opens the report, or another page, and writes down whatever it says and asks for. */
async function open(address = url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, acceptDownloads: true, ...options });
  const opened = await context.newPage();
  opened.on('console', (message) => messages.push(`console: ${message.text()}`));
  opened.on('pageerror', (error) => messages.push(`error: ${error}`));
  opened.on('request', (request) => requests.push(request.url()));
  await opened.goto(address);
  return opened;
}

async function openReady(options = {}) {
  const opened = await open(url, options);
  await whenReady(opened);
  return opened;
}

before(async () => {
  browser = await launch();
  page = await openReady();
});
after(() => browser.close());

const pixels = (target) => pixelsOf(browser, page, target);
const canvas = () => page.locator('#map canvas');

/** Share of the pixels that differ between two pictures. */
function difference(a, b) {
  assert.equal(a.data.length, b.data.length, 'pictures of one size');
  let different = 0;
  for (let i = 0; i < a.data.length; i += 4) {
    if (a.data[i] !== b.data[i] || a.data[i + 1] !== b.data[i + 1] || a.data[i + 2] !== b.data[i + 2]) ++different;
  }
  return different / (a.data.length / 4);
}

/** Share of the pixels that are not background, the color of the upper left corner. */
function drawnShare(picture) {
  const background = colorAt(picture, 4, 4);
  let drawn = 0;
  for (let y = 0; y < picture.height; ++y) {
    for (let x = 0; x < picture.width; ++x) if (colorOffset(colorAt(picture, x, y), background) > 3) ++drawn;
  }
  return drawn / (picture.width * picture.height);
}

/** A place inside a patch of one color that is not background, close to the middle of the picture. */
function patchNearMiddle(picture) {
  const background = colorAt(picture, 4, 4);
  const [middleX, middleY] = [picture.width >> 1, picture.height >> 1];
  for (let radius = 0; radius < Math.min(middleX, middleY) - 2; ++radius) {
    for (let turn = 0; turn < 64; ++turn) {
      const x = Math.round(middleX + radius * Math.cos((turn * Math.PI) / 32));
      const y = Math.round(middleY + radius * Math.sin((turn * Math.PI) / 32));
      const color = colorAt(picture, x, y);
      const around = [[-1, 0], [1, 0], [0, -1], [0, 1]].map(([dx, dy]) => colorAt(picture, x + dx, y + dy));
      const flat = around.every((other) => colorOffset(other, color) === 0);
      if (flat && colorOffset(color, background) > 3) return { x, y, color };
    }
  }
  throw new Error('no patch of one color in the picture');
}

const layerIds = () => page.locator('input[name=layer]').evaluateAll((inputs) => inputs.map((input) => input.value));
const showLayer = (id) => page.locator(`label:has(input[value="${id}"])`).click();
const shownLayer = () => page.evaluate('document.documentElement.dataset.layer');

async function readPoint() {
  const rows = page.locator('#readout dd');
  const entries = await rows.evaluateAll((cells) => cells.map((cell) => [cell.dataset.field, cell.dataset.value]));
  return Object.fromEntries(entries);
}

test('the first frame comes within its time', async () => {
  const times = [];
  for (let i = 0; i < 3; ++i) {
    const opened = await openReady();
    times.push(await opened.evaluate("performance.getEntriesByName('cmap-first-frame')[0].startTime"));
    await opened.context().close();
  }
  console.log(`first frame after ${times.map(Math.round).join(', ')} ms`);
  assert.ok(Math.min(...times) < firstFrameLimitMs, `first frame after ${times} ms, limit ${firstFrameLimitMs} ms`);
});

test('the map is drawn', async () => {
  const share = drawnShare(await pixels(canvas()));
  assert.ok(share > 0.02, `${share} of the canvas is drawn`);
});

test('each layer has its own picture, by button and by key', async () => {
  const ids = await layerIds();
  assert.ok(ids.length >= 2, `layers: ${ids}`);
  const byButton = [];
  for (const id of ids) {
    await showLayer(id);
    assert.equal(await shownLayer(), id, 'the layer of the button');
    byButton.push(await pixels(canvas()));
  }
  for (let i = 1; i < ids.length; ++i) {
    const changed = difference(byButton[i - 1], byButton[i]);
    assert.ok(changed > 0.005, `${ids[i - 1]} and ${ids[i]} differ in ${changed} of the pixels`);
  }
  for (const [i, id] of ids.slice(0, 9).entries()) {
    await page.keyboard.press(String(i + 1));
    assert.equal(await shownLayer(), id, `the layer of key ${i + 1}`);
    const changed = difference(byButton[i], await pixels(canvas()));
    assert.ok(changed < 0.001, `key ${i + 1} shows another picture than the button: ${changed}`);
  }
});

test('the keyboard turns, moves and zooms the map', async () => {
  await canvas().focus();
  const first = await pixels(canvas());
  for (const key of ['ArrowLeft', 'ArrowUp', 'Shift+ArrowRight', '+', '-', 't']) {
    const old = await pixels(canvas());
    await page.keyboard.press(key);
    assert.ok(difference(old, await pixels(canvas())) > 0.005, `${key} leaves the picture as it was`);
  }
  await page.keyboard.press('r');
  assert.ok(difference(first, await pixels(canvas())) < 0.001, 'r does not go back to the first view');
});

test('mouse and fingers turn, move and zoom the map', async () => {
  await page.locator('[data-action=first-view]').click(); // the canvas without its focus ring
  const first = await pixels(canvas());
  const box = await canvas().boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const drag = (button) => async () => {
    await page.mouse.move(x, y);
    await page.mouse.down({ button });
    await page.mouse.move(x + 60, y + 20, { steps: 3 });
    await page.mouse.up({ button });
  };
  const touch = await page.context().newCDPSession(page);
  const pinch = async () => {
    const fingers = (apart) => [{ x: x - apart, y, id: 0 }, { x: x + apart, y, id: 1 }];
    await touch.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: fingers(40) });
    await touch.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: fingers(90) });
    await touch.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  };
  const wheel = async () => {
    await page.waitForTimeout(300); // a page that has just been scrolled goes on scrolling
    await page.mouse.wheel(0, -240);
    await page.waitForTimeout(100);
  };
  const actions = { turn: drag('left'), move: drag('right'), wheel, pinch };
  for (const [name, action] of Object.entries(actions)) {
    const old = await pixels(canvas());
    await action();
    assert.ok(difference(old, await pixels(canvas())) > 0.005, `${name} leaves the picture as it was`);
  }
  assert.deepEqual(await readPoint(), {}, 'a drag picks no point');
  await page.locator('[data-action=first-view]').click();
  assert.ok(difference(first, await pixels(canvas())) < 0.001, 'the button goes back to the first view');
});

test('the map is drawn only when something changes', async () => {
  const frames = await page.evaluate(async () => {
    let asked = 0;
    const original = window.requestAnimationFrame;
    window.requestAnimationFrame = (callback) => (++asked, original.call(window, callback));
    await new Promise((done) => setTimeout(done, 400));
    window.requestAnimationFrame = original;
    return asked;
  });
  assert.equal(frames, 0, `${frames} frames were asked for while nothing happened`);
});

test('a picked point reads as it is drawn', async () => {
  for (const id of await layerIds()) {
    await showLayer(id);
    const { x, y, color } = patchNearMiddle(await pixels(canvas()));
    await canvas().click({ position: { x, y } });
    assert.ok(await page.locator('.marker').isVisible(), `${id}: the picked point is marked`);
    const point = await readPoint();
    for (const axis of ['x', 'y', 'z']) {
      const { min, max } = unitedBounds('xyz'.indexOf(axis));
      const value = Number(point[axis]);
      assert.ok(value >= min - 0.1 && value <= max + 0.1, `${id}: ${axis} ${point[axis]} is outside of both maps`);
    }
    await checkAgainstLegend(id, point, color);
  }
  await page.keyboard.press('Escape');
  assert.deepEqual(await readPoint(), {}, 'Escape forgets the point');
  assert.ok(await page.locator('.marker').isHidden(), 'Escape takes the mark away');
});

/** Along one axis; an estimate that was moved may reach further. */
function unitedBounds(axis) {
  const bounds = Object.values(report.inputs).map((input) => input.bounds_m);
  const moved = report.alignment.method === 'none' ? 0 : Infinity;
  return {
    min: Math.min(...bounds.map((box) => box.min[axis])) - moved,
    max: Math.max(...bounds.map((box) => box.max[axis])) + moved,
  };
}

async function checkAgainstLegend(id, point, color) {
  const classes = await page.locator('#legend [data-class]').evaluateAll((items) =>
    items.map((item) => [item.dataset.class, getComputedStyle(item.querySelector('.swatch')).backgroundColor]),
  );
  if (classes.length > 0) {
    const drawn = classes.find(([, background]) => background === `rgb(${color.join(', ')})`);
    assert.ok(drawn, `${id}: the picture's ${color} is no color of the legend`);
    assert.ok(Object.values(point).includes(drawn[0]), `${id}: drawn as ${drawn[0]}, read as ${JSON.stringify(point)}`);
    return;
  }
  const ends = await page.locator('#legend .ends span').evaluateAll((spans) => spans.map((s) => Number(s.dataset.value)));
  if (ends.length === 0) {
    if (point.color) assert.deepEqual(point.color.split(' ').map(Number), color, `${id}: color of the point`);
    return;
  }
  const field = { distance: 'distance', 'color-distance': 'color_distance' }[id] ?? 'z';
  const value = Number(point[field]);
  assert.ok(Number.isFinite(value), `${id}: ${field} is ${point[field]}`);
  const bar = await pixels(page.locator('#legend .bar'));
  const share = Math.min(1, Math.max(0, (value - ends[0]) / (ends.at(-1) - ends[0])));
  const x = Math.min(bar.width - 3, Math.max(2, Math.round(share * (bar.width - 1))));
  const wanted = colorAt(bar, x, bar.height >> 1);
  const offset = colorOffset(wanted, color);
  assert.ok(offset <= 8, `${id}: ${value} is drawn as ${color}, in the legend it is ${wanted}`);
}

test('Enter reads the point in the middle of the view', async () => {
  const { x, y } = patchNearMiddle(await pixels(canvas()));
  await canvas().dblclick({ position: { x, y } }); // brings that point to the middle
  await page.keyboard.press('Escape');
  await canvas().focus();
  await page.keyboard.press('Enter');
  assert.ok(Number.isFinite(Number((await readPoint()).x)), 'the readout has an x');
  await page.keyboard.press('r');
  await page.keyboard.press('Escape');
});

test('the color range changes the picture, and reset brings it back', async () => {
  const ids = await layerIds();
  const id = ids.includes('distance') ? 'distance' : ids.at(-1);
  await showLayer(id);
  const old = await pixels(canvas());
  const to = page.locator('#legend input[type=number]').nth(1);
  await to.fill(String(Number(await to.inputValue()) / 4 + 1e-3));
  await to.press('Enter');
  assert.ok(difference(old, await pixels(canvas())) > 0.005, 'another range gives another picture');
  await page.locator('[data-action=reset-range]').click();
  assert.ok(difference(old, await pixels(canvas())) < 0.001, 'reset gives the first picture');
});

/** Every value of the report with the row it belongs to. */
function reportedValues() {
  return Object.entries(report.metrics).flatMap(([id, record]) => {
    const row = (key, value) => ({ selector: `tr[data-metric="${id}"]${key}`, value });
    if (record.per_threshold) return record.per_threshold.map((e) => row(`[data-threshold="${e.threshold_m}"]`, e.value));
    if (record.per_range) return record.per_range.map((e) => row(`[data-range="${e.lo_m}"]`, e.value));
    return [row('', record.value)];
  });
}

test('the table holds every value of the report exactly', async () => {
  const values = reportedValues();
  for (const { selector, value } of values) {
    const cell = page.locator(`${selector} td.value`);
    assert.equal(await cell.count(), 1, `one row ${selector}`);
    assert.equal(JSON.parse(await cell.getAttribute('data-value')), value, selector);
    const shown = (await cell.textContent()).replaceAll(',', '');
    if (value === null) assert.equal(shown, '–', selector);
    else assert.ok(Math.abs(Number(shown) - value) <= 6e-4 * Math.abs(value), `${selector}: ${value} shown as ${shown}`);
  }
  assert.equal(await page.locator('tr.metric').count(), values.length, 'as many rows as values');
});

const columnValues = () =>
  page.locator('tr.metric td.value').evaluateAll((cells) => cells.map((cell) => JSON.parse(cell.dataset.value)));

async function assertSorted(order, how) {
  const header = page.locator('th[data-column=value]');
  assert.equal(await header.getAttribute('aria-sort'), order, how);
  const values = await columnValues();
  const known = values.filter((value) => value !== null);
  const sign = order === 'ascending' ? 1 : -1;
  assert.deepEqual(known, [...known].sort((a, b) => sign * (a - b)), `${how}: rows in order`);
  assert.ok(values.slice(known.length).every((value) => value === null), `${how}: rows without a value come last`);
}

test('the table is sorted by mouse and by keyboard', async () => {
  const reported = await columnValues();
  const sort = page.locator('th[data-column=value] button');
  await sort.click();
  await assertSorted('ascending', 'first click');
  await sort.click();
  await assertSorted('descending', 'second click');
  await sort.click();
  assert.deepEqual(await columnValues(), reported, 'the third click restores the order of the report');
  await sort.focus();
  await page.keyboard.press('Enter');
  await assertSorted('ascending', 'Enter');
  await page.keyboard.press('Space');
  await assertSorted('descending', 'Space');
  await page.keyboard.press('Space');
});

test('definitions appear on keyboard focus, details on Enter', async () => {
  await page.locator('th[data-column=group] button').focus();
  await page.keyboard.press('Tab');
  const term = page.locator(':focus');
  assert.match(await term.getAttribute('class'), /term/, 'Tab goes on from the headers to the first metric');
  const tooltip = page.locator('[role=tooltip]');
  assert.ok(await tooltip.isVisible(), 'focus shows the definition');
  const described = page.locator(`[id="${await term.getAttribute('aria-describedby')}"]`);
  assert.equal(await tooltip.textContent(), await described.textContent(), 'the same text for screen readers');
  assert.ok((await tooltip.textContent()).length > 10, 'a definition');
  await page.keyboard.press('Escape');
  assert.ok(await tooltip.isHidden(), 'Escape hides it');
  const details = page.locator(`[id="${await term.getAttribute('aria-controls')}"]`);
  assert.ok(await details.isHidden(), 'details are closed at first');
  await page.keyboard.press('Enter');
  assert.ok(await details.isVisible(), 'Enter opens the details');
  await page.keyboard.press('Enter');
});

test('charts have ink and a readout by keyboard', async () => {
  const figures = await page.locator('figure[data-chart]').all();
  assert.ok(figures.length >= 2, 'there are charts');
  for (const figure of figures) {
    const name = await figure.getAttribute('data-chart');
    assert.ok(drawnShare(await pixels(figure.locator('.plot canvas'))) > 0.01, `${name} is drawn`);
    await figure.locator('.plot').focus();
    await page.keyboard.press('ArrowRight');
    assert.match(await figure.locator('.place').textContent(), /^at /, `${name}: an arrow key reads a value`);
  }
});

test('the cumulative share at the end of the axis counts what lies beyond', async () => {
  const figure = page.locator('[data-chart=distance-cumulative]');
  const { directions } = await page.evaluate(
    "JSON.parse(document.getElementById('cmap-page').textContent).distributions.find((d) => d.id === 'distance')",
  );
  const whole = figure.locator('button', { hasText: 'Whole range' });
  if (await whole.count()) await whole.click();
  await figure.locator('.plot').focus();
  const bins = Math.max(...directions.map(({ counts }) => counts.length));
  for (let i = 0; i <= bins; i += 10) await page.keyboard.press('Shift+ArrowRight');
  const shown = await figure.locator('.chart-legend .number').allTextContents();
  directions.forEach(({ total, beyond, title }, i) => {
    assert.equal(shown[i], `${((100 * (total - beyond)) / total).toFixed(2)} %`, title);
  });
});

test('the downloaded report is the report, with names of files in place of paths', async () => {
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator('[data-action=download]').click()]);
  assert.equal(download.suggestedFilename(), 'report.json');
  const shared = JSON.parse(reportText);
  for (const input of Object.values(shared.inputs)) input.path = basename(input.path);
  const words = shared.run.command.split(' ');
  shared.run.command = words.map((word) => (word.startsWith('/') ? basename(word) : word)).join(' ');
  assert.deepEqual(JSON.parse(await readFile(await download.path(), 'utf8')), shared);
});

test('no folder of whoever made the page is in it', async () => {
  const html = await readFile(htmlPath, 'utf8');
  for (const { path } of Object.values(report.inputs)) {
    assert.ok(path.startsWith('/'), 'the report itself holds the path');
    assert.ok(!html.includes(dirname(path)), `${dirname(path)} is in the page`);
  }
});

test('the screenshot is a PNG that is not empty', async () => {
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator('[data-action=screenshot]').click()]);
  const bytes = await readFile(await download.path());
  assert.equal(bytes.subarray(1, 4).toString('latin1'), 'PNG');
  assert.ok(bytes.length > 10_000, `${bytes.length} bytes`);
});

async function checkContrast(scheme, opened) {
  const samples = await opened.evaluate(() => {
    const page = getComputedStyle(document.documentElement).backgroundColor;
    const background = (element) => {
      for (let at = element; at; at = at.parentElement) {
        const color = getComputedStyle(at).backgroundColor;
        if (color !== 'rgba(0, 0, 0, 0)') return color;
      }
      return page;
    };
    const selectors = ['h1', '.note', 'td.value', 'td.unit', '.term', '.qualifier', '.warnings li', '.path', '.panel', '.sort'];
    return selectors.flatMap((selector) => {
      const element = document.querySelector(selector);
      return element ? [{ selector, color: getComputedStyle(element).color, background: background(element) }] : [];
    });
  });
  assert.ok(samples.length >= 7, 'text to measure');
  for (const { selector, color, background } of samples) {
    const ratio = contrast(color, background);
    assert.ok(ratio >= 4.5, `${scheme}: ${selector}: ${color} on ${background} has a contrast of ${ratio.toFixed(2)}`);
  }
  return samples[0].background;
}

test('text is readable in light and dark, by the system and by the button', async () => {
  const opened = await openReady({ colorScheme: 'light' });
  const light = await checkContrast('light', opened);
  await opened.emulateMedia({ colorScheme: 'dark' });
  await opened.locator('html[data-theme=dark]').waitFor({ timeout: 5000 });
  const dark = await checkContrast('dark', opened);
  assert.notEqual(light, dark, 'the page follows the system');
  await opened.locator('#theme').click();
  assert.equal(await checkContrast('light by button', opened), light, 'the button goes back to light');
  await opened.context().close();
});

test('400 pixels are wide enough', async () => {
  const opened = await openReady({ viewport: { width: 400, height: 800 } });
  const width = await opened.evaluate('document.documentElement.scrollWidth');
  assert.ok(width <= 400, `the page is ${width} pixels wide`);
  const tables = await opened.locator('.table-frame').evaluateAll((all) => all.map((frame) => [frame.scrollWidth, frame.clientWidth]));
  assert.ok(tables.length > 0);
  for (const [needed, there] of tables) assert.ok(needed <= there, `a table takes ${needed} of ${there} pixels`);
  await opened.context().close();
});

test('one main landmark, and headings in order', async () => {
  assert.deepEqual(await outlineFaults(page), []);
});

test('without WebGL everything else works', async () => {
  const context = await browser.newContext();
  const opened = await context.newPage();
  const said = [];
  opened.on('console', (message) => said.push(message.text()));
  opened.on('pageerror', (error) => said.push(String(error)));
  await opened.addInitScript(() => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith('webgl') ? null : original.call(this, kind, ...rest);
    };
  });
  await opened.goto(url);
  await whenReady(opened);
  assert.match(await opened.locator('#map .message').textContent(), /WebGL/);
  assert.equal(await opened.locator('tr.metric').count(), reportedValues().length, 'the table is there');
  assert.ok((await opened.locator('.plot').count()) > 0, 'the charts are there');
  assert.deepEqual(said, [], 'and the console is empty');
  await context.close();
});

/** The report with something done to its source. */
async function openChanged(change) {
  const context = await browser.newContext();
  const opened = await context.newPage();
  const html = change(await readFile(htmlPath, 'utf8'));
  await opened.route('http://changed.test/', (route) => route.fulfill({ contentType: 'text/html; charset=utf-8', body: html }));
  await opened.goto('http://changed.test/');
  return opened;
}

test('damaged data is told', async () => {
  const element = (id) => new RegExp(`<script[^>]* id="${id}">[^<]*</script>`);
  const cases = [
    ['no report', (html) => html.replace(element('cmap-report'), ''), '#head .message', /no data/],
    ['half a report', (html) => html.replace('"schema"', '"schema'), '#head .message', /damaged/],
    ['no points', (html) => html.replace(element('cmap-points'), ''), '#map .message', /no data/],
    [
      'damaged points',
      (html) => html.replace(/(id="cmap-points">\s*.{400})..../, '$1AAAA'),
      '#map .message',
      /points of this page are damaged/,
    ],
  ];
  for (const [name, change, place, wanted] of cases) {
    const opened = await openChanged(change);
    const said = opened.locator(place);
    await said.waitFor({ timeout: 10_000 });
    assert.match(await said.textContent(), wanted, name);
    if (place.startsWith('#map')) assert.ok((await opened.locator('tr.metric').count()) > 0, `${name}: the table is there`);
    await opened.context().close();
  }
});

test('text of the report is never markup', async () => {
  const evil = '<img src=x onerror=alert(1)><b>path</b>';
  const written = JSON.stringify(evil).slice(1, -1).replaceAll('<', '\\u003c');
  const path = JSON.stringify(basename(report.inputs.estimate.path)).slice(1, -1);
  const opened = await openChanged((html) =>
    ['"path": ', '"path":'].reduce((text, key) => text.replaceAll(`${key}"${path}"`, `${key}"${written}"`), html),
  );
  await whenReady(opened);
  assert.match(await opened.locator('[data-input=estimate]').textContent(), /<b>path<\/b>/, 'shown as text');
  assert.equal(await opened.locator('img').count(), 0, 'no element was made of it');
  await opened.context().close();
});

test('the page asks for nothing but itself and says nothing', async () => {
  const others = requests.filter((address) => address !== url && !address.startsWith('blob:'));
  assert.deepEqual(others, [], 'requests');
  assert.deepEqual(messages, [], 'console and errors');
  const policy = await page.locator('meta[http-equiv=Content-Security-Policy]').getAttribute('content');
  assert.match(policy, /default-src 'none'/);
  const refused = await page.evaluate(() => fetch('http://127.0.0.1:9/').then(() => false, () => true));
  assert.ok(refused, 'the policy forbids connections');
});
