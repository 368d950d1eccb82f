// The pages of tables in a real browser: the one of CMAP_LEADERBOARD on the sample maps beside the paper's numbers, and
// one of CMAP_COMPARE. Needs what browser.mjs says.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { launch, outlineFaults, source } from './browser.mjs';

const folder = mkdtempSync(join(tmpdir(), 'cmap-leaderboard-'));
process.on('exit', () => rmSync(folder, { recursive: true }));

function makePages() {
  const samples = JSON.parse(readFileSync(join(source, 'benchmarks/leaderboard/samples.json'), 'utf8'));
  samples.published = JSON.parse(readFileSync(join(source, 'benchmarks/leaderboard/paper.json'), 'utf8'));
  const manifest = join(folder, 'manifest.json');
  writeFileSync(manifest, JSON.stringify(samples));
  const board = join(folder, 'board');
  const data = ['--data-root', join(source, 'data_samples')];
  const plain = join(folder, 'plain.html');
  execFileSync(process.env.CMAP_LEADERBOARD, [manifest, ...data, '-o', board, '--quiet', '--plain-ranking']);
  copyFileSync(join(board, 'index.html'), plain);
  execFileSync(process.env.CMAP_LEADERBOARD, [manifest, ...data, '-o', board, '--quiet']);
  const reports = ['estimate', 'the~20reference~20itself'].map((name) => join(board, 'pairs/town', name, 'report.json'));
  const comparison = join(folder, 'comparison.html');
  const names = ['--names', 'estimate,reference', '--baseline', reports[0]];
  execFileSync(process.env.CMAP_COMPARE, [...reports, ...names, '--format', 'html', '-o', comparison]);
  return [join(board, 'index.html'), plain, comparison];
}

const [leaderboard, plainRanking, comparison] = makePages();
const messages = [];
const requests = [];
let browser;
let page;

async function open(path, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const opened = await context.newPage();
  opened.on('console', (message) => messages.push(`console: ${message.text()}`));
  opened.on('pageerror', (error) => messages.push(`error: ${error}`));
  opened.on('request', (request) => requests.push(request.url()));
  await opened.goto(pathToFileURL(path).href);
  await opened.locator('html[data-ready]').waitFor({ state: 'attached' });
  return opened;
}

before(async () => {
  browser = await launch();
  page = await open(leaderboard);
});
after(() => browser.close());

const published = (id) => page.locator(`[id="published-${id}"]`);
const rowNames = (table) => table.locator('tbody th').allTextContents();
const heading = (table, column) => table.locator('thead th').nth(column);
const order = (table, column) => heading(table, column).getAttribute('aria-sort');

test('the mouse sorts by values, then the other way, then not at all', async () => {
  const table = published('chamfer');
  assert.deepEqual(await rowNames(table), ['V-Long', 'V-Sim(3)', 'SLAM3R', 'V-SL(4)', 'Ours']);
  const sort = heading(table, 1).locator('button');
  await sort.click();
  assert.equal(await order(table, 1), 'ascending');
  assert.deepEqual(await rowNames(table), ['Ours', 'V-Sim(3)', 'V-Long', 'SLAM3R', 'V-SL(4)'], 'the failed one last');
  await sort.click();
  assert.equal(await order(table, 1), 'descending');
  assert.deepEqual(await rowNames(table), ['SLAM3R', 'V-Long', 'V-Sim(3)', 'Ours', 'V-SL(4)'], 'and last again');
  await sort.click();
  assert.equal(await order(table, 1), 'none');
  assert.deepEqual(await rowNames(table), ['V-Long', 'V-Sim(3)', 'SLAM3R', 'V-SL(4)', 'Ours']);
});

test('the keyboard sorts and goes from heading to heading', async () => {
  const table = published('overlap');
  await heading(table, 0).locator('button').focus();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Enter');
  assert.equal(await order(table, 1), 'ascending');
  assert.deepEqual(await rowNames(table), ['V-Sim(3)', 'V-Long', 'SLAM3R', 'Ours', 'V-SL(4)']);
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Space');
  assert.equal(await order(table, 1), 'none', 'one column at a time');
  assert.equal(await order(table, 2), 'ascending');
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('Enter');
  assert.deepEqual(await rowNames(table), ['Ours', 'SLAM3R', 'V-Long', 'V-Sim(3)', 'V-SL(4)'], 'names as text');
});

