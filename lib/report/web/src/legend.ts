// What the colors of the map mean, and for scalar layers the fields that change it.
import { colorMapNames, colorTable, noValueColor } from './color_maps';
import type { ClassLayer, Layer, ScalarLayer } from './contract';
import { button, element, rgb } from './dom';
import { count, exact, percent, short, unitText } from './format';
import { isClasses, isScalar, type ScalarStyle, sharesOutside } from './layers';
import { type PointMap, pointColor } from './point_map';

export function gradient(colorMap: string): string {
  const table = colorTable(colorMap);
  const colors = Array.from({ length: 256 }, (_, i) => rgb(table.subarray(3 * i)));
  return `linear-gradient(to right, ${colors.join(', ')})`;
}

export function swatch(color: ArrayLike<number>): HTMLElement {
  const made = element('span', { class: 'swatch' });
  made.style.background = rgb(color);
  return made;
}

const pointsText = (points: number) => `${count(points)} ${points === 1 ? 'point' : 'points'}`;

function classList(layer: ClassLayer): HTMLElement {
  const rows = layer.classes.map(({ label, color, points, share }) =>
    element(
      'li',
      { 'data-class': label },
      swatch(color),
      element('span', {}, label),
      element(
        'span',
        { class: 'number', 'data-value': exact(share ?? points), title: pointsText(points) },
        share === null ? pointsText(points) : percent(share),
      ),
    ),
  );
  return element('ul', { class: 'classes' }, ...rows);
}

function rangeField(label: string, value: number, changed: (value: number) => void): HTMLElement {
  const input = element('input', { type: 'number', step: 'any', value: exact(value) });
  input.addEventListener('change', () => {
    if (Number.isFinite(input.valueAsNumber)) changed(input.valueAsNumber);
    else input.value = exact(value);
  });
  return element('label', { class: 'field' }, label, input);
}

function colorMapField(style: ScalarStyle, changed: () => void): HTMLElement {
  const select = element('select', {}, ...colorMapNames.map((name) => element('option', { value: name }, name)));
  select.value = style.colorMap;
  select.addEventListener('change', () => {
    style.colorMap = select.value;
    changed();
  });
  return element('label', { class: 'field' }, 'Color map', select);
}

function rangeFields(layer: ScalarLayer, style: ScalarStyle, changed: () => void): HTMLElement {
  const end = (index: 0 | 1) => (value: number) => {
    style.range[index] = value;
    changed();
  };
  const reset = () => {
    style.range = [...layer.range];
    style.colorMap = layer.color_map;
    changed();
  };
  return element(
    'fieldset',
    { class: 'range' },
    element('legend', {}, 'Color range'),
    rangeField('from', style.range[0], end(0)),
    rangeField('to', style.range[1], end(1)),
    colorMapField(style, changed),
    button('Reset', { class: 'quiet', 'data-action': 'reset-range' }, reset),
  );
}

function outsideText(layer: ScalarLayer, range: [number, number]): string {
  const [below, above] = sharesOutside(layer, range);
  const parts = [below > 0 ? `${percent(below)} below` : '', above > 0 ? `${percent(above)} above` : ''];
  return parts.filter(Boolean).join(', ') || 'All points within the range';
}

function colorBar(map: PointMap, layer: ScalarLayer, style: ScalarStyle): HTMLElement {
  const bar = element('div', { class: 'bar' });
  bar.style.background = gradient(style.colorMap);
  const [low, high] = style.range;
  const without = map.text.points_of_map - layer.ranked.points;
  const ends = [low, (low + high) / 2, high].map((value) =>
    element('span', { 'data-value': exact(value) }, short(value)),
  );
  return element(
    'div',
    { class: 'scale' },
    bar,
    element('div', { class: 'ends' }, ...ends),
    element('p', { class: 'note' }, [unitText(layer.unit), outsideText(layer, style.range)].filter(Boolean).join(' · ')),
    without > 0 ? element('p', { class: 'note' }, swatch(noValueColor), `${pointsText(without)} without a value`) : undefined,
  );
}

function colorNote(map: PointMap): HTMLElement {
  if (pointColor(map, 0)) return element('p', { class: 'note' }, 'Colors of the points as in the file');
  return element('p', { class: 'note' }, swatch(noValueColor), 'This map has no color');
}

/** The legend of a layer. `changed` is called when its style has been changed, and then a new legend is due. */
export function legend(map: PointMap, layer: Layer, style: ScalarStyle | undefined, changed: () => void): Node[] {
  if (isClasses(layer)) return [classList(layer)];
  if (isScalar(layer) && style) return [colorBar(map, layer, style), rangeFields(layer, style, changed)];
  return [colorNote(map)];
}
