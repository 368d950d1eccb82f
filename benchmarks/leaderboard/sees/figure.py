"""The figure: metrics x defects, each cell with the size from which the metric moves and the curve of its change."""
import html

import defects
import judgment

LABEL, CELL_W, CELL_H, CURVE_X, CURVE_W, HEAD, GAP, MARGIN = 140, 82, 30, 42, 32, 68, 8, 14
RIGHT = ["#5b9bd0", "#82b4dd", "#a8cbe8", "#c8def1", "#e2eef8", "#eef5fb"]  # seen from the first, second ... size on
WRONG, NOTHING, INK, GRAY = "#f6b26b", "#f4f4f2", "#22262b", "#8a8f96"
CURVES = ("Curves: the change against size, up is worse, in square roots, by the largest change in the row. No curve: nothing changes. "
          "An end before the last size: no value there.")
UP, DOWN = 0.62, 0.26  # how much of a cell's height is for worse, for better scores


def text(x, y, words, size=11, anchor="start", color=INK, weight="normal"):
    return '<text x="%.1f" y="%.1f" font-size="%g" text-anchor="%s" fill="%s" font-weight="%s">%s</text>' % (
        x, y, size, anchor, color, weight, html.escape(words))


def box(x, y, width, height, fill):
    return '<rect x="%.1f" y="%.1f" width="%.1f" height="%.1f" rx="2" fill="%s"/>' % (x, y, width, height, fill)


def tint(cell):
    right, wrong = cell.first(1), cell.first(-1)
    if wrong is not None:
        return WRONG
    return NOTHING if right is None else RIGHT[cell.sizes.index(right)]


def curve(cell, x, y, scale):
    """From no defect on; up is worse. Square roots, so that small changes show."""
    if not any(cell.changes):
        return []
    left, base, points = x + CURVE_X, y + CELL_H * (UP + 0.06), []
    for k, value in enumerate([0.0] + cell.changes):
        if value is not None:
            height = (abs(value) / scale) ** 0.5 * CELL_H * (UP if value > 0 else -DOWN)
            points.append("%.1f,%.1f" % (left + k * CURVE_W / len(cell.changes), base - height))
    return ['<line x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f" stroke="%s" stroke-width="0.5" stroke-dasharray="2 2"/>'
            % (left, base, left + CURVE_W, base, GRAY),
            '<polyline points="%s" fill="none" stroke="%s" stroke-width="1.4" stroke-linejoin="round"/>' % (" ".join(points), INK)]


def drawn_cell(cell, x, y, scale):
    parts = [box(x, y, CELL_W - 2, CELL_H - 2, tint(cell))]
    if all(c is None for c in cell.changes):
        return parts + [text(x + CELL_W / 2, y + CELL_H / 2 + 3, "no value", 9, "middle", GRAY)]
    right, wrong = cell.first(1), cell.first(-1)
    if wrong is not None:
        parts.append(text(x + 4, y + CELL_H - 7, "▼%g" % wrong, 9.5, weight="bold"))
    if right is not None:
        parts.append(text(x + 4, y + (11 if wrong is not None else CELL_H / 2 + 3), "%g" % right, 9.5))
    return parts + curve(cell, x, y, scale)


def heads(planted, y):
    parts = []
    for k, defect in enumerate(planted.values()):
        x = MARGIN + LABEL + k * CELL_W + 3
        first, last = defect.sizes[0], defect.sizes[-1]
        parts += [text(x, y + 12 * line, word, 11, weight="bold") for line, word in enumerate(defect.title.split())]
        parts.append(text(x, y + 26, "%g–%g %s" % (first, last, defect.unit), 9.5, color=GRAY))
    return parts


def legend(y):
    parts, x = [text(MARGIN + LABEL, y + 20, CURVES, 10.5, color=GRAY)], MARGIN + LABEL
    keys = [(RIGHT[0], "the score gets worse, from the smallest size on"), (RIGHT[3], "from a greater size on, the number"),
            (WRONG, "▼ the worse map scores better, from that size on"), (NOTHING, "not seen")]
    for fill, words in keys:
        parts += [box(x, y - 10, 18, 13, fill), text(x + 24, y, words, 10.5)]
        x += 50 + 5.6 * len(words)
    return parts


def drawn_row(row, cells, y):
    scale = max((abs(c) for cell in cells for c in cell.changes if c is not None), default=0)
    parts = [text(MARGIN, y + CELL_H / 2 + 3, row.title)]
    for column, cell in enumerate(cells):
        parts += drawn_cell(cell, MARGIN + LABEL + column * CELL_W, y, scale)
    return parts


def draw(scene, found):
    """One scene as SVG."""
    planted = defects.planted(scene)
    parts = [text(MARGIN, MARGIN + 14, "What each number sees: %s" % scene, 15, weight="bold")] + heads(planted, MARGIN + 34)
    y = MARGIN + HEAD
    for group in judgment.groups(scene):
        for row in group:
            parts += drawn_row(row, [found[row.title, name] for name in planted], y)
            y += CELL_H
        y += GAP
    parts += legend(y + 10)
    size = {"width": 2 * MARGIN + LABEL + CELL_W * len(planted), "height": y + 44}
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="%(width)d" height="%(height)d" viewBox="0 0 %(width)d %(height)d" '
            'font-family="DejaVu Sans, Liberation Sans, Arial, sans-serif">\n<rect width="100%%" height="100%%" fill="#ffffff"/>\n' % size
            + "\n".join(parts) + "\n</svg>\n")