const looksOf = (opened) =>
  opened
    .locator('[id="published-chamfer"] tbody td:nth-child(2)')
    .evaluateAll((all) => all.map((cell) => [cell.className, getComputedStyle(cell).backgroundColor]));

test('best and second best are marked, and differ from each other and the rest', async () => {
  const looks = await looksOf(await open(plainRanking));
  const color = (name) => looks.find(([look]) => look === name)[1];
  assert.equal(looks.filter(([look]) => look === 'value best').length, 1);
  assert.equal(new Set(['value best', 'value second', 'value'].map(color)).size, 3);
});

test('the best of what nobody tested has a look of its own, and there is no second', async () => {
  const looks = await looksOf(page);
  const color = (name) => looks.find(([look]) => look === name)[1];
  assert.equal(looks.filter(([look]) => look === 'value untested').length, 1);
  assert.notEqual(color('value untested'), color('value'));
  assert.ok(looks.every(([look]) => !/best|second/.test(look)));
});

test('color distances have their normalized columns and a footnote', async () => {
  const table = published('color_distance');
  const headings = (await table.locator('thead th').allTextContents()).map((text) => text.trim());
  assert.equal(headings.filter((text) => text === 'of 255').length, 5);
  const first = await table.locator('tbody tr').first().locator('td').allTextContents();
  assert.deepEqual(first.slice(0, 2), ['130.49', '64.99']);
  assert.match(await page.locator('body').textContent(), /published color distances stand on different scales/);
});

test('every link and picture is there', async () => {
  const links = await page.locator('a').evaluateAll((all) => all.map((link) => link.href));
  assert.ok(links.length > 20, `${links.length} links`);
  for (const link of links) {
    const url = new URL(link);
    assert.equal(url.protocol, 'file:');
    assert.ok(existsSync(fileURLToPath(link.split('#')[0])), link);
    if (url.hash) assert.equal(await page.locator(`[id="${decodeURIComponent(url.hash.slice(1))}"]`).count(), 1, link);
  }
  for (const picture of await page.locator('img').all()) {
    await picture.scrollIntoViewIfNeeded();
    await picture.evaluate((image) => image.decode());
    assert.ok((await picture.evaluate((image) => image.naturalWidth)) > 100);
  }
});

test('a report opens from its link', async () => {
  const opened = await open(leaderboard);
  await opened.locator('#pairs a', { hasText: 'report' }).first().click();
  await opened.locator('h1', { hasText: 'estimate.ply against reference.ply' }).waitFor();
  await opened.context().close();
});

test('a narrow page in the dark is not wider than its screen', async () => {
  const narrow = await open(leaderboard, { viewport: { width: 400, height: 800 }, colorScheme: 'dark' });
  const excess = await narrow.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(excess <= 0, `${excess} px wider`);
  const background = await narrow.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
  assert.equal(background, 'rgb(21, 24, 28)');
  await narrow.context().close();
});

test('a comparison sorts too', async () => {
  const opened = await open(comparison);
  const table = opened.locator('#scores');
  await heading(table, 0).locator('button').click();
  const names = await rowNames(table);
  assert.deepEqual(names, [...names].sort(new Intl.Collator('en', { numeric: true }).compare));
  assert.ok((await opened.locator('#gains td.better').count()) > 0);
  await opened.context().close();
});

test('one main landmark, and headings in order', async () => {
  assert.deepEqual(await outlineFaults(page), []);
  const opened = await open(comparison);
  assert.deepEqual(await outlineFaults(opened), []);
  await opened.context().close();
});

test('nothing is fetched from elsewhere and nothing is wrong', () => {
  assert.deepEqual(messages.filter((text) => !text.includes('GPU stall')), []);
  assert.deepEqual(requests.filter((url) => !/^(file|blob|data):/.test(url)), []);
});
