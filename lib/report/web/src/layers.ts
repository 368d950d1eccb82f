// Colors of the points of a layer.
import { colorTable, noValueColor } from './color_maps';
import type { ClassLayer, Layer, Ranked, ScalarLayer } from './contract';
import { fieldValue, type PointMap } from './point_map';

/** What a user may change about a scalar layer. */
export interface ScalarStyle {
  range: [number, number];
  colorMap: string;
}

export const isScalar = (layer: Layer): layer is Layer & ScalarLayer => layer.kind === 'scalar';
export const isClasses = (layer: Layer): layer is Layer & ClassLayer => layer.kind === 'classes';

function paintColors(map: PointMap, rgba: Uint8Array): void {
  ['r', 'g', 'b'].forEach((channel, k) => {
    const values = map.values.get(channel);
    for (let i = 0; i < map.text.points; ++i) rgba[4 * i + k] = values ? values[i] : noValueColor[k];
  });
}

function paintClasses(map: PointMap, layer: ClassLayer, rgba: Uint8Array): void {
  const values = map.values.get(layer.field);
  for (let i = 0; i < map.text.points; ++i) {
    rgba.set((values && layer.classes[values[i]]?.color) ?? noValueColor, 4 * i);
  }
}

/** Place of a value in a color map, 0 to 255; -1 for none. */
export function colorIndex(value: number, [low, high]: [number, number]): number {
  if (!Number.isFinite(value)) return -1;
  const share = high > low ? (value - low) / (high - low) : value > low ? 1 : 0;
  return Math.min(255, Math.max(0, Math.floor(256 * share)));
}

function paintScalars(map: PointMap, layer: ScalarLayer, style: ScalarStyle, rgba: Uint8Array): void {
  const table = colorTable(style.colorMap);
  const value = fieldValue(map, layer.field) ?? (() => NaN);
  for (let i = 0; i < map.text.points; ++i) {
    const index = colorIndex(value(i), style.range);
    for (let k = 0; k < 3; ++k) rgba[4 * i + k] = index < 0 ? noValueColor[k] : table[3 * index + k];
  }
}

/** Red, green, blue and 255 of each point. */
export function paint(map: PointMap, layer: Layer, style: ScalarStyle | undefined, rgba: Uint8Array): void {
  rgba.fill(255);
  if (isClasses(layer)) paintClasses(map, layer, rgba);
  else if (isScalar(layer) && style) paintScalars(map, layer, style, rgba);
  else paintColors(map, rgba);
}

/** Number of all points of the map whose value is below x, or not above it. */
function countUpTo({ points, values }: Ranked, x: number, inclusive: boolean): number {
  const found = values.findIndex((value) => (inclusive ? value > x : value >= x));
  const next = found < 0 ? values.length : found;
  if (next === 0) return 0;
  if (next === values.length) return points;
  // Between two listed ranks values are taken to rise evenly.
  const rank = (i: number) => Math.floor((i * (points - 1)) / (values.length - 1));
  const share = (x - values[next - 1]) / (values[next] - values[next - 1]);
  const at = rank(next - 1) + share * (rank(next) - rank(next - 1));
  return inclusive ? Math.floor(at) + 1 : Math.ceil(at);
}

/** Shares of all points of the map below and above a range. */
export function sharesOutside({ ranked }: ScalarLayer, [low, high]: [number, number]): [number, number] {
  if (ranked.points === 0) return [0, 0];
  const { points } = ranked;
  return [countUpTo(ranked, low, false) / points, (points - countUpTo(ranked, high, true)) / points];
}
