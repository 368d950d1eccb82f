// Numbers as people read them.

const grouped = new Intl.NumberFormat('en-US');
export const dash = '–';

export function count(value: number): string {
  return grouped.format(value);
}

/** Four significant digits, and never fewer than all digits before the point. */
export function number(value: number): string {
  if (Number.isInteger(value)) return count(value);
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-4) return value.toExponential(3);
  const decimals = Math.max(0, 3 - Math.floor(Math.log10(size)));
  return size >= 1e4 ? grouped.format(Math.round(value)) : value.toFixed(decimals);
}

/** Parameters and ends of axes: no digits that say nothing. */
export function short(value: number): string {
  return String(Number(value.toPrecision(6)));
}

/** As short as it can be without losing anything. */
export function exact(value: number): string {
  return String(value);
}

export function percent(share: number): string {
  if (!Number.isFinite(share)) return dash;
  const value = 100 * share;
  if (value > 0 && value < 0.01) return '< 0.01 %';
  return `${value.toFixed(value < 1 ? 2 : 1)} %`;
}

/** Unit beside a value; the unit 1 of shares and ratios is not written. */
export function unitText(unit: string): string {
  return unit === '1' ? '' : unit.replace('^2', '²');
}

export function withUnit(text: string, unit: string): string {
  return unitText(unit) ? `${text} ${unitText(unit)}` : text;
}

export function utc(text: string): string {
  const match = /^(\d{4}-\d{2}-\d{2})T(\d{2}:\d{2})/.exec(text);
  return match ? `${match[1]} ${match[2]} UTC` : text;
}
