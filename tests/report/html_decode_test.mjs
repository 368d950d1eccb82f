// The decoder of the report page on examples worked out by hand: node html_decode_test.mjs
// Needs `npm ci` in lib/report/web or a copy of it (CMAP_WEB_FOLDER).
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';

const web = process.env.CMAP_WEB_FOLDER
  ? pathToFileURL(`${process.env.CMAP_WEB_FOLDER}/`)
  : new URL('../../lib/report/web/', import.meta.url);
const { build } = createRequire(new URL('package.json', web))('esbuild');

async function load(path) {
  const built = await build({ entryPoints: [fileURLToPath(new URL(path, web))], bundle: true, write: false, format: 'esm' });
  return import(`data:text/javascript;base64,${Buffer.from(built.outputFiles[0].contents).toString('base64')}`);
}

const { bytesOfBase64, decodePlanes, gunzip } = await load('src/decode.ts');
const { centralBounds, coordinateDecimals, fieldValue, pointMap, spacing, worldPoint } = await load('src/point_map.ts');
const { colorIndex, sharesOutside } = await load('src/layers.ts');
const { basis, dot, eye, fieldOfView, fit } = await load('src/orbit.ts');

const plane = (field, type) => ({ field, type });

test('bytes: differences, zig-zag, modulo 256', () => {
  // 5, 3, 255, 0: differences 5, -2, 252 = -4, 1; zig-zag 10, 3, 7, 2.
  const bytes = Uint8Array.of(10, 3, 7, 2);
  const [map] = decodePlanes(bytes, [{ points: 4, planes: [plane('r', 'u8')] }]);
  assert.deepEqual([...map.get('r')], [5, 3, 255, 0]);
});

test('words: low bytes, then high bytes, modulo 65536', () => {
  // 300, 298, 65535, 0, 32768: differences 300, -2, -299, 1, -32768; zig-zag 600, 3, 597, 2, 65535.
  const codes = [600, 3, 597, 2, 65535];
  const bytes = Uint8Array.from([...codes.map((code) => code & 255), ...codes.map((code) => code >> 8)]);
  const [map] = decodePlanes(bytes, [{ points: 5, planes: [plane('x', 'u16')] }]);
  assert.deepEqual([...map.get('x')], [300, 298, 65535, 0, 32768]);
});

test('three bytes: low, middle, high, modulo 2^24', () => {
  // 70000, 0, 2^24 - 1: differences 70000, -70000, -1; zig-zag 140000 = 0x0222e0, 139999 = 0x0222df, 1.
  const bytes = Uint8Array.of(0xe0, 0xdf, 1, 0x22, 0x22, 0, 0x02, 0x02, 0);
  const [map] = decodePlanes(bytes, [{ points: 3, planes: [plane('x', 'u24')] }]);
  assert.deepEqual([...map.get('x')], [70000, 0, 0xffffff]);
});

test('planes follow each other, maps too, and each starts anew', () => {
  const maps = [
    { points: 2, planes: [plane('x', 'u16'), plane('r', 'u8')] },
    { points: 1, planes: [plane('lcr', 'u8')] },
  ];
  // x: 1, 1 -> 2, 0; low bytes 2 0, high bytes 0 0. r: 7, 6 -> 14, 1. lcr: 2 -> 4.
  const [first, second] = decodePlanes(Uint8Array.of(2, 0, 0, 0, 14, 1, 4), maps);
  assert.deepEqual([...first.get('x')], [1, 1]);
  assert.deepEqual([...first.get('r')], [7, 6]);
  assert.deepEqual([...second.get('lcr')], [2]);
});

test('too few or too many bytes are refused', () => {
  const maps = [{ points: 2, planes: [plane('x', 'u16')] }];
  assert.throws(() => decodePlanes(new Uint8Array(3), maps), /3 bytes of points where 4 were expected/);
  assert.throws(() => decodePlanes(new Uint8Array(5), maps), /5 bytes/);
});

test('base64 and gzip', async () => {
  // printf abc | gzip -n | base64
  assert.deepEqual(await gunzip(bytesOfBase64('H4sIAAAAAAAAA0tMSgYAwkEkNQMAAAA=')), Uint8Array.of(97, 98, 99));
});

test('coordinates and fields of a point, and of a stray', () => {
  const grids = [
    { points: 1, origin_m: [500000, 4000000, -2], step_m: [0.001, 0.002, 0.5] },
    { points: 1, origin_m: [-1e6, 0, 0], step_m: [8, 8, 8] },
  ];
  const text = { grids, planes: [{ field: 'distance', max: [8, 1e6] }] };
  const words = (...list) => Uint16Array.from(list);
  const values = new Map([['x', words(250, 1)], ['y', words(1000, 2)], ['z', words(3, 0)], ['distance', words(65534, 65534)]]);
  const map = pointMap(text, values);
  assert.deepEqual(worldPoint(map, 0), [500000.25, 4000002, -0.5]);
  assert.deepEqual(worldPoint(map, 1), [-999992, 16, 0]);
  assert.equal(fieldValue(map, 'z')(0), -0.5, 'z is the height in meters');
  assert.equal(fieldValue(map, 'distance')(0), 8, 'the largest code is the largest value');
  assert.equal(fieldValue(map, 'distance')(1), 1e6, 'of strays the largest of theirs');
  values.set('distance', words(32767, 65535)); // a half: 1/4 of the largest value
  assert.equal(fieldValue(map, 'distance')(0), 2);
  assert.ok(Number.isNaN(fieldValue(map, 'distance')(1)), 'the last code is none');
  assert.equal(fieldValue(map, 'lcr'), undefined, 'no such plane');
  assert.equal(coordinateDecimals(map), 3);
  assert.throws(() => pointMap({ ...text, id: 'm' }, new Map()), /map m has no plane x/);
});

