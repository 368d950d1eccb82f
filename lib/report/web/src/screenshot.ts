// The picture of the map as a PNG, with its legend below: a picture without one says little later.
import { colorTable } from './color_maps';
import type { Layer } from './contract';
import { rgb, saveBlob } from './dom';
import { short, unitText } from './format';
import { isClasses, isScalar, type ScalarStyle } from './layers';
import type { Scene } from './scene';
import { themeColor } from './theme';

type Pen = CanvasRenderingContext2D;

function drawBar(pen: Pen, style: ScalarStyle, unit: string, x: number, y: number, em: number): void {
  const table = colorTable(style.colorMap);
  const [low, high] = style.range.map((value) => short(value));
  pen.fillText(low, x, y);
  const left = x + pen.measureText(low).width + em / 2;
  const cell = (12 * em) / 256;
  for (let i = 0; i < 256; ++i) {
    pen.fillStyle = rgb(table.subarray(3 * i));
    pen.fillRect(left + i * cell, y - 0.4 * em, cell + 1, 0.8 * em);
  }
  pen.fillStyle = themeColor('text');
  pen.fillText(`${high} ${unitText(unit)}`, left + 12.5 * em, y);
}

function drawClasses(pen: Pen, classes: { label: string; color: number[] }[], x: number, y: number, em: number): void {
  for (const { label, color } of classes) {
    pen.fillStyle = rgb(color);
    pen.fillRect(x, y - 0.4 * em, 0.8 * em, 0.8 * em);
    pen.fillStyle = themeColor('text');
    pen.fillText(label, x + 1.2 * em, y);
    x += pen.measureText(label).width + 2.7 * em;
  }
}

/** Saves what the canvas shows now. */
export function saveScreenshot(scene: Scene, layer: Layer, style: ScalarStyle | undefined): void {
  scene.draw(); // the drawing can be read only right after it was made
  const { width, height } = scene.canvas;
  const em = 15 * Math.min(2, devicePixelRatio);
  const picture = document.createElement('canvas');
  picture.width = width;
  picture.height = height + Math.round(2.4 * em);
  const pen = picture.getContext('2d')!;
  pen.fillStyle = themeColor('page');
  pen.fillRect(0, 0, picture.width, picture.height);
  pen.drawImage(scene.canvas, 0, 0);
  pen.font = `${em}px system-ui, sans-serif`;
  pen.textBaseline = 'middle';
  pen.fillStyle = themeColor('text');
  const y = height + 1.2 * em;
  pen.fillText(layer.title, em, y);
  const x = pen.measureText(layer.title).width + 3 * em;
  if (isClasses(layer)) drawClasses(pen, layer.classes, x, y, em);
  else if (isScalar(layer) && style) drawBar(pen, style, layer.unit, x, y, em);
  picture.toBlob((blob) => blob && saveBlob(blob, `${layer.id}.png`), 'image/png');
}
