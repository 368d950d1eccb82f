// Parameters, alignment, the run, and what other tools would print.
import type { Json, JsonValue, Report } from './contract';
import { element } from './dom';
import { dash, exact, number, short } from './format';
import { flatten } from './records';
import { factList } from './table';

function block(title: string, ...content: (Node | undefined)[]): HTMLElement {
  return element('div', { class: 'block' }, element('h3', {}, title), ...content);
}

function matrix(rows: JsonValue | undefined): HTMLElement | undefined {
  if (!Array.isArray(rows)) return undefined;
  const lines = (rows as number[][]).map((row) =>
    element('tr', {}, ...row.map((value) => element('td', { title: exact(value) }, number(value)))),
  );
  return element('table', { class: 'matrix' }, element('caption', {}, 'T_ref_est'), element('tbody', {}, ...lines));
}

function without(record: Json, ...names: string[]): Json {
  return Object.fromEntries(Object.entries(record).filter(([name]) => !names.includes(name)));
}

function bar(share: number): HTMLElement {
  const made = element('div', { class: 'share', 'aria-hidden': 'true' });
  made.style.width = `${100 * share}%`;
  return made;
}

/** Seconds of each stage, with bars to compare them. */
function stageTable(stages: JsonValue | undefined): HTMLElement | undefined {
  const entries = Object.entries((stages ?? {}) as Record<string, number>);
  if (entries.length === 0) return undefined;
  const largest = Math.max(...entries.map(([, seconds]) => seconds));
  const rows = entries.map(([name, seconds]) =>
    element(
      'tr',
      {},
      element('th', { scope: 'row' }, name),
      element('td', { class: 'number', title: exact(seconds) }, `${number(seconds)} s`),
      element('td', { class: 'bars' }, largest > 0 ? bar(seconds / largest) : undefined),
    ),
  );
  return element('table', { class: 'stages' }, element('caption', {}, 'Time by stage'), element('tbody', {}, ...rows));
}

function levelCell(name: string, value: JsonValue): HTMLElement {
  if (typeof value !== 'number') return element('td', { class: 'number' }, dash);
  return element('td', { class: 'number', title: exact(value) }, name === 'threshold_m' ? short(value) : number(value));
}

/** One row per threshold, one column per number. */
function levelTable(levels: Json[]): HTMLElement {
  const names = Object.keys(levels[0]);
  const title = (name: string) => (name === 'threshold_m' ? 'threshold [m]' : name.replaceAll('_', ' '));
  const head = names.map((name) => element('th', { scope: 'col' }, title(name)));
  const rows = levels.map((level) => element('tr', {}, ...names.map((name) => levelCell(name, level[name]))));
  return element(
    'table',
    { class: 'levels' },
    element('thead', {}, element('tr', {}, ...head)),
    element('tbody', {}, ...rows),
  );
}

/** What another tool prints for this pair. */
function toolBlock(tool: string, record: JsonValue): HTMLElement {
  if (typeof record !== 'object' || record === null) return block(tool, element('p', {}, 'No value: see the warnings.'));
  const { definition, per_threshold: levels, ...rest } = record as Json;
  return element(
    'div',
    { class: 'tool' },
    element('h4', {}, tool),
    element('p', {}, String(definition ?? '')),
    Array.isArray(levels) && levels.length > 0 ? levelTable(levels as Json[]) : undefined,
    factList(flatten(rest)),
  );
}

export function showRun(section: HTMLElement, report: Report): void {
  const { parameters, alignment, run, aliases } = report;
  const details = element(
    'details',
    {},
    element('summary', {}, element('h2', { id: 'run-title' }, 'Parameters and run')),
    block('Command', element('pre', {}, String(run.command ?? ''))),
    block('Parameters', factList(Object.entries(parameters))),
    alignment
      ? block('Alignment', factList(flatten(without(alignment, 'T_ref_est'))), matrix(alignment.T_ref_est))
      : undefined,
    block('Run', factList(flatten(without(run, 'command', 'stages'))), stageTable(run.stages)),
    aliases && block('Other tools on this pair', ...Object.entries(aliases).map(([tool, record]) => toolBlock(tool, record))),
  );
  addEventListener('beforeprint', () => (details.open = true)); // a sheet of paper cannot be unfolded
  section.append(details);
}
