// Why levels have no value, below the table: each reason once, with all that it holds for.
import { element } from './dom';
import { levelIds } from './levels';
import type { MetricRow } from './records';

function nameOf({ metric, qualifier }: MetricRow): string {
  return [metric.symbol || metric.title, qualifier].filter(Boolean).join(' at ');
}

/** Nothing where every level has a value. */
export function levelNotes(rows: MetricRow[]): HTMLElement | undefined {
  const names = new Map<string, { start: string; names: string[]; reason: string }>();
  for (const row of rows) {
    for (const id of levelIds) {
      const level = row.levels[id];
      if (!level || level.value !== null) continue;
      const reason = level.reason ?? 'no reason given';
      const known = names.get(`${id} ${reason}`) ?? { start: `No ${id} of`, names: [], reason };
      known.names.push(nameOf(row));
      names.set(`${id} ${reason}`, known);
    }
  }
  if (names.size === 0) return undefined;
  const items = [...names.values()].map((item) => element('li', {}, `${item.start} ${item.names.join(', ')}: ${item.reason}`));
  return element('ul', { class: 'note level-notes' }, ...items);
}
