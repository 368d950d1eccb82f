// The page: each section by itself, so that damage to one leaves the others.
import { chartSpecs } from './chart_data';
import { showCharts } from './charts';
import type { Page, Report } from './contract';
import { readMaps, readPage, readReport, reportText } from './data';
import { element, message, section } from './dom';
import { showHeader } from './header';
import { levelNotes } from './level_notes';
import { showMap } from './map_view';
import { metricRows } from './records';
import { phasesBlock } from './phases';
import { showRun } from './run_info';
import { skillMap } from './skill_map';
import './style.css';
import { metricTable } from './table';
import { followTheme } from './theme';
import { followTooltips } from './tooltip';

const titles: Record<string, string> = { map: 'Map', metrics: 'Metrics', charts: 'Distributions' };

/** Fills a section, or says in it why that was not possible. */
async function fill(id: string, show: (place: HTMLElement) => void | Promise<void>): Promise<void> {
  const place = section(id);
  if (titles[id]) place.append(element('h2', { id: `${id}-title` }, titles[id]));
  try {
    await show(place);
  } catch (error) {
    place.append(message(error instanceof Error ? error.message : String(error)));
  }
}

/** What `read` gives; a failure is told in the head of the page. */
function readOrTell<T>(read: () => T): T | undefined {
  try {
    return read();
  } catch (error) {
    section('head').append(message((error as Error).message));
    return undefined;
  }
}

async function showFirstFrame(page: Page): Promise<void> {
  await fill('map', async (place) => showMap(place, page, await readMaps(page.maps)));
  performance.mark('cmap-first-frame');
}

async function showReport(report: Report, page: Page | undefined): Promise<void> {
  showHeader(section('head'), report, page?.title ?? 'Map evaluation', reportText());
  const frame = page && showFirstFrame(page);
  await fill('metrics', (place) => {
    const caption = report.inputs.reference ? 'Metrics of the estimate against the reference' : 'Metrics of the map';
    const rows = metricRows(report, page);
    place.append(element('div', { class: 'table-frame' }, metricTable(rows, caption)));
    const notes = levelNotes(rows);
    if (notes) place.append(notes);
    const phases = phasesBlock(report, rows.filter(({ first }) => first).map(({ metric }) => metric));
    if (phases) place.append(phases);
  });
  // The map comes first. A page in the background draws no frame: there the rest does not wait for one.
  await Promise.race([frame, new Promise((resolve) => setTimeout(resolve, 2000))]);
  await fill('charts', (place) => {
    const charts = chartSpecs(report, page?.distributions ?? []);
    const figures = [skillMap(report)].filter((figure) => figure !== undefined);
    if (charts.length + figures.length > 0) showCharts(place, charts, figures);
    else place.hidden = true; // as of one map
  });
  await fill('run', (place) => showRun(place, report));
  await frame;
  document.documentElement.dataset.ready = '';
}

followTheme();
followTooltips();
const report = readOrTell(readReport);
const page = report && readOrTell(readPage);
if (report) void showReport(report, page);
