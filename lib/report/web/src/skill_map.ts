// The skill of local color recall for other radii and tau, as a table whose cells are colored: it is its own text.
import { colorTable } from './color_maps';
import type { Json, Report } from './contract';
import { element, rgb } from './dom';
import { dash, number, percent, short } from './format';
import { type Level, levelsOf, skillText } from './levels';

interface RadiusRow {
  radius_m: number;
  value: (number | null)[];
  floor: (number | null)[];
  chance: (number | null)[];
  skill: (number | null)[];
}
interface SkillMap {
  tau: number[];
  n: number;
  per_radius: RadiusRow[];
}

interface Place {
  radius_m: number;
  tau: number;
  skill: number | null;
}

const colors = colorTable('cividis');

/** Of an sRGB color, as WCAG has it. */
function luminance(color: ArrayLike<number>): number {
  const [r, g, b] = Array.from({ length: 3 }, (_, i) => {
    const c = color[i] / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function paint(cell: HTMLElement, skill: number): void {
  const at = Math.round(255 * Math.min(1, Math.max(0, skill)));
  const color = colors.subarray(3 * at, 3 * at + 3);
  cell.style.background = rgb(color);
  cell.style.color = luminance(color) > 0.18 ? '#000' : '#fff';
}

const share = (value: number | null) => (value === null ? dash : percent(value));

function skillCell(row: RadiusRow, i: number, used: boolean): HTMLElement {
  const skill = row.skill[i];
  const levels = `value ${share(row.value[i])}, floor ${share(row.floor[i])}, chance ${share(row.chance[i])}`;
  const cell = element(
    'td',
    { class: `${used ? 'used ' : ''}${skill === null ? 'none' : 'some'}`, title: levels, 'data-value': String(skill) },
    skill === null ? dash : skill.toFixed(2).replace(/^-(0\.00)$/, '$1'),
    used ? element('span', { class: 'for-readers' }, ' (as evaluated)') : undefined,
  );
  if (skill !== null) paint(cell, skill);
  return cell;
}

function table(map: SkillMap, used: { tau?: number; radius_m?: number }): HTMLElement {
  const head = map.tau.map((tau) => element('th', { scope: 'col', class: tau === used.tau ? 'used' : '' }, short(tau)));
  const rows = map.per_radius.map((row) => {
    const ofRow = row.radius_m === used.radius_m;
    const cells = map.tau.map((tau, i) => skillCell(row, i, ofRow && tau === used.tau));
    return element('tr', {}, element('th', { scope: 'row', class: ofRow ? 'used' : '' }, `${short(row.radius_m)} m`), ...cells);
  });
  return element(
    'table',
    { class: 'skill-map' },
    element('caption', {}, 'Skill by radius (down) and tau (across)'),
    element('thead', {}, element('tr', {}, element('th', { scope: 'col' }, 'r \\ tau'), ...head)),
    element('tbody', {}, ...rows),
  );
}

function highest(map: SkillMap): Place | undefined {
  const places = map.per_radius.flatMap(({ radius_m, skill }) => map.tau.map((tau, i) => ({ radius_m, tau, skill: skill[i] })));
  return places
    .filter((place) => place.skill !== null)
    .reduce<Place | undefined>((best, place) => (best && best.skill! >= place.skill! ? best : place), undefined);
}

const because = (level: Level | undefined) => (level?.reason ? `: ${level.reason}` : '');

function notes(map: SkillMap, record: Json, used: { tau?: number; radius_m?: number }): string[] {
  const { skill } = levelsOf(record);
  const own = typeof skill?.value === 'number' ? `a skill of ${skillText(skill.value)}` : `no skill${because(skill)}`;
  const best = highest(map);
  const framed = map.tau.some((tau) => tau === used.tau) && map.per_radius.some((row) => row.radius_m === used.radius_m);
  return [
    'How far from shuffled colors (0) to a perfect map (1) the estimate has come. Where a cell has a dash, a perfect map ' +
      'would score no better than shuffled colors.',
    `Evaluated at radius ${used.radius_m} m and tau ${used.tau}${framed ? ' (framed)' : ''}: ${own}. ` +
      (best
        ? `Highest: ${skillText(best.skill!)} at radius ${short(best.radius_m)} m and tau ${short(best.tau)}.`
        : 'No radius and tau of this map tells colors apart.'),
    `From a sample of ${number(map.n)} points.`,
  ];
}

/** The figure; nothing where the report has no such map. */
export function skillMap(report: Report): HTMLElement | undefined {
  const record = report.metrics.local_color_recall;
  const map = record?.skill_map as unknown as SkillMap | undefined;
  if (!map?.tau?.length || !map.per_radius?.length) return undefined;
  const used = (record.parameters ?? {}) as { tau?: number; radius_m?: number };
  const [meaning, ...found] = notes(map, record, used);
  return element(
    'figure',
    { id: 'skill-map' },
    element('div', { class: 'chart-title' }, element('h3', {}, 'Where local color recall sees color')),
    element('p', { class: 'note' }, meaning),
    element('div', { class: 'table-frame' }, table(map, used)),
    ...found.map((text) => element('p', { class: 'note' }, text)),
  );
}
