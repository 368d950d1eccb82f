// The table of metrics: sortable by each column, every row with its definition, counts and parameters, and where the
// report has them with floor, chance and skill.
import type { JsonValue } from './contract';
import { element } from './dom';
import { count, dash, exact, number, short, unitText } from './format';
import { type LevelId, levelIds, levelText } from './levels';
import type { MetricRow } from './records';
import { describe } from './tooltip';

interface Column {
  id: string;
  title: string;
  compare: (a: MetricRow, b: MetricRow) => number;
  /** Of columns of numbers: rows without one come last, whichever way they are sorted. */
  of?: (row: MetricRow) => number | null;
  /** What stands in it. */
  about?: string;
}

type Order = 'none' | 'ascending' | 'descending';

const byText = (of: (row: MetricRow) => string) => (a: MetricRow, b: MetricRow) => of(a).localeCompare(of(b), 'en');

function numbers(id: string, title: string, of: (row: MetricRow) => number | null): Column {
  return { id, title, of, compare: (a, b) => of(a)! - of(b)! };
}

function level(id: LevelId, title: string, about: string): Column {
  return { ...numbers(id, title, (row) => row.levels[id]?.value ?? null), about };
}

const allColumns: Column[] = [
  { id: 'symbol', title: 'Symbol', compare: byText((row) => row.metric.symbol) },
  { id: 'metric', title: 'Metric', compare: byText((row) => row.metric.title) },
  numbers('value', 'Value', (row) => row.value),
  { id: 'unit', title: 'Unit', compare: byText((row) => row.metric.unit) },
  level('floor', 'Floor', 'What a perfect map could be expected to score: the reference against itself.'),
  level('chance', 'Chance', 'What the estimate would score with its colors shuffled among its points.'),
  level('skill', 'Skill', 'How far the value is from chance (0) to floor (1); below 0 it is worse than chance.'),
  { id: 'better', title: 'Better', compare: byText((row) => row.metric.better) },
  { id: 'group', title: 'Group', compare: byText((row) => row.metric.group) },
];

function sorted(rows: MetricRow[], column: Column, order: Order): MetricRow[] {
  const sign = { none: 0, ascending: 1, descending: -1 }[order];
  const isLast = (row: MetricRow) => Number(column.of?.(row) === null);
  return [...rows].sort((a, b) => {
    if (sign === 0) return a.order - b.order;
    const missing = isLast(a) - isLast(b);
    if (missing !== 0 || isLast(a)) return missing || a.order - b.order;
    return sign * column.compare(a, b) || a.order - b.order;
  });
}

function valueCell(row: MetricRow): HTMLElement {
  if (row.value === null) {
    const text = row.infinite ? '∞' : dash;
    return element('td', { class: 'value none', 'data-value': 'null', title: row.reason }, text);
  }
  return element('td', { class: 'value', 'data-value': exact(row.value), title: exact(row.value) }, number(row.value));
}

function levelCell(row: MetricRow, id: LevelId): HTMLElement {
  const level = row.levels[id];
  if (!level) return element('td', { class: id });
  if (level.value === null) return element('td', { class: `${id} none`, 'data-value': 'null', title: level.reason }, dash);
  return element('td', { class: id, 'data-value': exact(level.value), title: exact(level.value) }, levelText(id, level.value));
}

const arrows: Record<string, string> = { lower: '↓', higher: '↑' };

function factText(value: JsonValue): string {
  if (Array.isArray(value)) return value.map(factText).join(', ') || 'none';
  if (typeof value === 'number') return Number.isInteger(value) ? count(value) : short(value);
  return value === null ? dash : String(value);
}

/** A list of names and values, each value with all its digits as title. */
export function factList(facts: [string, JsonValue][]): HTMLElement {
  const list = element('dl', { class: 'facts wide' });
  for (const [name, value] of facts) {
    const whole = Array.isArray(value) ? value.join(', ') : String(value);
    list.append(element('div', {}, element('dt', {}, name), element('dd', { title: whole }, factText(value))));
  }
  return list;
}

