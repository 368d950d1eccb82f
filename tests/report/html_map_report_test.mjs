// The page of one map in a real browser: node html_map_report_test.mjs, with CMAP_EVAL and what browser.mjs needs.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { launch, source } from './browser.mjs';

const folder = mkdtempSync(join(tmpdir(), 'cmap-html-'));
const [html, json, exact] = ['map.html', 'map.json', 'exact.html'].map((name) => join(folder, name));
const town = join(source, 'data_samples/town/estimate.ply');
execFileSync(process.env.CMAP_EVAL, [town, '--html', html, '-o', json, '--quiet']);
execFileSync(process.env.CMAP_EVAL, [town, town, '--html', exact, '--quiet']);
const report = JSON.parse(readFileSync(json, 'utf8'));

let browser;
const messages = [];

async function open(path) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  page.on('console', (message) => messages.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => messages.push(`error: ${error}`));
  await page.goto(pathToFileURL(path).href);
  await page.locator('html[data-ready]').waitFor({ timeout: 60_000 });
  return page;
}

let page;
before(async () => {
  browser = await launch();
  page = await open(html);
});
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true });
});

test('every section stands or is hidden, none complains', async () => {
  assert.equal(await page.locator('.message').count(), 0);
  assert.deepEqual(messages, []);
  assert.equal(await page.locator('#charts').isHidden(), true, 'nothing to chart');
  for (const id of ['map', 'metrics', 'run']) assert.equal(await page.locator(`#${id}`).isVisible(), true, id);
});

test('the map is the only input and has its layers', async () => {
  const inputs = await page.locator('.inputs h2').allTextContents();
  assert.deepEqual(inputs, ['map']);
  const layers = await page.locator('input[name=layer]').evaluateAll((found) => found.map((input) => input.value));
  assert.deepEqual(layers, ['estimate', 'estimate-height']);
  await page.keyboard.press('2');
  assert.equal(await page.evaluate('document.documentElement.dataset.layer'), 'estimate-height');
});

test('the table holds its metrics', async () => {
  assert.equal(await page.locator('#metrics caption').textContent(), 'Metrics of the map');
  const cells = await page
    .locator('#metrics tr.metric')
    .evaluateAll((rows) => rows.map((row) => [row.dataset.metric, row.querySelector('.value').dataset.value]));
  assert.deepEqual(
    cells,
    Object.entries(report.metrics).map(([id, { value }]) => [id, String(value)]),
  );
});

test('parameters are there, an alignment is not', async () => {
  await page.locator('#run summary').click();
  const titles = await page.locator('#run h3').allTextContents();
  assert.deepEqual(titles, ['Command', 'Parameters', 'Run']);
});

test('an infinite fidelity is no dash', async () => {
  const pair = await open(exact);
  assert.equal(await pair.locator('tr[data-metric=color_fidelity] .value').textContent(), '∞');
  await pair.close();
});
