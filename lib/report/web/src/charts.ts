// Line charts with axes, a readout under the pointer or by arrow keys, and colors of the theme.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { ChartSpec } from './chart_data';
import { button, element } from './dom';
import { dash, number, short } from './format';
import { onThemeChange, themeColor } from './theme';

const height = 260;
const font = '12px system-ui, sans-serif';
const seriesColor = (index: number) => `series-${index + 1}`;

function valueText(spec: ChartSpec, value: number | null | undefined): string {
  if (value === null || value === undefined) return dash;
  return spec.yShare ? `${(100 * value).toFixed(2)} %` : number(value);
}

function axis(label: string, size: number, share: boolean): uPlot.Axis {
  const percentText = (value: number) => `${short(100 * value)} %`;
  return {
    label,
    labelFont: font,
    font,
    labelSize: 22,
    size,
    stroke: () => themeColor('muted'),
    grid: { stroke: () => themeColor('grid'), width: 1 },
    ticks: { stroke: () => themeColor('grid'), width: 1 },
    values: (_, splits) => splits.map((value) => (share ? percentText(value) : short(value))),
  };
}

function series(spec: ChartSpec): uPlot.Series[] {
  return spec.series.map(({ dashed }, i) => ({
    stroke: () => themeColor(seriesColor(i)),
    width: 1.75,
    ...(dashed && { dash: [6, 5] }),
    points: { show: spec.kind === 'dots' && !dashed, size: 6, fill: () => themeColor(seriesColor(i)) },
    ...(spec.kind === 'steps' && {
      paths: uPlot.paths.stepped!({ align: 1 }),
      fill: () => `${themeColor(seriesColor(i))}22`,
    }),
  }));
}

function drawMark(spec: ChartSpec): (chart: uPlot) => void {
  return (chart) => {
    if (!spec.mark) return;
    const { ctx, bbox } = chart;
    const x = chart.valToPos(spec.mark.x, 'x', true);
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = themeColor('muted');
    ctx.setLineDash([5, 4]);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.font = `${12 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.textBaseline = 'bottom';
    ctx.textAlign = 'left';
    ctx.fillText(spec.mark.label, x + 6 * devicePixelRatio, bbox.top + bbox.height - 6 * devicePixelRatio);
    ctx.restore();
  };
}

/** Names of the series; behind them the values under the cursor. */
function makeReadout(spec: ChartSpec): { node: HTMLElement; show: (chart: uPlot) => void } {
  const values = spec.series.map(() => element('span', { class: 'number' }));
  const place = element('span', { class: 'place' });
  const items = spec.series.map(({ label, dashed }, i) => {
    const line = element('span', { class: dashed ? 'line dashed' : 'line' });
    line.style.borderColor = `var(--${seriesColor(i)})`;
    return element('span', { class: 'item' }, line, label, ' ', values[i]);
  });
  const show = (chart: uPlot) => {
    const index = chart.cursor.idx;
    const known = index !== null && index !== undefined;
    place.textContent = known ? `at ${short(spec.x[index])}` : '';
    values.forEach((node, i) => (node.textContent = known ? valueText(spec, spec.series[i].values[index]) : ''));
  };
  return { node: element('div', { class: 'chart-legend', 'aria-live': 'polite' }, ...items, place), show };
}

/** Arrow keys move the cursor from value to value. */
function followKeys(frame: HTMLElement, chart: uPlot, spec: ChartSpec): void {
  frame.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const from = chart.cursor.idx ?? (step > 0 ? -1 : spec.x.length);
    const index = Math.min(spec.x.length - 1, Math.max(0, from + step * (event.shiftKey ? 10 : 1)));
    const top = chart.valToPos(spec.series[0].values[index] ?? 0, 'y');
    chart.setCursor({ left: chart.valToPos(spec.x[index], 'x'), top });
  });
  frame.addEventListener('blur', () => chart.setCursor({ left: -10, top: -10 }));
}

function makePlot(spec: ChartSpec, place: HTMLElement, show: (chart: uPlot) => void): uPlot {
  const low = spec.kind === 'dots' ? Math.min(0, spec.x[0]) : 0;
  const options: uPlot.Options = {
    width: Math.max(200, place.clientWidth),
    height,
    legend: { show: false },
    scales: {
      x: { time: false, min: low, max: spec.xEnd },
      y: { range: (_, __, max) => [0, spec.kind === 'steps' || !spec.yShare ? max * 1.08 || 1 : 1] },
    },
    axes: [axis(spec.xLabel, 34, false), axis(spec.yLabel, 54, spec.yShare)],
    series: [{}, ...series(spec)],
    cursor: { points: { size: 7 }, y: false },
    hooks: { setCursor: [show], draw: [drawMark(spec)] },
  };
  return new uPlot(options, [spec.x, ...spec.series.map(({ values }) => values)] as uPlot.AlignedData, place);
}

function wholeRangeButton(chart: uPlot, spec: ChartSpec): HTMLElement | undefined {
  const end = spec.x[spec.x.length - 1];
  if (spec.xEnd >= end) return undefined;
  const made = button('Whole range', { class: 'quiet', 'aria-pressed': 'false' }, () => {
    const whole = made.getAttribute('aria-pressed') !== 'true';
    made.setAttribute('aria-pressed', String(whole));
    chart.setScale('x', { min: 0, max: whole ? end : spec.xEnd });
  });
  return made;
}

function showChart(grid: HTMLElement, spec: ChartSpec): void {
  const { node, show } = makeReadout(spec);
  const place = element('div', { class: 'plot', tabindex: 0, role: 'group', 'aria-label': `${spec.title}. ${spec.note}` });
  const title = element('div', { class: 'chart-title' }, element('h3', {}, spec.title));
  const note = element('p', { class: 'note' }, spec.note);
  grid.append(element('figure', { 'data-chart': spec.id }, title, node, place, note));
  const chart = makePlot(spec, place, show);
  const whole = wholeRangeButton(chart, spec);
  if (whole) title.append(whole);
  followKeys(place, chart, spec);
  new ResizeObserver(() => {
    if (place.clientWidth !== chart.width) chart.setSize({ width: Math.max(200, place.clientWidth), height });
  }).observe(place);
  onThemeChange(() => chart.redraw());
}

/** The charts, and after those figures that are none. */
export function showCharts(section: HTMLElement, specs: ChartSpec[], figures: HTMLElement[]): void {
  const grid = element('div', { class: 'chart-grid' });
  section.append(grid);
  for (const spec of specs) showChart(grid, spec);
  grid.append(...figures);
}