function detailRow(row: MetricRow, id: string, columns: Column[]): HTMLTableRowElement {
  const texts = [row.metric.definition, row.reason, ...row.levelReasons].filter(Boolean);
  return element(
    'tr',
    { class: 'details', id, hidden: true },
    element(
      'td',
      { colspan: columns.length },
      ...texts.map((text) => element('p', {}, text)),
      row.value === null ? undefined : factList([['exactly', exact(row.value)] as [string, JsonValue], ...row.facts]),
    ),
  );
}

function metricCell(row: MetricRow, details: HTMLTableRowElement): HTMLElement {
  const open = element(
    'button',
    { type: 'button', class: 'term', 'aria-expanded': 'false', 'aria-controls': details.id },
    element('span', { class: 'name' }, row.metric.title),
    row.qualifier && element('span', { class: 'qualifier' }, ` ${row.qualifier}`),
  );
  open.addEventListener('click', () => {
    details.hidden = !details.hidden;
    open.setAttribute('aria-expanded', String(!details.hidden));
  });
  const { definition } = row.metric;
  const description = definition ? describe(open, definition, `about-${row.order}`) : undefined;
  return element('th', { scope: 'row' }, open, description);
}

function tableRows(row: MetricRow, columns: Column[]): HTMLTableRowElement[] {
  const { metric } = row;
  const data = Object.fromEntries(Object.entries(row.key).map(([name, value]) => [`data-${name}`, value]));
  const details = detailRow(row, `details-${row.order}`, columns);
  const levels = levelIds.filter((id) => columns.some((column) => column.id === id));
  const shown = element(
    'tr',
    { 'data-metric': metric.id, ...data, class: row.first ? 'metric first' : 'metric' },
    element('td', { class: 'symbol' }, metric.symbol),
    metricCell(row, details),
    valueCell(row),
    element('td', { class: 'unit' }, unitText(metric.unit)),
    ...levels.map((id) => levelCell(row, id)),
    element(
      'td',
      { class: 'better', title: metric.better },
      element('span', { 'aria-hidden': 'true' }, arrows[metric.better] ?? ''),
      element('span', { class: 'word' }, ` ${metric.better}`),
    ),
    element('td', { class: 'group' }, metric.group),
  );
  return [shown, details];
}

const nextOrder: Record<Order, Order> = { none: 'ascending', ascending: 'descending', descending: 'none' };

/** Headers cycle through ascending, descending and the order of the report. */
function headerRow(columns: Column[], onSort: (column: Column, order: Order) => void): HTMLTableRowElement {
  const headers = columns.map((column) => {
    const header = element('th', { scope: 'col', class: column.id, 'data-column': column.id, 'aria-sort': 'none' });
    const sort = element('button', { type: 'button', class: 'sort' }, column.title);
    sort.addEventListener('click', () => {
      const order = nextOrder[header.getAttribute('aria-sort') as Order];
      for (const other of headers) other.setAttribute('aria-sort', other === header ? order : 'none');
      onSort(column, order);
    });
    header.append(sort);
    if (column.about) header.append(describe(sort, column.about, `about-${column.id}`));
    return header;
  });
  return element('tr', {}, ...headers);
}

export function metricTable(rows: MetricRow[], caption: string): HTMLTableElement {
  const hasLevels = rows.some((row) => Object.keys(row.levels).length > 0);
  const columns = allColumns.filter(({ id }) => hasLevels || !levelIds.some((level) => level === id));
  const made = new Map(rows.map((row) => [row, tableRows(row, columns)]));
  const body = element('tbody', {}, ...[...made.values()].flat());
  const table = element('table', { class: hasLevels ? 'metrics with-levels' : 'metrics' });
  const head = headerRow(columns, (column, order) => {
    body.replaceChildren(...sorted(rows, column, order).flatMap((row) => made.get(row)!));
    table.classList.toggle('sorted', order !== 'none');
  });
  table.append(element('caption', {}, caption), element('thead', {}, head), body);
  return table;
}
