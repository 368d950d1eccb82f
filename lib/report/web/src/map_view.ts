// The section of the map: canvas, layer switch, legend, readout.
import { follow } from './controls';
import type { Layer, Page } from './contract';
import { button, element, message } from './dom';
import { count, percent } from './format';
import { isScalar, paint, type ScalarStyle } from './layers';
import { legend } from './legend';
import { fit, fromAbove, oblique, type Vector } from './orbit';
import { pick, projector } from './picking';
import { centralBounds, type PointMap, spacing } from './point_map';
import { readout } from './readout';
import { type Cloud, makeScene, type Scene } from './scene';
import { saveScreenshot } from './screenshot';
import { factList } from './table';
import { onThemeChange, themeColor } from './theme';

interface View {
  scene: Scene;
  layers: Layer[];
  styles: Map<string, ScalarStyle>;
  layer: Layer;
  picked: number | undefined;
  parts: Parts;
}

type Parts = ReturnType<typeof makeParts>;

const keyHelp: [string, string][] = [
  ['1 to 9', 'layer'],
  ['drag, arrow keys', 'turn'],
  ['right drag, Shift + drag or arrow keys, two fingers', 'move'],
  ['wheel, pinch, + and −', 'zoom'],
  ['double click', 'turn about that point'],
  ['click, Enter', 'read a point'],
  ['Escape', 'forget it'],
  ['r or Home, t', 'first view, view from above'],
];

function keyTable(): HTMLElement {
  return element('details', { class: 'help' }, element('summary', {}, 'Keys and mouse'), factList(keyHelp));
}

function makeParts() {
  return {
    layers: element('div', { class: 'segments', role: 'radiogroup', 'aria-label': 'Layer' }),
    canvas: element('canvas', {
      tabindex: 0,
      role: 'application',
      'aria-label': 'Map in three dimensions. Arrow keys turn it, plus and minus zoom, Enter reads the middle point.',
      'aria-describedby': 'readout',
    }),
    marker: element('div', { class: 'marker', hidden: true, 'aria-hidden': 'true' }),
    name: element('h3'),
    legend: element('div', { id: 'legend' }),
    readout: element('div', { id: 'readout', 'aria-live': 'polite' }),
    size: element('input', { type: 'range', min: -2, max: 2, step: 0.1, value: 0, id: 'point-size' }),
    shown: element('p', { class: 'note', id: 'points-shown' }),
    actions: element('div', { class: 'actions' }),
  };
}

function layout(section: HTMLElement, parts: Parts): void {
  const controls = element(
    'div',
    { class: 'controls' },
    element('h3', {}, 'View'),
    element('label', { class: 'field' }, 'Point size', parts.size),
    parts.actions,
  );
  const panel = element(
    'div',
    { class: 'panel' },
    parts.name,
    parts.legend,
    parts.shown,
    element('h3', {}, 'Point'),
    parts.readout,
    controls,
  );
  const stage = element('div', { class: 'stage' }, parts.canvas, parts.marker);
  section.append(parts.layers, element('div', { class: 'map-grid' }, stage, panel), keyTable());
}

function shownText({ text }: PointMap): string {
  const share = text.points / text.points_of_map;
  if (share >= 1) return `${count(text.points)} ${text.points === 1 ? 'point' : 'points'}`;
  return `${count(text.points)} of ${count(text.points_of_map)} points (${percent(share)})`;
}

function cloudOf(view: View): Cloud {
  return view.scene.clouds.find((cloud) => cloud.map.text.id === view.layer.map)!;
}

function repaint(view: View): void {
  const cloud = cloudOf(view);
  const style = view.styles.get(view.layer.id);
  paint(cloud.map, view.layer, style, cloud.colors);
  view.scene.recolored(cloud);
  view.parts.legend.replaceChildren(...legend(cloud.map, view.layer, style, () => restyle(view)));
}

/** After a change in the legend, which is made anew: the focus stays at its place in it. */
function restyle(view: View): void {
  const fields = () => [...view.parts.legend.querySelectorAll<HTMLElement>('input, select, button')];
  const focused = fields().indexOf(document.activeElement as HTMLElement);
  repaint(view);
  fields()[focused]?.focus();
}

function showPicked(view: View, index: number | undefined): void {
  view.picked = index;
  view.parts.readout.replaceChildren(...readout(cloudOf(view).map, view.layers, index));
  placeMarker(view);
}

function placeMarker(view: View): void {
  const { marker } = view.parts;
  const place = view.picked === undefined ? undefined : projector(view.scene)(cloudOf(view), view.picked);
  marker.hidden = !place;
  if (place) marker.style.transform = `translate(${place[0]}px, ${place[1]}px)`;
}

function showLayer(view: View, layer: Layer): void {
  const sameMap = view.layer.map === layer.map;
  view.layer = layer;
  const cloud = cloudOf(view);
  view.scene.show(cloud);
  repaint(view);
  showPicked(view, sameMap ? view.picked : undefined);
  view.parts.name.textContent = layer.title;
  view.parts.shown.textContent = shownText(cloud.map);
  const input = view.parts.layers.querySelector<HTMLInputElement>(`input[value="${CSS.escape(layer.id)}"]`);
  if (input) input.checked = true;
  document.documentElement.dataset.layer = layer.id;
}

