// Light or dark: as the system says until the reader chooses.
import { button } from './dom';

type Theme = 'light' | 'dark';

const systemIsDark = matchMedia('(prefers-color-scheme: dark)');
const listeners: (() => void)[] = [];
let chosen: Theme | undefined;
let printing = false;

const current = (): Theme => (printing ? 'light' : (chosen ?? (systemIsDark.matches ? 'dark' : 'light')));

function apply(): void {
  document.documentElement.dataset.theme = current();
  for (const listener of listeners) listener();
}

export function onThemeChange(listener: () => void): void {
  listeners.push(listener);
}

/** Value of a color of the style sheet. */
export function themeColor(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

export function followTheme(): void {
  systemIsDark.addEventListener('change', apply);
  const print = (now: boolean) => () => {
    printing = now;
    apply();
  };
  addEventListener('beforeprint', print(true));
  addEventListener('afterprint', print(false));
  apply();
}

export function themeButton(): HTMLButtonElement {
  const made = button('', { class: 'quiet', id: 'theme' }, () => {
    chosen = current() === 'dark' ? 'light' : 'dark';
    apply();
  });
  const label = () => (made.textContent = current() === 'dark' ? 'Light colors' : 'Dark colors');
  onThemeChange(label);
  label();
  return made;
}
