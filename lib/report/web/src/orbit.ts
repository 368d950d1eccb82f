// A camera that looks at a target from an azimuth and an elevation; z is up.

export type Vector = [number, number, number];

export interface Orbit {
  target: Vector;
  azimuth: number;
  elevation: number;
  distance: number;
}

export interface Basis {
  right: Vector;
  up: Vector;
  back: Vector;
}

export const fieldOfView = (40 * Math.PI) / 180;
const rad = Math.PI / 180;
export const oblique = { azimuth: -60 * rad, elevation: 40 * rad };
export const fromAbove = { azimuth: -90 * rad, elevation: 90 * rad };

export function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** Written out rather than by a look-at: it holds straight from above too. */
export function basis({ azimuth, elevation }: Pick<Orbit, 'azimuth' | 'elevation'>): Basis {
  const [ca, sa] = [Math.cos(azimuth), Math.sin(azimuth)];
  const [ce, se] = [Math.cos(elevation), Math.sin(elevation)];
  return { right: [-sa, ca, 0], up: [-se * ca, -se * sa, ce], back: [ce * ca, ce * sa, se] };
}

export function eye(orbit: Orbit): Vector {
  const { back } = basis(orbit);
  return orbit.target.map((value, k) => value + orbit.distance * back[k]) as Vector;
}

/**
 * The orbit from these angles from which the points (x y z of one after the other) just fill a picture of this aspect.
 * A point shows where its offset across is within the tangent times its depth: that bounds the distance by the
 * largest sums of both, to each side, and the middle of two sides is where they weigh the same.
 */
export function fit(angles: { azimuth: number; elevation: number }, points: ArrayLike<number>, aspect: number): Orbit {
  const axes = basis(angles);
  const down = Math.tan(fieldOfView / 2);
  const across = down * aspect;
  let [left, right, low, high] = [-Infinity, -Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 3) {
    const point: Vector = [points[i], points[i + 1], points[i + 2]];
    const [x, y, z] = [dot(point, axes.right), dot(point, axes.up), dot(point, axes.back)];
    left = Math.max(left, across * z - x);
    right = Math.max(right, across * z + x);
    low = Math.max(low, down * z - y);
    high = Math.max(high, down * z + y);
  }
  const [x, y] = [(right - left) / 2, (high - low) / 2];
  const distance = 1.1 * Math.max((left + right) / (2 * across), (low + high) / (2 * down));
  const target = axes.right.map((value, k) => x * value + y * axes.up[k]) as Vector;
  return { ...angles, target, distance: distance > 0 ? distance : 1 };
}

export function turn(orbit: Orbit, right: number, up: number): void {
  orbit.azimuth -= right;
  orbit.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, orbit.elevation + up));
}

/** Moves the target in the picture plane, by shares of the picture's height at the target. */
export function pan(orbit: Orbit, right: number, up: number): void {
  const axes = basis(orbit);
  const size = 2 * orbit.distance * Math.tan(fieldOfView / 2);
  for (let k = 0; k < 3; ++k) orbit.target[k] += size * (right * axes.right[k] + up * axes.up[k]);
}

/** Comes closer by a factor below 1, to the place (shares of the height from the middle) that stays where it is. */
export function zoom(orbit: Orbit, factor: number, right = 0, up = 0): void {
  pan(orbit, right * (1 - factor), up * (1 - factor));
  orbit.distance *= factor;
}
