// What a number is worth, on the page, in a real browser: node html_levels_test.mjs, with CMAP_EVAL and what browser.mjs
// needs. The levels are written into the report of a page by hand, so that each of them is known.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { contrast, launch, outlineFaults, source } from './browser.mjs';

const folder = mkdtempSync(join(tmpdir(), 'cmap-html-'));
const path = join(folder, 'report.html');
const maps = ['reference.ply', 'estimate.ply'].map((name) => join(source, 'data_samples/town', name));
execFileSync(process.env.CMAP_EVAL, [...maps, '--html', path, '--quiet']);
const html = readFileSync(path, 'utf8');
rmSync(folder, { recursive: true });

const data = /(<script[^>]* id="cmap-report">)([^<]*)(<\/script>)/;
const levelIds = ['floor', 'chance', 'skill'];
const saturated = 'the floor is no better than chance';
const sparse = 'the reference has no neighbors within 0.01 m';

/** The report as one without levels. */
function bare() {
  const report = JSON.parse(html.match(data)[2]);
  for (const record of Object.values(report.metrics)) {
    for (const entry of [record, ...(record.per_threshold ?? [])]) {
      for (const id of [...levelIds, 'phases', 'skill_map']) delete entry[id];
    }
  }
  delete report.metrics.local_color_recall.curve.chance;
  return report;
}

function withLevels() {
  const report = bare();
  const { color_distance, local_color_recall, accuracy, average_wasserstein, spatial_consistency } = report.metrics;
  Object.assign(color_distance, {
    floor: { value: 0.0881234, se: 0.0002, n: 50000 },
    chance: { value: 0.4151234, se: 0.0009, n: 41950 },
    skill: { value: 0.8271234, se: 0.002 },
  });
  Object.assign(local_color_recall, {
    floor: { value: 0.99, se: 0.001, n: 50000 },
    chance: { value: 0.995, se: 0.001, n: 20000 },
    skill: { value: null, reason: saturated },
    skill_map: {
      tau: [0.2 * 0.1, 0.1], // 0.020000000000000004
      n: 2000,
      per_radius: [
        { radius_m: 0.1, value: [0.3, 0.5], floor: [0.6, 0.7], chance: [0.1, 0.4], skill: [0.4, -0.25] },
        { radius_m: 0.5, value: [0.8, 0.9], floor: [0.9, 0.99], chance: [0.7, 0.995], skill: [0.55, null] },
      ],
    },
  });
  local_color_recall.curve.chance = local_color_recall.curve.value.map((value) => value / 2);
  accuracy.per_threshold.forEach((entry, i) => {
    entry.floor = entry.threshold_m === 0.01 ? { value: null, n: 0, reason: sparse } : { value: 0.01 * (i + 1), se: 0, n: 9 };
  });
  average_wasserstein.phases = {
    n: 7, mean: 0.169, std: 0.01, min: 0.151, max: 0.19, values: [0.152, 0.19, null, 0.151, 0.17, 0.17, 0.17, 0.18],
  };
  spatial_consistency.phases = { n: 0, mean: null, std: null, min: null, max: null, values: Array(8).fill(null) };
  return report;
}

const report = withLevels();
let browser;
const messages = [];

async function open(content, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, ...options });
  page.on('console', (message) => messages.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => messages.push(`error: ${error}`));
  const text = JSON.stringify(content).replaceAll('<', '\\u003c');
  const body = html.replace(data, (_, head, __, tail) => head + text + tail);
  await page.route('http://levels.test/', (route) => route.fulfill({ contentType: 'text/html; charset=utf-8', body }));
  await page.goto('http://levels.test/');
  await page.locator('html[data-ready]').waitFor({ state: 'attached', timeout: 60_000 });
  return page;
}

let page;
before(async () => {
  browser = await launch();
  page = await open(report);
});
after(() => browser.close());

