// What the charts show, from the distributions of the page and the curves of the report.
import type { Direction, Distribution, Json, Report } from './contract';
import { number, percent, short, unitText, withUnit } from './format';

export interface Series {
  label: string;
  values: (number | null)[];
  /** What is no measurement of this map. */
  dashed?: boolean;
}

export interface ChartSpec {
  id: string;
  title: string;
  note: string;
  xLabel: string;
  yLabel: string;
  kind: 'steps' | 'line' | 'dots';
  x: number[];
  series: Series[];
  /** End of the x axis at first; the axis may also show everything. */
  xEnd: number;
  yShare: boolean;
  mark?: { x: number; label: string };
}

const wantedBins = 80;

/** Right edge of the bin within which a share of all points is reached; nothing if they lie beyond all bins. */
function quantile({ counts, total }: Direction, share: number, width: number): number | undefined {
  let sum = 0;
  for (let i = 0; i < counts.length; ++i) {
    sum += counts[i];
    if (sum >= share * total) return (i + 1) * width;
  }
  return undefined;
}

/** Long tails would squeeze the part that matters: the axis ends where the bulk of the closer direction does. */
function bulkEnd({ directions, bin_width }: Distribution): number {
  const end = bin_width * Math.max(...directions.map(({ counts }) => counts.length));
  const high = Math.min(...directions.map((direction) => quantile(direction, 0.95, bin_width) ?? end));
  const middle = Math.max(...directions.map((direction) => quantile(direction, 0.5, bin_width) ?? 0));
  return Math.min(end, Math.max(high, 5 * middle));
}

function shareAbove({ counts, total }: Direction, end: number, width: number): number {
  const within = counts.slice(0, Math.round(end / width)).reduce((sum, count) => sum + count, 0);
  return 1 - within / total;
}

function tailNote(distribution: Distribution, end: number): string {
  const shares = distribution.directions.map(
    (direction) => `${percent(shareAbove(direction, end, distribution.bin_width))} (${direction.title})`,
  );
  return `Above ${withUnit(short(end), distribution.unit)}: ${shares.join(', ')}`;
}

function histogram(distribution: Distribution, xEnd: number): ChartSpec {
  const { bin_width, directions, unit } = distribution;
  const merged = Math.max(1, Math.round(xEnd / bin_width / wantedBins));
  const width = merged * bin_width;
  const bins = Math.ceil(Math.max(...directions.map(({ counts }) => counts.length)) / merged);
  const shares = ({ counts, total }: Direction) => {
    const values = new Array<number>(bins + 1).fill(0);
    counts.forEach((count, i) => (values[Math.floor(i / merged)] += count / total));
    return values;
  };
  return {
    id: `${distribution.id}-histogram`,
    title: distribution.title,
    note: tailNote(distribution, xEnd),
    xLabel: axisLabel(distribution.id, unit),
    yLabel: `share per ${withUnit(short(width), unit)}`,
    kind: 'steps',
    x: Array.from({ length: bins + 1 }, (_, i) => i * width),
    series: directions.map((direction) => ({ label: direction.title, values: shares(direction) })),
    xEnd,
    yShare: true,
  };
}

function axisLabel(id: string, unit: string): string {
  return `${id.replaceAll('_', ' ')} [${unitText(unit)}]`;
}

function cumulative(distribution: Distribution, xEnd: number): ChartSpec {
  const { bin_width, directions, unit } = distribution;
  const bins = Math.max(...directions.map(({ counts }) => counts.length));
  const shares = ({ counts, total }: Direction) => {
    let sum = 0;
    return Array.from({ length: bins + 1 }, (_, i) => (sum += i > 0 ? (counts[i - 1] ?? 0) : 0) / total);
  };
  return {
    id: `${distribution.id}-cumulative`,
    title: `${distribution.title}, cumulative`,
    note: directions.map((d) => `${medianText(d, bin_width, unit)} (${d.title})`).join('. '),
    xLabel: axisLabel(distribution.id, unit),
    yLabel: 'share at or below',
    kind: 'line',
    x: Array.from({ length: bins + 1 }, (_, i) => i * bin_width),
    series: directions.map((direction) => ({ label: direction.title, values: shares(direction) })),
    xEnd,
    yShare: true,
  };
}

function medianText(direction: Direction, width: number, unit: string): string {
  const median = quantile(direction, 0.5, width);
  return median === undefined ? 'Half beyond all bins' : `Half within ${withUnit(short(median), unit)}`;
}

type RecallCurve = { tau: number[]; value: (number | null)[]; chance?: (number | null)[]; area?: number };

function recallCurve(record: Json | undefined): ChartSpec[] {
  const curve = record?.curve as RecallCurve | undefined;
  if (!curve?.tau?.length) return [];
  const tau = (record!.parameters as Json | undefined)?.tau;
  return [
    {
      id: 'recall-curve',
      title: 'Local color recall against tau',
      note: typeof curve.area === 'number' ? `Area under the curve ${number(curve.area)}` : '',
      xLabel: 'tau [unit RGB]',
      yLabel: 'share recalled',
      kind: 'dots',
      x: curve.tau,
      series: [
        { label: 'LCR', values: curve.value },
        ...(curve.chance ? [{ label: 'chance: its colors shuffled', values: curve.chance, dashed: true }] : []),
      ],
      xEnd: Math.max(...curve.tau),
      yShare: true,
      ...(typeof tau === 'number' && { mark: { x: tau, label: `tau ${tau}` } }),
    },
  ];
}

interface ThresholdChart {
  id: string;
  title: string;
  yLabel: string;
  yShare: boolean;
  metrics: [string, string][];
}

const thresholdCharts: ThresholdChart[] = [
  {
    id: 'shares-by-threshold',
    title: 'Shares within a threshold',
    yLabel: 'share',
    yShare: true,
    metrics: [
      ['fitness', 'fitness'],
      ['completeness', 'completeness'],
      ['f_score', 'F-score'],
    ],
  },
  {
    id: 'accuracy-by-threshold',
    title: 'Accuracy within a threshold',
    yLabel: 'RMSE [m]',
    yShare: false,
    metrics: [['accuracy', 'accuracy']],
  },
];

type Threshold = { threshold_m: number; value: number | null };

function thresholdChart(report: Report, { metrics, ...chart }: ThresholdChart): ChartSpec[] {
  const present = metrics.flatMap(([id, label]) => {
    const entries = report.metrics[id]?.per_threshold as Threshold[] | undefined;
    return entries ? [{ label, values: new Map(entries.map((entry) => [entry.threshold_m, entry.value])) }] : [];
  });
  const x = [...new Set(present.flatMap(({ values }) => [...values.keys()]))].sort((a, b) => a - b);
  if (x.length < 2) return [];
  const series = present.map(({ label, values }) => ({ label, values: x.map((at) => values.get(at) ?? null) }));
  return [{ ...chart, note: '', xLabel: 'threshold [m]', kind: 'dots', x, series, xEnd: x[x.length - 1] }];
}

export function chartSpecs(report: Report, distributions: Distribution[]): ChartSpec[] {
  const shown = distributions.filter(({ directions }) => directions.some(({ total }) => total > 0));
  return [
    ...shown.flatMap((distribution) => {
      const end = bulkEnd(distribution);
      return [histogram(distribution, end), cumulative(distribution, end)];
    }),
    ...recallCurve(report.metrics.local_color_recall),
    ...thresholdCharts.flatMap((chart) => thresholdChart(report, chart)),
  ];
}
