// What cmap_eval writes into the page.

export interface Json {
  [key: string]: JsonValue;
}
export type JsonValue = null | boolean | number | string | JsonValue[] | Json;

export interface InputRecord {
  path: string;
  sha256: string;
  format: string;
  points: number;
  finite_points: number;
  color: string;
}

export interface Report {
  schema: string;
  tool: { name: string; version: string };
  /** `estimate` alone where one map was evaluated. */
  inputs: Record<string, InputRecord>;
  parameters: Json;
  /** Null where one map was evaluated. */
  alignment: Json | null;
  metrics: Record<string, Json>;
  aliases?: Json;
  intervals?: Json;
  sensitivity?: Json;
  unobserved?: Json;
  warnings: { id: string; message: string }[];
  run: Json;
}

/** What the report does not say about a metric. */
export interface MetricText {
  id: string;
  title: string;
  group: string;
  definition: string;
}

export interface Direction {
  id: string;
  title: string;
  counts: number[];
  beyond: number;
  total: number;
}

export interface Distribution {
  id: string;
  title: string;
  unit: string;
  bin_width: number;
  directions: Direction[];
}

export interface Plane {
  field: string;
  type: 'u8' | 'u16' | 'u24';
  /** Largest value, of the points of each grid. */
  max?: number[];
  unit?: string;
}

/** Positions are counted in steps from an origin. */
export interface Grid {
  points: number;
  origin_m: number[];
  step_m: number[];
}

export interface MapText {
  id: string;
  title: string;
  points: number;
  points_of_map: number;
  /** Of the map and, where it has any, of its strays, which are the last points. */
  grids: Grid[];
  planes: Plane[];
}

export interface ColorLayer {
  kind: 'color';
}
export interface ClassLayer {
  kind: 'classes';
  field: string;
  /** `points` of all points of the map; the share is the metric's, null where the class is none of its. */
  classes: { label: string; color: number[]; points: number; share: number | null }[];
}
/** Some of the values of that many points: those of evenly spaced ranks, the lowest and the highest among them. */
export interface Ranked {
  points: number;
  values: number[];
}
export interface ScalarLayer {
  kind: 'scalar';
  field: string;
  color_map: string;
  range: [number, number];
  unit: string;
  ranked: Ranked;
}
export type Layer = { id: string; title: string; map: string } & (ColorLayer | ClassLayer | ScalarLayer);

export interface Page {
  title: string;
  metrics: MetricText[];
  distributions: Distribution[];
  maps: MapText[];
  layers: Layer[];
}
