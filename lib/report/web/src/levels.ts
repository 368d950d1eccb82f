// What a number is worth: floor, chance and skill of a record, and how far the phases of the grid scatter.
import type { Json, JsonValue } from './contract';
import { count, number, short } from './format';

export const levelIds = ['floor', 'chance', 'skill'] as const;
export type LevelId = (typeof levelIds)[number];

export interface Level {
  value: number | null;
  /** Standard error. */
  se?: number | null;
  /** Points or voxels that it comes from. */
  n?: number;
  /** Why there is no value. */
  reason?: string;
}
export type Levels = Partial<Record<LevelId, Level>>;

/** The value on each of the grids that begin at other places; null where no voxel qualifies. */
export interface Phases {
  n: number;
  mean: number | null;
  std: number | null;
  min: number | null;
  max: number | null;
  values: (number | null)[];
}

/** Members of a record that are shown by themselves. */
export const shownAsLevels = new Set<string>([...levelIds, 'phases', 'skill_map']);

export function levelsOf(entry: Json): Levels {
  const known = levelIds.filter((id) => typeof entry[id] === 'object' && entry[id] !== null);
  return Object.fromEntries(known.map((id) => [id, entry[id] as unknown as Level]));
}

/** Skills are compared down their column: all with as many decimals. */
export function skillText(skill: number): string {
  return Math.abs(skill) < 100 ? skill.toFixed(3) : number(skill);
}

export function levelText(id: LevelId, value: number): string {
  return id === 'skill' ? skillText(value) : number(value);
}

function levelFact(id: LevelId, { value, se, n }: Level): [string, JsonValue] {
  const parts = [value === null ? null : levelText(id, value)];
  if (typeof se === 'number') parts.push(`standard error ${short(Number(se.toPrecision(2)))}`);
  if (typeof n === 'number') parts.push(`from ${count(n)}`);
  return [id, parts.filter(Boolean).join(', ')];
}

/** Levels with their errors and counts, for the details of a row. */
export function levelFacts(levels: Levels): [string, JsonValue][] {
  return levelIds.flatMap((id) => (levels[id] && levels[id].value !== null ? [levelFact(id, levels[id])] : []));
}

/** A sentence for each level without a value. */
export function levelReasons(levels: Levels): string[] {
  return levelIds.flatMap((id) => {
    const level = levels[id];
    return level && level.value === null ? [`No ${id}: ${level.reason ?? 'no reason given'}.`] : [];
  });
}

export function phasesOf(record: Json): Phases | undefined {
  const phases = record.phases as unknown as Phases | undefined;
  return Array.isArray(phases?.values) ? phases : undefined;
}

/** Two digits of the deviation say how many of the mean mean something. */
export function bandText(mean: number, std: number): string {
  const decimals = std > 0 ? Math.max(0, 1 - Math.floor(Math.log10(std))) : Infinity;
  return decimals <= 6 ? `${mean.toFixed(decimals)} ± ${std.toFixed(decimals)}` : `${number(mean)} ± ${number(std)}`;
}
