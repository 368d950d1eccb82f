// A map of points as the page holds it, and the values of its fields.
import type { MapText } from './contract';
import type { Values } from './decode';

export interface PointMap {
  text: MapText;
  values: Map<string, Values>;
}

const axes = ['x', 'y', 'z'] as const;

export function pointMap(text: MapText, values: Map<string, Values>): PointMap {
  for (const axis of axes) {
    if (!values.has(axis)) throw new Error(`map ${text.id} has no plane ${axis}`);
  }
  return { text, values };
}

export function worldPoint({ text, values }: PointMap, index: number): number[] {
  return axes.map((axis, k) => text.origin_m[k] + values.get(axis)![index] * text.step_m[k]);
}

/** Decimals that show a step of the coordinates of this map. */
export function coordinateDecimals({ text }: PointMap): number {
  const step = Math.min(...text.step_m.filter((value) => value > 0), 1);
  return Math.min(6, Math.max(0, Math.ceil(-Math.log10(step))));
}

/** Value of a scalar field at each point; z is the world's z in meters, other fields are coded by their square root. */
export function fieldValue(map: PointMap, field: string): ((index: number) => number) | undefined {
  const values = map.values.get(field);
  if (!values) return undefined;
  const axis = (axes as readonly string[]).indexOf(field);
  if (axis >= 0) {
    const origin = map.text.origin_m[axis];
    const step = map.text.step_m[axis];
    return (index) => origin + values[index] * step;
  }
  const max = map.text.planes.find((plane) => plane.field === field)?.max ?? NaN;
  return (index) => max * (values[index] / 65535) ** 2;
}

export function pointColor({ values }: PointMap, index: number): number[] | undefined {
  const planes = ['r', 'g', 'b'].map((channel) => values.get(channel));
  return planes.every((plane) => plane) ? planes.map((plane) => plane![index]) : undefined;
}

/**
 * Bounds of the map without outliers along each axis: the middle 90 % and a quarter of that more on both sides, but
 * never more than the middle 99 %. More than a hundredth of a map may be stray points, all on one side.
 */
export function centralBounds(map: PointMap): { min: number[]; max: number[] } {
  const bounds = axes.map((axis, k) => {
    const counts = new Uint32Array(65536);
    const values = map.values.get(axis)!;
    for (const value of values) ++counts[value];
    const [first, low, high, last] = quantiles(counts, values.length, [0.005, 0.05, 0.95, 0.995]);
    const margin = (high - low) / 4;
    const world = (value: number) => map.text.origin_m[k] + value * map.text.step_m[k];
    return [world(Math.max(first, low - margin)), world(Math.min(last, high + margin))];
  });
  return { min: bounds.map((pair) => pair[0]), max: bounds.map((pair) => pair[1]) };
}

function quantiles(counts: Uint32Array, total: number, shares: number[]): number[] {
  return shares.map((share) => {
    let left = share * total;
    let value = 0;
    while (value < counts.length - 1 && left >= counts[value]) left -= counts[value++];
    return value;
  });
}

/** Typical distance of neighbors: points come in Hilbert order, where the next one is mostly close. */
export function spacing(map: PointMap): number {
  const { length } = map.values.get('x')!;
  const distances: number[] = [];
  const stride = Math.max(1, Math.floor(length / 4000));
  for (let i = 1; i < length; i += stride) {
    const a = worldPoint(map, i - 1);
    const b = worldPoint(map, i);
    distances.push(Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  }
  distances.sort((a, b) => a - b);
  return distances[distances.length >> 1] ?? 0;
}
