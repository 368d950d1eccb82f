#!/usr/bin/env python3
"""Draws text from standard input as an SVG terminal: cmap_eval REF EST | sed "/^warnings/,$d" | docs/table_svg.py > docs/cmap_eval.svg"""

import html
import sys

LINE_HEIGHT, CHARACTER_WIDTH, MARGIN = 18, 8.0, 16

lines = sys.stdin.read().rstrip("\n").split("\n")
width = max(map(len, lines)) * CHARACTER_WIDTH + 2 * MARGIN
height = len(lines) * LINE_HEIGHT + 2 * MARGIN
print(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height}" font-family="DejaVu Sans Mono, monospace" font-size="13">')
print(f'<rect width="100%" height="100%" rx="6" fill="#1e1e28"/>')
for i, line in enumerate(lines):
    is_heading = line and not line.startswith(" ")
    fill = "#8fd3ff" if is_heading else "#e6e6e6"
    y = MARGIN + (i + 0.8) * LINE_HEIGHT
    print(f'<text x="{MARGIN}" y="{y:.1f}" fill="{fill}" textLength="{len(line) * CHARACTER_WIDTH:.0f}" xml:space="preserve">{html.escape(line)}</text>')
print("</svg>")
