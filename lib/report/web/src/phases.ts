// Where the grid of voxels begins: the values of metrics on grids that begin at other places, as numbers and as a strip.
import type { Report } from './contract';
import { element, vector } from './dom';
import { count, dash, exact, number, unitText } from './format';
import { bandText, type Phases, phasesOf } from './levels';
import type { Metric } from './records';

const [width, height, margin] = [240, 22, 7];

/** From nothing to the largest value, so that a strip shows how much of the value the grid decides. */
function strip(phases: Phases, value: number | null): Element {
  const known = phases.values.filter((v): v is number => v !== null);
  const end = Math.max(...known, value ?? 0, Number.MIN_VALUE);
  const x = (v: number) => margin + (width - 2 * margin) * (v / end);
  const dots = known.map((v) => vector('circle', { class: 'phase', cx: x(v), cy: height / 2, r: 3.5 }));
  const used = value === null ? [] : [vector('path', { class: 'used', d: `M${x(value)} 2V${height - 2}` })];
  return vector(
    'svg',
    { class: 'strip', viewBox: `0 0 ${width} ${height}`, width, height, 'aria-hidden': 'true' },
    vector('path', { class: 'axis', d: `M${margin} ${height / 2}H${width - margin}M${margin} 6V${height - 6}` }),
    ...dots,
    ...used,
  );
}

const numberCell = (value: number | null) =>
  element('td', { class: 'number', ...(value !== null && { title: exact(value) }) }, value === null ? dash : number(value));

function row(metric: Metric, value: number | null, phases: Phases): HTMLElement {
  const { n, mean, std, min, max, values } = phases;
  const known = mean !== null && std !== null && min !== null && max !== null;
  return element(
    'tr',
    { 'data-phases': metric.id },
    element('th', { scope: 'row' }, metric.symbol || metric.title),
    numberCell(value),
    element('td', { class: 'number' }, known ? bandText(mean, std) : dash),
    element('td', { class: 'number' }, known ? `${number(min)} to ${number(max)}` : dash),
    element('td', {}, unitText(metric.unit)),
    element('td', { class: 'number grids' }, n === values.length ? count(n) : `${n} of ${values.length}`),
    element('td', { class: 'strips' }, known ? strip(phases, value) : undefined),
  );
}

const titles = ['Metric', 'Value', 'Mean ± deviation', 'Range', 'Unit', 'Grids', 'From 0 to the largest'];

/** Nothing where no metric of the report has phases. */
export function phasesBlock(report: Report, metrics: Metric[]): HTMLElement | undefined {
  const rows = metrics.flatMap((metric) => {
    const record = report.metrics[metric.id];
    const phases = phasesOf(record);
    return phases ? [row(metric, typeof record.value === 'number' ? record.value : null, phases)] : [];
  });
  if (rows.length === 0) return undefined;
  const head = titles.map((title) => element('th', { scope: 'col' }, title));
  return element(
    'div',
    { class: 'block', id: 'phases' },
    element('h3', {}, 'Where the grid begins'),
    element(
      'p',
      { class: 'note' },
      'The value is of voxels that begin at the world’s origin (the line). On grids that begin elsewhere within a voxel ' +
        'the same maps have other values (the dots): differences smaller than their scatter say nothing.',
    ),
    element(
      'div',
      { class: 'table-frame' },
      element('table', { class: 'phases' }, element('thead', {}, element('tr', {}, ...head)), element('tbody', {}, ...rows)),
    ),
  );
}
