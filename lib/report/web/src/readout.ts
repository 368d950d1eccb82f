// What is known about a picked point.
import type { Layer } from './contract';
import { element } from './dom';
import { exact, number, withUnit } from './format';
import { isClasses } from './layers';
import { swatch } from './legend';
import { coordinateDecimals, fieldValue, type PointMap, pointColor, worldPoint } from './point_map';

interface Row {
  field: string;
  label: string;
  value: string;
  text: string;
  color?: number[];
}

function coordinateRows(map: PointMap, index: number): Row[] {
  const decimals = coordinateDecimals(map);
  return worldPoint(map, index).map((value, k) => ({
    field: 'xyz'[k],
    label: 'xyz'[k],
    value: exact(value),
    text: withUnit(value.toFixed(decimals), 'm'),
  }));
}

function colorRow(map: PointMap, index: number): Row[] {
  const color = pointColor(map, index);
  if (!color) return [];
  return [{ field: 'color', label: 'color', value: color.join(' '), text: color.join(' '), color }];
}

function scalarRows(map: PointMap, index: number): Row[] {
  const labels: Record<string, string> = { distance: 'distance', color_distance: 'color distance' };
  return map.text.planes.flatMap(({ field, unit }) => {
    const value = labels[field] && fieldValue(map, field)?.(index);
    if (typeof value !== 'number' || Number.isNaN(value)) return [];
    return [{ field, label: labels[field], value: exact(value), text: withUnit(number(value), unit ?? '') }];
  });
}

function classRows(map: PointMap, layers: Layer[], index: number): Row[] {
  return layers.flatMap((layer) => {
    if (!isClasses(layer) || layer.map !== map.text.id) return [];
    const found = layer.classes[map.values.get(layer.field)?.[index] ?? -1];
    if (!found) return [];
    return [{ field: layer.field, label: layer.title, value: found.label, text: found.label, color: found.color }];
  });
}

/** The readout of a point, or how to get one. */
export function readout(map: PointMap, layers: Layer[], index: number | undefined): Node[] {
  if (index === undefined) {
    return [element('p', { class: 'note' }, 'Click a point, or press Enter for the one in the middle of the view.')];
  }
  const rows = [
    ...coordinateRows(map, index),
    ...colorRow(map, index),
    ...scalarRows(map, index),
    ...classRows(map, layers, index),
  ];
  const list = element('dl', { class: 'facts' });
  for (const { field, label, value, text, color } of rows) {
    const data = { 'data-field': field, 'data-value': value, title: value };
    list.append(element('dt', {}, label), element('dd', data, color && swatch(color), text));
  }
  return [element('p', { class: 'note' }, map.text.title), list];
}