/** Every level of the report: where it stands, and its value. */
function levelsOfReport() {
  return Object.entries(report.metrics).flatMap(([id, record]) =>
    (record.per_threshold ?? [record]).flatMap((entry) => {
      const row = `tr[data-metric=${id}]${record.per_threshold ? `[data-threshold="${entry.threshold_m}"]` : ''}`;
      return levelIds.filter((level) => entry[level]).map((level) => [`${row} td.${level}`, entry[level].value]);
    }),
  );
}

test('the table holds every level exactly', async () => {
  const levels = levelsOfReport();
  assert.equal(levels.length, 11);
  for (const [selector, value] of levels) {
    const cell = page.locator(selector);
    assert.equal(JSON.parse(await cell.getAttribute('data-value')), value, selector);
    const shown = await cell.textContent();
    if (value === null) assert.equal(shown, '–', selector);
    else assert.ok(Math.abs(Number(shown) - value) <= 6e-4 * Math.abs(value), `${selector}: ${value} shown as ${shown}`);
  }
  assert.equal(await page.locator('#metrics td:is(.floor, .chance, .skill)[data-value]').count(), levels.length, 'no others');
  assert.equal(await page.locator('tr[data-metric=rmse] td.floor').textContent(), '', 'of a metric without them: blank');
});

test('a level without a value says why: below the table, on its cell and in the details', async () => {
  assert.deepEqual(await page.locator('.level-notes li').allTextContents(), [
    `No skill of LCR: ${saturated}`,
    `No floor of AC at 0.01 m: ${sparse}`,
  ]);
  const row = page.locator('tr[data-metric=local_color_recall]');
  assert.equal(await row.locator('td.skill').getAttribute('title'), saturated);
  await row.locator('.term').click();
  const details = page.locator('tr[data-metric=local_color_recall] + tr.details');
  assert.match(await details.textContent(), new RegExp(`No skill: ${saturated}`));
  assert.doesNotMatch(await details.textContent(), /skill map|per radius/, 'levels have places of their own');
  assert.match(await details.textContent(), /chance0\.9950, standard error 0\.001, from 20,000/);
});

test('the columns say what they are, and sort', async () => {
  const sort = page.locator('th[data-column=skill] button');
  const about = page.locator(`[id="${await sort.getAttribute('aria-describedby')}"]`);
  assert.match(await about.textContent(), /chance \(0\) to floor \(1\)/);
  await sort.click();
  const first = page.locator('tr.metric').first();
  assert.equal(await first.getAttribute('data-metric'), 'color_distance', 'rows without a skill come last');
  await sort.click();
  assert.equal(await first.getAttribute('data-metric'), 'color_distance', 'whichever way');
  await sort.click();
});

test('a report without levels has no columns for them, and no figures', async () => {
  const old = await open(bare());
  const columns = await old.locator('.metrics thead th').evaluateAll((found) => found.map((th) => th.dataset.column));
  assert.deepEqual(columns, ['symbol', 'metric', 'value', 'unit', 'better', 'group']);
  for (const id of ['#phases', '#skill-map', '.level-notes']) assert.equal(await old.locator(id).count(), 0, id);
  assert.equal(await old.locator('[data-chart=recall-curve] .chart-legend .item').count(), 1);
  assert.equal(await old.locator('tr.details td').first().getAttribute('colspan'), String(columns.length));
  await old.close();
});

test('phases stand as a band and as a strip', async () => {
  const row = page.locator('tr[data-phases=average_wasserstein]');
  const cells = await row.locator('th, td').allTextContents();
  assert.deepEqual(cells.slice(2, 6), ['0.169 ± 0.010', '0.1510 to 0.1900', 'm', '7 of 8']);
  const places = await row.locator('circle').evaluateAll((dots) => dots.map((dot) => Number(dot.getAttribute('cx'))));
  const values = report.metrics.average_wasserstein.phases.values.filter((value) => value !== null);
  const scale = (places[1] - places[0]) / (values[1] - values[0]);
  assert.equal(places.length, 7, 'a dot for each grid that has a value');
  places.forEach((x, i) => assert.ok(Math.abs(x - places[0] - scale * (values[i] - values[0])) < 1e-6, `dot ${i}`));
  const none = await page.locator('tr[data-phases=spatial_consistency] td').allTextContents();
  assert.deepEqual(none.slice(1), ['–', '–', '', '0 of 8', ''], 'no grid has a value');
});

