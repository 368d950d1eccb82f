'use strict';
// Every column of every table sorts: ascending, descending, and back to the order of the page. Headings are buttons, so
// that the keyboard reaches them; the arrow keys go from heading to heading. Missing values stay last.

const nextOrder = { none: 'ascending', ascending: 'descending', descending: 'none' };
const byText = new Intl.Collator('en', { numeric: true });

function compareCells(a, b, sign) {
  const [x, y] = [a, b].map((cell) => (cell.dataset.value === undefined ? NaN : Number(cell.dataset.value)));
  if (a.tagName === 'TH' || (a.className === 'head' && b.className === 'head')) {
    return sign * byText.compare(a.textContent, b.textContent);
  }
  if (Number.isNaN(x) || Number.isNaN(y)) return Number(Number.isNaN(x)) - Number(Number.isNaN(y));
  return sign * (x - y);
}

for (const table of document.querySelectorAll('table')) {
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const headings = [...table.tHead.rows[0].cells];
  const buttons = [];
  headings.forEach((heading, column) => {
    heading.setAttribute('aria-sort', 'none');
    const button = document.createElement('button');
    button.type = 'button';
    button.className = 'sort';
    button.append(...heading.childNodes);
    if (!button.textContent.trim()) button.setAttribute('aria-label', 'direction');
    heading.append(button);
    buttons.push(button);
    button.addEventListener('click', () => {
      const order = nextOrder[heading.getAttribute('aria-sort')];
      for (const other of headings) other.setAttribute('aria-sort', other === heading ? order : 'none');
      const sign = { none: 0, ascending: 1, descending: -1 }[order];
      const sorted = sign === 0 ? rows : [...rows].sort((a, b) => compareCells(a.cells[column], b.cells[column], sign));
      body.replaceChildren(...sorted);
    });
    button.addEventListener('keydown', (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      const neighbor = step && buttons[column + step];
      if (!neighbor) return;
      event.preventDefault();
      neighbor.focus();
    });
  });
}
document.documentElement.dataset.ready = '';
