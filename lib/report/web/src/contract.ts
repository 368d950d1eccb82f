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
  max?: number;
  unit?: string;
}

export interface MapText {
  id: string;
  title: string;
  points: number;
  points_of_map: number;
  origin_m: number[];
  step_m: number[];
  planes: Plane[];
}

export interface ColorLayer {
  kind: 'color';
}
export interface ClassLayer {
  kind: 'classes';
  field: string;
  classes: { label: string; color: number[] }[];
}
export interface ScalarLayer {
  kind: 'scalar';
  field: string;
  color_map: string;
  range: [number, number];
  unit: string;
}
export type Layer = { id: string; title: string; map: string } & (ColorLayer | ClassLayer | ScalarLayer);

export interface Page {
  title: string;
  metrics: MetricText[];
  distributions: Distribution[];
  maps: MapText[];
  layers: Layer[];
}
