#!/usr/bin/python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws what bench_pipeline measured: plot_growth.py growth.csv growth.svg."""
import csv
import sys

import numpy as np

WIDTH, HEIGHT, LEFT, TOP, PLOT_W, PLOT_H = 960, 380, 70, 50, 370, 260


def ticks(top):
    step = 10 ** np.floor(np.log10(top))
    step = next(step * f for f in (0.1, 0.2, 0.5, 1, 2, 5) if top / (step * f) <= 6)
    return np.arange(0, top + 1e-9 * top, step)


def panel(rows, x0, title, label):
    x = np.array([float(r["size"]) for r in rows])
    y = np.array([float(r["processor_s"]) for r in rows])
    slope, constant = np.polyfit(x, y, 1, w=1 / y)
    right, top = 1.05 * x.max(), 1.15 * y.max()
    px = lambda v: x0 + PLOT_W * v / right
    py = lambda v: TOP + PLOT_H * (1 - v / top)
    out = [f'<text x="{x0 + PLOT_W / 2}" y="{TOP - 20}" text-anchor="middle" font-size="15">{title}</text>',
           f'<rect x="{x0}" y="{TOP}" width="{PLOT_W}" height="{PLOT_H}" fill="none" stroke="#888"/>']
    for v in ticks(right):
        out.append(f'<text x="{px(v):.1f}" y="{TOP + PLOT_H + 18}" text-anchor="middle">{v:g}</text>')
        out.append(f'<line x1="{px(v):.1f}" y1="{TOP + PLOT_H}" x2="{px(v):.1f}" y2="{TOP + PLOT_H + 4}" stroke="#888"/>')
    for v in ticks(top):
        out.append(f'<text x="{x0 - 8}" y="{py(v) + 4:.1f}" text-anchor="end">{v:g}</text>')
        out.append(f'<line x1="{x0}" y1="{py(v):.1f}" x2="{x0 + PLOT_W}" y2="{py(v):.1f}" stroke="#e4e4e4"/>')
    line = lambda f: (f'x1="{px(0):.1f}" y1="{py(f * constant):.1f}" '
                      f'x2="{px(x.max()):.1f}" y2="{py(f * (constant + slope * x.max())):.1f}"')
    out.append(f'<line {line(1)} stroke="#27609c" stroke-width="1.5"/>')
    out += [f'<line {line(f)} stroke="#27609c" stroke-dasharray="4 4" opacity="0.5"/>' for f in (0.8, 1.2)
            if f * (constant + slope * x.max()) <= top]
    out += [f'<circle cx="{px(a):.1f}" cy="{py(b):.1f}" r="4" fill="#c2471c"/>' for a, b in zip(x, y)]
    out.append(f'<text x="{x0 + PLOT_W / 2}" y="{TOP + PLOT_H + 42}" text-anchor="middle">{label}</text>')
    return out


def main():
    with open(sys.argv[1], newline="") as stream:
        rows = list(csv.DictReader(stream))
    of = lambda what: [r for r in rows if r["by"] == what]
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" '
           'font-size="12">', f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    out += panel(of("vertices"), LEFT, "By the crown's vertices, e = 0.5 mm", "vertices")
    out += panel(of("1/e^2"), LEFT + 480, "By the root's density", "1 / e² in 1/mm²")
    out.append(f'<text transform="translate(18 {TOP + PLOT_H / 2}) rotate(-90)" text-anchor="middle">'
               'processor seconds (dashed: ± 20 %)</text></svg>')
    with open(sys.argv[2], "w") as stream:
        stream.write("\n".join(out) + "\n")


main()
