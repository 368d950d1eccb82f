// Elements made by hand. Text goes in as text: nothing of a report is ever read as markup.

type Attributes = Record<string, string | number | boolean | undefined>;
type Child = Node | string | undefined;

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    made.setAttribute(name, value === true ? '' : String(value));
  }
  made.append(...children.filter((child): child is Node | string => child !== undefined));
  return made;
}

const svg = 'http://www.w3.org/2000/svg';

/** A part of a drawing. */
export function vector(tag: string, attributes: Attributes = {}, ...children: Node[]): Element {
  const made = document.createElementNS(svg, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  made.append(...children);
  return made;
}

export function button(label: string, attributes: Attributes, onClick: () => void): HTMLButtonElement {
  const made = element('button', { type: 'button', ...attributes }, label);
  made.addEventListener('click', onClick);
  return made;
}

export function message(text: string): HTMLElement {
  return element('p', { class: 'message', role: 'alert' }, text);
}

export function section(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (!found) throw new Error(`no section ${id}`);
  found.hidden = false;
  return found;
}

export function rgb(color: ArrayLike<number>): string {
  return `rgb(${color[0]} ${color[1]} ${color[2]})`;
}

export function saveBlob(blob: Blob, name: string): void {
  const url = URL.createObjectURL(blob);
  element('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
