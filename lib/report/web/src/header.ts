// Title, inputs, warnings.
import type { InputRecord, Report } from './contract';
import { button, element, saveBlob } from './dom';
import { count, utc } from './format';
import { themeButton } from './theme';

const colorText: Record<string, string> = { none: 'no color', u8: '8-bit color', u16: '16-bit color', f32: 'float color' };

function baseName(path: string): string {
  return path.split(/[\\/]/).pop() || path;
}

function pointsText({ points, finite_points }: InputRecord): string {
  if (finite_points === points) return `${count(points)} points`;
  return `${count(points)} points, ${count(finite_points)} of them finite`;
}

function inputBlock(role: string, input: InputRecord): HTMLElement {
  return element(
    'div',
    { class: 'input', 'data-input': role },
    element('h2', {}, role),
    element('p', { class: 'file', title: input.path }, baseName(input.path)),
    element('p', {}, `${pointsText(input)}, ${colorText[input.color] ?? input.color}, ${input.format}`),
    element(
      'p',
      { class: 'path' },
      baseName(input.path) === input.path ? undefined : input.path,
      element('span', { class: 'hash' }, 'SHA-256 ', element('code', { title: input.sha256 }, input.sha256.slice(0, 12))),
    ),
  );
}

function inputBlocks({ inputs }: Report): HTMLElement[] {
  return Object.entries(inputs).map(([role, input]) => inputBlock(inputs.reference ? role : 'map', input));
}

function warningList(report: Report): HTMLElement | undefined {
  if (report.warnings.length === 0) return undefined;
  const items = report.warnings.map(({ id, message }) => element('li', { 'data-warning': id }, message));
  const title = items.length === 1 ? '1 warning' : `${items.length} warnings`;
  return element('div', { class: 'warnings', role: 'note' }, element('strong', {}, title), element('ul', {}, ...items));
}

export function showHeader(head: HTMLElement, report: Report, title: string, text: string): void {
  document.title = title;
  const { tool, run } = report;
  const made = [`${tool.name} ${tool.version}`, utc(String(run.started_utc ?? ''))].filter(Boolean).join(' · ');
  const download = () => saveBlob(new Blob([text], { type: 'application/json' }), 'report.json');
  head.append(
    element(
      'div',
      { class: 'title' },
      element('div', {}, element('h1', {}, title), element('p', { class: 'note' }, made)),
      element(
        'div',
        { class: 'actions' },
        button('Download report.json', { 'data-action': 'download' }, download),
        themeButton(),
      ),
    ),
    element('div', { class: 'inputs' }, ...inputBlocks(report)),
  );
  const warnings = warningList(report);
  if (warnings) head.append(warnings);
}
