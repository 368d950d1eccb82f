// The points on the graphics card: one buffer of positions per map, drawn when something has changed.
import {
  BufferAttribute,
  BufferGeometry,
  Matrix4,
  PerspectiveCamera,
  Points,
  Scene as ThreeScene,
  ShaderMaterial,
  Vector3,
  WebGLRenderer,
} from 'three';
import { basis, eye, fieldOfView, type Orbit, type Vector } from './orbit';
import type { PointMap } from './point_map';

/** In CSS pixels: points thinner than the smallest size would flicker, larger ones hide everything. */
export const pointPixels = { min: 1.5, max: 48 };

const vertexShader = `
  attribute vec4 tint;
  uniform float diameter;
  uniform vec2 limits;
  varying vec3 shade;
  varying float size;
  void main() {
    shade = tint.rgb;
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * seen;
    size = clamp(diameter / -seen.z, limits.x, limits.y);
    gl_PointSize = size;
  }`;

// Discs, where there are pixels enough to tell a disc from a square.
const fragmentShader = `
  varying vec3 shade;
  varying float size;
  void main() {
    vec2 offset = gl_PointCoord - 0.5;
    if (size > 3.5 && dot(offset, offset) > 0.25) discard;
    gl_FragColor = vec4(shade, 1.0);
  }`;

export interface Cloud {
  map: PointMap;
  /** Relative to the scene's center, x y z of one point after the other. */
  positions: Float32Array;
  colors: Uint8Array;
  points: Points;
}

export interface Scene {
  canvas: HTMLCanvasElement;
  clouds: Cloud[];
  orbit: Orbit;
  /** World diameter of the points. */
  diameter: number;
  show(cloud: Cloud): void;
  recolored(cloud: Cloud): void;
  setBackground(color: string): void;
  /** Asks for a frame; many asks make one. */
  request(): void;
  /** Draws at once. */
  draw(): void;
  onDraw(listener: () => void): void;
  /** World to clip space, by columns. */
  projection(): Matrix4;
  aspect(): number;
}

function makeCloud(map: PointMap, center: Vector, material: ShaderMaterial): Cloud {
  const count = map.text.points;
  const positions = new Float32Array(3 * count);
  map.world.forEach((coordinates, k) => {
    for (let i = 0; i < count; ++i) positions[3 * i + k] = coordinates[i] - center[k];
  });
  const colors = new Uint8Array(4 * count);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setAttribute('tint', new BufferAttribute(colors, 4, true));
  const points = new Points(geometry, material);
  points.frustumCulled = false;
  points.visible = false;
  return { map, positions, colors, points };
}

/** Distance from the center that holds every point, far ones too. */
function reach(clouds: Cloud[]): number {
  let largest = 0;
  for (const { positions: p } of clouds) {
    for (let i = 0; i < p.length; i += 3) largest = Math.max(largest, p[i] ** 2 + p[i + 1] ** 2 + p[i + 2] ** 2);
  }
  return Math.sqrt(largest);
}

function place(camera: PerspectiveCamera, orbit: Orbit, radius: number, aspect: number): void {
  const { right, up, back } = basis(orbit);
  camera.quaternion.setFromRotationMatrix(
    new Matrix4().makeBasis(new Vector3(...right), new Vector3(...up), new Vector3(...back)),
  );
  camera.position.set(...eye(orbit));
  camera.aspect = aspect;
  camera.far = 1.1 * (camera.position.length() + radius);
  camera.near = Math.min(orbit.distance * 0.02, camera.far / 2);
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld();
}

/** A scene around the center (a world point), or nothing where there is no WebGL. */
export function makeScene(canvas: HTMLCanvasElement, maps: PointMap[], center: Vector): Scene | undefined {
  // Asked for here because three.js complains on the console where there is none.
  const context = canvas.getContext('webgl2', { antialias: false, alpha: false, powerPreference: 'high-performance' });
  if (!context) return undefined;
  const renderer = new WebGLRenderer({ canvas, context });
  const material = new ShaderMaterial({
    vertexShader,
    fragmentShader,
    uniforms: { diameter: { value: 1 }, limits: { value: [1, 64] } },
  });
  const clouds = maps.map((map) => makeCloud(map, center, material));
  const world = new ThreeScene();
  world.add(...clouds.map((cloud) => cloud.points));
  const camera = new PerspectiveCamera((fieldOfView * 180) / Math.PI);
  const radius = reach(clouds);
  const listeners: (() => void)[] = [];
  let asked = false;

  const scene: Scene = {
    canvas,
    clouds,
    orbit: { target: [0, 0, 0], azimuth: 0, elevation: 0, distance: 1 },
    diameter: 1,
    show(cloud) {
      for (const other of clouds) other.points.visible = other === cloud;
      scene.request();
    },
    recolored(cloud) {
      cloud.points.geometry.getAttribute('tint').needsUpdate = true;
      scene.request();
    },
    setBackground(color) {
      renderer.setClearColor(color);
      scene.request();
    },
    request() {
      if (!asked) requestAnimationFrame(scene.draw);
      asked = true;
    },
    draw() {
      asked = false;
      resize(renderer, canvas);
      place(camera, scene.orbit, radius, scene.aspect());
      const ratio = renderer.getPixelRatio();
      material.uniforms.diameter.value = (scene.diameter * canvas.height) / (2 * Math.tan(fieldOfView / 2));
      material.uniforms.limits.value = [pointPixels.min * ratio, pointPixels.max * ratio];
      renderer.render(world, camera);
      for (const listener of listeners) listener();
    },
    onDraw: (listener) => listeners.push(listener),
    projection: () => new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse),
    aspect: () => canvas.clientWidth / Math.max(1, canvas.clientHeight),
  };
  new ResizeObserver(() => scene.request()).observe(canvas);
  canvas.addEventListener('webglcontextrestored', () => scene.request());
  return scene;
}

function resize(renderer: WebGLRenderer, canvas: HTMLCanvasElement): void {
  const ratio = Math.min(2, devicePixelRatio);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width === Math.floor(width * ratio) && canvas.height === Math.floor(height * ratio)) return;
  renderer.setPixelRatio(ratio);
  renderer.setSize(width, height, false);
}
