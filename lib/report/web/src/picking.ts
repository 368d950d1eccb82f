// Which point is seen at a place of the canvas: found in the positions themselves, no reading back of pixels.
import { fieldOfView } from './orbit';
import { type Cloud, pointPixels, type Scene } from './scene';

/** In CSS pixels: a click that misses every drawn point takes the closest one within this. */
const reachPixels = 8;

/** Place on the canvas in CSS pixels and depth of a position; nothing behind the camera. */
export function projector(scene: Scene): (cloud: Cloud, index: number) => [number, number, number] | undefined {
  const m = scene.projection().elements;
  const [width, height] = [scene.canvas.clientWidth, scene.canvas.clientHeight];
  return ({ positions }, index) => {
    const [x, y, z] = [positions[3 * index], positions[3 * index + 1], positions[3 * index + 2]];
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    if (w <= 0) return undefined;
    const right = (m[0] * x + m[4] * y + m[8] * z + m[12]) / w;
    const up = (m[1] * x + m[5] * y + m[9] * z + m[13]) / w;
    return [((right + 1) / 2) * width, ((1 - up) / 2) * height, w];
  };
}

/** The frontmost point drawn over a place of the canvas, or else the closest one near it. */
export function pick(scene: Scene, cloud: Cloud, x: number, y: number): number | undefined {
  const project = projector(scene);
  const scale = (scene.diameter * scene.canvas.clientHeight) / (2 * Math.tan(fieldOfView / 2));
  let front: { index: number; depth: number } | undefined;
  let near: { index: number; offset: number } | undefined;
  for (let index = 0; index < cloud.map.text.points; ++index) {
    const place = project(cloud, index);
    if (!place) continue;
    const offset = Math.hypot(place[0] - x, place[1] - y);
    if (offset > pointPixels.max) continue;
    const radius = Math.min(pointPixels.max, Math.max(pointPixels.min, scale / place[2])) / 2;
    if (offset <= radius && (!front || place[2] < front.depth)) front = { index, depth: place[2] };
    if (offset <= reachPixels && (!near || offset < near.offset)) near = { index, offset };
  }
  return (front ?? near)?.index;
}