test('the curve of recall is drawn with its chance', async () => {
  const figure = page.locator('[data-chart=recall-curve]');
  assert.equal(await figure.locator('.line.dashed').count(), 1);
  assert.match(await figure.locator('.item').nth(1).textContent(), /chance/);
  await figure.locator('.plot').focus();
  await page.keyboard.press('ArrowRight');
  const [value, chance] = (await figure.locator('.number').allTextContents()).map((text) => parseFloat(text));
  assert.ok(value > 0 && Math.abs(chance - value / 2) < 0.01, `${value} and ${chance}`);
});

test('the map of skill is a table that says where it is highest', async () => {
  const figure = page.locator('#skill-map');
  const cells = await figure.locator('td').evaluateAll((found) => found.map((td) => JSON.parse(td.dataset.value)));
  assert.deepEqual(cells, [0.4, -0.25, 0.55, null]);
  assert.deepEqual(await figure.locator('thead th').allTextContents(), ['r \\ tau', '0.02', '0.1']);
  assert.deepEqual(await figure.locator('td.used').evaluateAll((found) => found.map((td) => td.dataset.value)), ['null']);
  assert.match(await figure.locator('td.used').textContent(), /as evaluated/);
  const notes = (await figure.locator('.note').allTextContents()).join(' ');
  assert.match(notes, /radius 0\.5 m and tau 0\.1 \(framed\): no skill: the floor is no better than chance\./);
  assert.match(notes, /Highest: 0\.550 at radius 0\.5 m and tau 0\.02\./);
});

test('parameters that are not on the map of skill frame nothing', async () => {
  const other = withLevels();
  other.metrics.local_color_recall.parameters.radius_m = 0.3;
  const opened = await open(other);
  assert.equal(await opened.locator('#skill-map td.used').count(), 0);
  assert.match(await opened.locator('#skill-map').textContent(), /radius 0\.3 m and tau 0\.1: no skill/);
  await opened.close();
});

test('levels are readable in light and dark', async () => {
  for (const colorScheme of ['light', 'dark']) {
    const opened = await open(report, { colorScheme });
    const samples = await opened.evaluate(() => {
      const background = (element) => {
        for (let at = element; at; at = at.parentElement) {
          const color = getComputedStyle(at).backgroundColor;
          if (color !== 'rgba(0, 0, 0, 0)') return color;
        }
        return 'rgb(255, 255, 255)';
      };
      const found = document.querySelectorAll('#skill-map td, #skill-map th, td.floor, td.skill, .level-notes li, .phases :is(th, td)');
      return [...found].map((each) => [each.textContent, getComputedStyle(each).color, background(each)]);
    });
    for (const [text, color, behind] of samples) {
      assert.ok(contrast(color, behind) >= 4.5, `${colorScheme}: "${text}": ${color} on ${behind}`);
    }
    await opened.close();
  }
});

test('400 pixels are wide enough, with the skill among them', async () => {
  const opened = await open(report, { viewport: { width: 400, height: 800 } });
  assert.ok((await opened.evaluate('document.documentElement.scrollWidth')) <= 400, 'the page');
  for (const frame of await opened.locator('.table-frame').all()) {
    const [needed, given] = await frame.evaluate((box) => [box.scrollWidth, box.clientWidth]);
    assert.ok(needed <= given, `${needed} of ${given} pixels: ${(await frame.textContent()).slice(0, 40)}`);
  }
  assert.ok(await opened.locator('tr[data-metric=color_distance] td.skill').isVisible());
  assert.ok(await opened.locator('tr[data-metric=color_distance] td.floor').isHidden(), 'it is in the details');
  await opened.close();
});

test('headings are in order, and the console is empty', async () => {
  assert.deepEqual(await outlineFaults(page), []);
  assert.deepEqual(messages, []);
});