/** A map of these points, in whole meters. */
function mapOf(points) {
  const grids = [{ points: points.length, origin_m: [-1000, -1000, -1000], step_m: [1, 1, 1] }];
  const plane = (k) => Uint32Array.from(points, (point) => point[k] + 1000);
  return pointMap({ grids, planes: [] }, new Map(['x', 'y', 'z'].map((axis, k) => [axis, plane(k)])));
}

const square = Array.from({ length: 41 * 41 }, (_, i) => [10 * (i % 41), 10 * Math.floor(i / 41), 0]);
const stack = (count, point) => Array.from({ length: count }, () => point);

test('the bounds of a map are those of its points', () => {
  assert.deepEqual(centralBounds(mapOf(square)), { min: [0, 0, 0], max: [400, 400, 0] });
  assert.deepEqual(centralBounds(mapOf([[1, 2, 3]])), { min: [1, 2, 3], max: [1, 2, 3] });
  // A tower of six points: 0.4 % of the map.
  const tower = Array.from({ length: 6 }, (_, i) => [200, 200, 20 * (i + 1)]);
  assert.deepEqual(centralBounds(mapOf([...square, ...tower])).max, [400, 400, 120]);
});

test('strays are outside of the bounds', () => {
  assert.deepEqual(centralBounds(mapOf([...square, [0, 0, -150]])).min, [0, 0, 0], 'one below');
  assert.deepEqual(centralBounds(mapOf([...square, ...stack(60, [900, 0, 0])])).max, [400, 400, 0], '3 % on one side');
  // In steps of 20 m, within a tenth of the diagonal of the middle 380 x 380 m: they count up to half of it, 269 m.
  const row = Array.from({ length: 50 }, (_, i) => [0, 0, -20 * i]);
  assert.deepEqual(centralBounds(mapOf([...square, ...row])).min, [0, 0, -260]);
});

test('copies of points are no spacing', () => {
  const line = Array.from({ length: 30 }, (_, i) => [3 * Math.floor(i / 3), 0, 0]);
  assert.equal(spacing(mapOf(line)), 3);
  assert.equal(spacing(mapOf([[0, 0, 0]])), 0);
});

test('shares outside of a range are those of all points', () => {
  const all = { ranked: { points: 5, values: [0, 0.1, 0.1, 0.2, 3] } };
  assert.deepEqual(sharesOutside(all, [0, 0.1]), [0, 0.4], 'the ends are within');
  assert.deepEqual(sharesOutside(all, [0.1, 0.15]), [0.2, 0.4]);
  assert.deepEqual(sharesOutside(all, [-1, 3]), [0, 0]);
  assert.deepEqual(sharesOutside(all, [5, 6]), [1, 0]);
  assert.deepEqual(sharesOutside({ ranked: { points: 0, values: [] } }, [0, 1]), [0, 0]);
  // 1001 points 0, 1 ... 1000, of which every hundredth is listed: what lies between is taken to rise evenly.
  const some = { ranked: { points: 1001, values: Array.from({ length: 11 }, (_, i) => 100 * i) } };
  assert.deepEqual(sharesOutside(some, [250, 750]), [250 / 1001, 250 / 1001]);
  assert.deepEqual(sharesOutside(some, [100, 900]), [100 / 1001, 100 / 1001]);
});

test('places in a color map', () => {
  const range = [1, 3];
  assert.deepEqual([0, 1, 2, 2.999, 3, 4].map((value) => colorIndex(value, range)), [0, 0, 128, 255, 255, 255]);
  assert.equal(colorIndex(NaN, range), -1);
  assert.deepEqual([1, 2, 3].map((value) => colorIndex(value, [2, 2])), [0, 0, 255], 'an empty range is a step');
});

test('the first view holds all points and has them in its middle', () => {
  const points = [-3, 0, 0, 5, 1, 0, 0, 9, 2, 1, -4, 7];
  for (const [azimuth, elevation] of [[-1, 0.7], [2, 1.5], [-Math.PI / 2, Math.PI / 2]]) {
    const orbit = fit({ azimuth, elevation }, points, 1.5);
    const { right, up, back } = basis(orbit);
    const places = [0, 3, 6, 9].map((i) => {
      const offset = eye(orbit).map((value, k) => points[i + k] - value);
      const depth = -dot(offset, back) * Math.tan(fieldOfView / 2);
      return [dot(offset, right) / depth / 1.5, dot(offset, up) / depth];
    });
    const reach = Math.max(...places.flat().map(Math.abs));
    assert.ok(reach <= 1 && reach > 0.75, `points reach ${reach} of the way to the edge`);
  }
});
