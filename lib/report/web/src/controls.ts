// Mouse, touch and keyboard on the canvas of the map.
import { type Orbit, pan, turn, zoom } from './orbit';

export interface Controls {
  orbit: () => Orbit;
  changed: () => void;
  click: (x: number, y: number) => void;
  doubleClick: (x: number, y: number) => void;
  key: (key: string) => boolean;
}

const clickSlack = 4;
const keyTurn = Math.PI / 36;
const keyPan = 0.05;
const keyZoom = 0.85;

interface Gesture {
  x: number;
  y: number;
  spread: number;
}

/** Middle and mean spread of the pointers that are down. */
function gesture(pointers: Map<number, PointerEvent>): Gesture {
  const events = [...pointers.values()];
  const mean = (of: (event: PointerEvent) => number) => events.reduce((sum, e) => sum + of(e), 0) / events.length;
  const [x, y] = [mean((event) => event.offsetX), mean((event) => event.offsetY)];
  return { x, y, spread: mean((event) => Math.hypot(event.offsetX - x, event.offsetY - y)) };
}

function followPointers(canvas: HTMLCanvasElement, controls: Controls): void {
  const pointers = new Map<number, PointerEvent>();
  let last: Gesture = { x: 0, y: 0, spread: 0 };
  let start: Gesture | undefined;

  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, event);
    last = gesture(pointers);
    start = pointers.size === 1 ? last : undefined;
  });
  canvas.addEventListener('pointermove', (event) => {
    if (!pointers.has(event.pointerId)) return;
    pointers.set(event.pointerId, event);
    const now = gesture(pointers);
    if (start && Math.hypot(now.x - start.x, now.y - start.y) > clickSlack) start = undefined;
    if (!start) move(event, now);
    last = now;
  });
  const end = (event: PointerEvent) => {
    if (!pointers.delete(event.pointerId)) return;
    if (pointers.size > 0) last = gesture(pointers);
    if (start && event.type === 'pointerup') controls.click(event.offsetX, event.offsetY);
    start = undefined;
  };
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);

  function move(event: PointerEvent, now: Gesture): void {
    const height = canvas.clientHeight;
    const [right, down] = [(now.x - last.x) / height, (now.y - last.y) / height];
    if (pointers.size > 1) {
      pan(controls.orbit(), -right, down);
      if (now.spread > 0 && last.spread > 0) zoom(controls.orbit(), last.spread / now.spread);
    } else if (event.shiftKey || event.ctrlKey || event.buttons !== 1) {
      pan(controls.orbit(), -right, down);
    } else {
      turn(controls.orbit(), right * Math.PI, down * Math.PI);
    }
    controls.changed();
  }
}

/** A wheel that scrolls the page already goes on to do so when the map comes under the pointer. */
function followWheel(canvas: HTMLCanvasElement, controls: Controls): void {
  let scrolled = -Infinity;
  addEventListener('scroll', () => (scrolled = performance.now()), { passive: true });
  canvas.addEventListener(
    'wheel',
    (event) => {
      if (performance.now() - scrolled < 250) return;
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY / 3 : event.deltaY / 100;
      const [width, height] = [canvas.clientWidth, canvas.clientHeight];
      const right = (event.offsetX - width / 2) / height;
      const up = (height / 2 - event.offsetY) / height;
      zoom(controls.orbit(), Math.exp(0.18 * Math.max(-3, Math.min(3, lines))), right, up);
      controls.changed();
    },
    { passive: false },
  );
}

const moves: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

function followKeys(canvas: HTMLCanvasElement, controls: Controls): void {
  canvas.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const move = moves[event.key];
    if (move && event.shiftKey) pan(controls.orbit(), keyPan * move[0], keyPan * move[1]);
    else if (move) turn(controls.orbit(), keyTurn * move[0], keyTurn * move[1]);
    else if (event.key === '+' || event.key === '=') zoom(controls.orbit(), keyZoom);
    else if (event.key === '-' || event.key === '_') zoom(controls.orbit(), 1 / keyZoom);
    else if (!controls.key(event.key)) return;
    event.preventDefault();
    controls.changed();
  });
}

export function follow(canvas: HTMLCanvasElement, controls: Controls): void {
  followPointers(canvas, controls);
  followWheel(canvas, controls);
  followKeys(canvas, controls);
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('dblclick', (event) => controls.doubleClick(event.offsetX, event.offsetY));
}