function fillLayers(view: View): void {
  view.layers.forEach((layer, i) => {
    const input = element('input', { type: 'radio', name: 'layer', value: layer.id });
    input.addEventListener('change', () => showLayer(view, layer));
    const key = i < 9 ? element('kbd', { 'aria-hidden': 'true' }, String(i + 1)) : undefined;
    view.parts.layers.append(element('label', {}, input, element('span', {}, key, layer.title)));
  });
  addEventListener('keydown', (event) => {
    const typing = (event.target as Element).matches?.('input[type=number], select');
    const layer = view.layers['123456789'.indexOf(event.key)];
    if (typing || event.ctrlKey || event.metaKey || event.altKey || !layer) return;
    showLayer(view, layer);
  });
}

interface Box {
  min: number[];
  max: number[];
}

/** Bounds of the middle of all maps. */
function centralBox(maps: PointMap[]): Box {
  const bounds = maps.map(centralBounds);
  return {
    min: [0, 1, 2].map((k) => Math.min(...bounds.map((box) => box.min[k]))),
    max: [0, 1, 2].map((k) => Math.max(...bounds.map((box) => box.max[k]))),
  };
}

/** The points of all maps within the box, relative to the center of the scene: what the first view is to show. */
function pointsWithin(clouds: Cloud[], box: Box): number[] {
  const inside: number[] = [];
  for (const { positions, map } of clouds) {
    for (let i = 0; i < map.text.points; ++i) {
      const outside = map.world.some((coordinates, k) => coordinates[i] < box.min[k] || coordinates[i] > box.max[k]);
      if (!outside) inside.push(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    }
  }
  return inside;
}

function setUpView(view: View, shown: number[]): void {
  const { scene, parts } = view;
  const look = (angles: typeof oblique) => {
    scene.orbit = fit(angles, shown, scene.aspect());
    scene.request();
  };
  const keys: Record<string, () => void> = {
    r: () => look(oblique),
    Home: () => look(oblique),
    t: () => look(fromAbove),
    Enter: () => showPicked(view, pick(scene, cloudOf(view), parts.canvas.clientWidth / 2, parts.canvas.clientHeight / 2)),
  };
  follow(parts.canvas, {
    orbit: () => scene.orbit,
    changed: () => scene.request(),
    click: (x, y) => showPicked(view, pick(scene, cloudOf(view), x, y)),
    doubleClick: (x, y) => turnAbout(view, x, y),
    key: (key) => {
      keys[key]?.();
      return key in keys;
    },
  });
  addEventListener('keydown', (event) => event.key === 'Escape' && showPicked(view, undefined));
  parts.actions.append(
    button('First view', { class: 'quiet', 'data-action': 'first-view' }, keys.r),
    button('From above', { class: 'quiet', 'data-action': 'top-view' }, keys.t),
    button('Save PNG', { class: 'quiet', 'data-action': 'screenshot' }, () =>
      saveScreenshot(scene, view.layer, view.styles.get(view.layer.id)),
    ),
  );
  look(oblique);
}

function turnAbout(view: View, x: number, y: number): void {
  const cloud = cloudOf(view);
  const index = pick(view.scene, cloud, x, y);
  if (index === undefined) return;
  view.scene.orbit.target = [...cloud.positions.subarray(3 * index, 3 * index + 3)] as Vector;
  view.scene.request();
}

function followPointSize(view: View): void {
  const { size } = view.parts;
  // Discs that close the gaps of a grid. A point alone has no spacing: it is a dot in a first view of about a meter.
  const base = 1.5 * Math.max(...view.scene.clouds.map((cloud) => spacing(cloud.map))) || 0.02;
  const apply = () => {
    view.scene.diameter = base * 2 ** size.valueAsNumber;
    view.scene.request();
  };
  size.addEventListener('input', apply);
  apply();
}

function followPage(view: View): void {
  const background = () => view.scene.setBackground(themeColor('stage'));
  onThemeChange(background);
  background();
  addEventListener('beforeprint', () => view.scene.draw());
  view.scene.onDraw(() => placeMarker(view));
}

function styles(layers: Layer[]): Map<string, ScalarStyle> {
  return new Map(layers.filter(isScalar).map((layer) => [layer.id, { range: [...layer.range], colorMap: layer.color_map }]));
}

/** Fills the section with the map; the promise of the first frame. */
export function showMap(section: HTMLElement, page: Page, maps: PointMap[]): Promise<void> {
  const layers = page.layers.filter((layer) => maps.some((map) => map.text.id === layer.map));
  if (layers.length === 0) throw new Error('This page holds no layer of the map.');
  const parts = makeParts();
  const box = centralBox(maps);
  const center = box.min.map((low, k) => (low + box.max[k]) / 2) as Vector;
  const scene = makeScene(parts.canvas, maps, center);
  if (!scene) {
    section.append(message('The map needs WebGL 2, which this browser does not offer here. Everything else works.'));
    return Promise.resolve();
  }
  layout(section, parts);
  const view: View = { scene, layers, styles: styles(layers), layer: layers[0], picked: undefined, parts };
  fillLayers(view);
  showLayer(view, layers[0]);
  followPointSize(view);
  followPage(view);
  setUpView(view, pointsWithin(scene.clouds, box));
  return new Promise((resolve) => scene.onDraw(() => requestAnimationFrame(() => resolve())));
}
