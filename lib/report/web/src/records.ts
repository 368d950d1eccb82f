// The metrics of a report as rows of a table: one per value, so that of per-threshold metrics one per threshold.
import type { Json, JsonValue, MetricText, Page, Report } from './contract';
import { number, short, withUnit } from './format';
import { type Levels, levelFacts, levelReasons, levelsOf, shownAsLevels } from './levels';

export interface Metric extends MetricText {
  symbol: string;
  unit: string;
  better: string;
}

export interface MetricRow {
  metric: Metric;
  /** Place in the report: what sorting falls back to. */
  order: number;
  /** First row of its metric. */
  first: boolean;
  /** What tells rows of one metric apart, for people and for programs. */
  qualifier: string;
  key: Record<string, string>;
  value: number | null;
  /** No value because JSON knows no infinity. */
  infinite: boolean;
  /** Why there is no value. */
  reason: string;
  levels: Levels;
  /** Why levels have no value. */
  levelReasons: string[];
  facts: [string, JsonValue][];
}

const shownElsewhere = new Set(['value', 'unit', 'better', 'symbol', 'per_threshold', 'per_range', 'curve', 'cumulative']);

const isObject = (value: JsonValue): value is Json =>
  typeof value === 'object' && value !== null && !Array.isArray(value);

/** Members of a record and of records within it, by readable names; levels have places of their own. */
export function flatten(record: Json, prefix = ''): [string, JsonValue][] {
  return Object.entries(record).flatMap(([key, value]): [string, JsonValue][] => {
    if (shownAsLevels.has(key)) return [];
    const name = prefix + key.replaceAll('_', ' ');
    if (isObject(value)) return flatten(value, `${name}, `);
    if (Array.isArray(value) && value.some(isObject)) {
      return value.flatMap((item, i) => (isObject(item) ? flatten(item, `${name} ${i + 1}, `) : []));
    }
    return [[name, value]];
  });
}

function facts(record: Json): [string, JsonValue][] {
  return flatten(Object.fromEntries(Object.entries(record).filter(([key]) => !shownElsewhere.has(key))));
}

/** What such a part of the report says of a metric, or of its value at a threshold. */
function beside(part: Json | undefined, id: string, threshold: JsonValue | undefined): Json | undefined {
  const metric = (part?.metrics as Record<string, Json> | undefined)?.[id];
  if (threshold === undefined) return metric;
  return (metric?.per_threshold as Json[] | undefined)?.find((entry) => entry.threshold_m === threshold);
}

const span = (from: JsonValue, to: JsonValue) =>
  typeof from === 'number' && typeof to === 'number' ? `${number(from)} to ${number(to)}` : null;

/** Intervals and the like, where the report has them. */
function fairness(report: Report, id: string, threshold: JsonValue | undefined): [string, JsonValue][] {
  const { intervals, sensitivity, unobserved } = report;
  const interval = beside(intervals, id, threshold);
  const band = beside(sensitivity, id, threshold);
  const observed = beside(unobserved, id, threshold);
  const facts: [string, JsonValue][] = [];
  if (interval) facts.push([`${100 * Number(intervals?.level)} % interval`, span(interval.lower, interval.upper)]);
  if (band) facts.push(['when a little off', span(band.lowest, band.highest)]);
  if (observed) facts.push(['without the unobserved', observed.value]);
  return facts;
}

function rangeText({ lo_m, hi_m }: Json): string {
  return typeof hi_m === 'number' ? `${lo_m} to ${hi_m} m` : `from ${lo_m} m`;
}

/** The entries of a record that are rows: itself, or one per threshold or range. */
function entries(record: Json): { entry: Json; qualifier: string; key: Record<string, string> }[] {
  if (Array.isArray(record.per_threshold)) {
    return (record.per_threshold as Json[]).map((entry) => ({
      entry,
      qualifier: withUnit(short(entry.threshold_m as number), 'm'),
      key: { threshold: String(entry.threshold_m) },
    }));
  }
  if (Array.isArray(record.per_range)) {
    return (record.per_range as Json[]).map((entry) => ({
      entry,
      qualifier: rangeText(entry),
      key: { range: String(entry.lo_m) },
    }));
  }
  return [{ entry: record, qualifier: '', key: {} }];
}

function describe(id: string, record: Json, page: Page | undefined): Metric {
  const known = page?.metrics.find((metric) => metric.id === id);
  return {
    id,
    symbol: String(record.symbol ?? ''),
    title: known?.title ?? id.replaceAll('_', ' '),
    group: known?.group ?? '',
    unit: String(record.unit ?? ''),
    better: String(record.better ?? ''),
    definition: known?.definition ?? '',
  };
}

export function metricRows(report: Report, page: Page | undefined): MetricRow[] {
  const rows: MetricRow[] = [];
  for (const [id, record] of Object.entries(report.metrics)) {
    const metric = describe(id, record, page);
    const warning = report.warnings.find((item) => item.id.startsWith(id));
    entries(record).forEach(({ entry, qualifier, key }, i) => {
      const value = typeof entry.value === 'number' ? entry.value : null;
      const common = entry === record ? [] : facts(record);
      const levels = levelsOf(entry);
      const reason = value === null ? (warning?.message ?? 'The maps do not support this value.') : '';
      rows.push({
        metric,
        order: rows.length,
        first: i === 0,
        qualifier,
        key,
        value,
        infinite: value === null && warning?.id === `${id}_infinite`,
        reason,
        levels,
        levelReasons: levelReasons(levels),
        facts: [...levelFacts(levels), ...fairness(report, id, entry.threshold_m), ...facts(entry), ...common],
      });
    });
  }
  return rows;
}
