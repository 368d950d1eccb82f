// Definitions beside what they define, on hover and on keyboard focus.
import { element } from './dom';

const delay = 250;
const bubble = element('div', { class: 'tooltip', role: 'tooltip', id: 'tooltip', hidden: true });
let timer = 0;

function place(anchor: Element): void {
  const at = anchor.getBoundingClientRect();
  const own = bubble.getBoundingClientRect();
  const left = Math.min(Math.max(8, at.left), Math.max(8, document.documentElement.clientWidth - own.width - 8));
  const below = at.bottom + 6;
  const fits = below + own.height < innerHeight || at.top < own.height + 6;
  bubble.style.left = `${left}px`;
  bubble.style.top = `${fits ? below : at.top - own.height - 6}px`;
}

function show(anchor: Element, text: string): void {
  clearTimeout(timer);
  if (!bubble.isConnected) document.body.append(bubble);
  bubble.textContent = text;
  bubble.hidden = false;
  place(anchor);
}

/** Not at once: the pointer may be on its way into the bubble, to read or to copy. */
function hideSoon(): void {
  clearTimeout(timer);
  timer = setTimeout(hide, delay);
}

function hide(): void {
  clearTimeout(timer);
  bubble.hidden = true;
}

/** Shows `text` beside `anchor`; screen readers get it from a hidden description. */
export function describe(anchor: HTMLElement, text: string, id: string): HTMLElement {
  const description = element('span', { id, hidden: true }, text);
  anchor.setAttribute('aria-describedby', id);
  anchor.addEventListener('focus', () => anchor.matches(':focus-visible') && show(anchor, text));
  anchor.addEventListener('blur', hide);
  anchor.addEventListener('click', hide);
  anchor.addEventListener('pointerenter', (event) => {
    if (event.pointerType === 'touch') return;
    clearTimeout(timer);
    if (anchor.getAttribute('aria-expanded') !== 'true') timer = setTimeout(() => show(anchor, text), delay);
  });
  anchor.addEventListener('pointerleave', hideSoon);
  return description;
}

export function followTooltips(): void {
  bubble.addEventListener('pointerenter', () => clearTimeout(timer));
  bubble.addEventListener('pointerleave', hideSoon);
  addEventListener('keydown', (event) => event.key === 'Escape' && hide());
  addEventListener('scroll', hide, { passive: true });
}
