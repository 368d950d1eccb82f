// A map of points as the page holds it, and the values of its fields.
import type { MapText } from './contract';
import type { Values } from './decode';

export interface PointMap {
  text: MapText;
  values: Map<string, Values>;
  /** Coordinates in meters, one array for each axis. */
  world: Float64Array[];
}

const axes = ['x', 'y', 'z'] as const;
const none = 65535;

/** Calls visit for each point with the number of its grid. */
function eachPoint({ grids }: MapText, visit: (index: number, grid: number) => void): void {
  let index = 0;
  grids.forEach(({ points }, grid) => {
    for (const end = index + points; index < end; ++index) visit(index, grid);
  });
}

export function pointMap(text: MapText, values: Map<string, Values>): PointMap {
  const world = axes.map((axis, k) => {
    const plane = values.get(axis);
    if (!plane) throw new Error(`map ${text.id} has no plane ${axis}`);
    const coordinates = new Float64Array(plane.length);
    eachPoint(text, (i, grid) => {
      const { origin_m, step_m } = text.grids[grid];
      coordinates[i] = origin_m[k] + plane[i] * step_m[k];
    });
    return coordinates;
  });
  return { text, values, world };
}

export function worldPoint({ world }: PointMap, index: number): number[] {
  return world.map((coordinates) => coordinates[index]);
}

/** Decimals that show a step of the coordinates of this map. */
export function coordinateDecimals({ text }: PointMap): number {
  const step = Math.min(...text.grids[0].step_m, 1);
  return Math.min(9, Math.max(0, Math.ceil(-Math.log10(step))));
}

/**
 * Value of a scalar field at each point, NaN where it has none; z is the world's z in meters, other fields are coded by
 * their square root.
 */
export function fieldValue(map: PointMap, field: string): ((index: number) => number) | undefined {
  const values = map.values.get(field);
  if (!values) return undefined;
  const axis = (axes as readonly string[]).indexOf(field);
  if (axis >= 0) return (index) => map.world[axis][index];
  const max = map.text.planes.find((plane) => plane.field === field)?.max ?? [NaN];
  const near = map.text.grids[0].points;
  return (index) => (values[index] === none ? NaN : max[index < near ? 0 : 1] * (values[index] / (none - 1)) ** 2);
}

export function pointColor({ values }: PointMap, index: number): number[] | undefined {
  const planes = ['r', 'g', 'b'].map((channel) => values.get(channel));
  return planes.every((plane) => plane) ? planes.map((plane) => plane![index]) : undefined;
}

/**
 * Bounds of the map without outliers, which may be some hundredths of its points, all on one side: the middle 90 %
 * along each axis, and on to further points as long as each follows the one before within a tenth of the diagonal of
 * that middle, up to a half of it.
 */
export function centralBounds({ world }: PointMap): { min: number[]; max: number[] } {
  const sorted = world.map((coordinates) => coordinates.slice().sort());
  const last = sorted[0].length - 1;
  const [low, high] = [Math.floor(0.05 * last), Math.ceil(0.95 * last)];
  const diagonal = Math.hypot(...sorted.map((values) => values[high] - values[low]));
  const end = (values: Float64Array, start: number, step: 1 | -1) => {
    let at = start;
    const reaches = (next: number) =>
      Math.abs(values[next] - values[at]) <= diagonal / 10 && Math.abs(values[next] - values[start]) <= diagonal / 2;
    while (at + step >= 0 && at + step <= last && reaches(at + step)) at += step;
    return values[at];
  };
  return {
    min: sorted.map((values) => end(values, low, -1)),
    max: sorted.map((values) => end(values, high, 1)),
  };
}

/** Typical distance of neighbors: points come in Hilbert order, where the next one is mostly close. */
export function spacing(map: PointMap): number {
  const { length } = map.world[0];
  const distances: number[] = [];
  const stride = Math.max(1, Math.floor(length / 4000));
  for (let i = 1; i < length; i += stride) {
    const a = worldPoint(map, i - 1);
    const b = worldPoint(map, i);
    distances.push(Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  }
  const apart = distances.filter((distance) => distance > 0).sort((a, b) => a - b); // without copies of points
  return apart[apart.length >> 1] ?? 0;
}
