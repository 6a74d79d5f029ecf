#!/usr/bin/python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws what bench_robustness measured: plot_robustness.py robustness.csv robustness.svg."""
import csv
import sys

PANELS = {"alpha": "seen share of the tooth", "tilt": "tilt of the cut, degrees", "noise": "noise, mm",
          "gaps": "gaps at the contacts, mm", "wear": "wear, mm"}
COLOURS = {"rhizodont": "#c2471c", "template": "#27609c"}
ROWS = {"root_length_mm": "root length, mm", "root_chamfer_mm": "root Chamfer, mm"}
LEFT, TOP, STEP_X, STEP_Y, PLOT_W, PLOT_H = 64, 44, 190, 210, 150, 140


def panel(rows, figure, x0, y0, title, top):
    values = sorted({float(r["value"]) for r in rows})
    low, high = values[0], values[-1]
    px = lambda v: x0 + PLOT_W * (v - low) / (high - low)
    py = lambda v: y0 + PLOT_H * (1 - v / top)
    out = [f'<rect x="{x0}" y="{y0}" width="{PLOT_W}" height="{PLOT_H}" fill="none" stroke="#888"/>',
           f'<text x="{x0 + PLOT_W / 2}" y="{y0 + PLOT_H + 32}" text-anchor="middle">{title}</text>']
    out += [f'<text x="{px(v):.1f}" y="{y0 + PLOT_H + 15}" text-anchor="middle">{v:g}</text>'
            for v in (low, high)]
    out += [f'<text x="{x0 - 6}" y="{py(v) + 4:.1f}" text-anchor="end">{v:g}</text>' for v in (0, top / 2, top)]
    for who, colour in COLOURS.items():
        mine = sorted((float(r["value"]), float(r[figure])) for r in rows if r["predictor"] == who and int(r["teeth"]))
        points = " ".join(f"{px(v):.1f},{py(min(f, top)):.1f}" for v, f in mine)
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.8"/>')
        out += [f'<circle cx="{px(v):.1f}" cy="{py(min(f, top)):.1f}" r="3" fill="{colour}"/>' for v, f in mine]
    return out


def main():
    with open(sys.argv[1], newline="") as stream:
        rows = list(csv.DictReader(stream))
    width, height = LEFT + STEP_X * len(PANELS), TOP + STEP_Y * len(ROWS)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
           'font-size="12">', f'<rect width="{width}" height="{height}" fill="white"/>']
    for i, (who, colour) in enumerate(COLOURS.items()):
        out.append(f'<text x="{LEFT + 110 * i}" y="20" fill="{colour}" font-size="14">{who}</text>')
    for k, (figure, label) in enumerate(ROWS.items()):
        y0 = TOP + STEP_Y * k
        top = round(1.1 * max(float(r[figure]) for r in rows), 1)
        out.append(f'<text transform="translate(16 {y0 + PLOT_H / 2}) rotate(-90)" text-anchor="middle">{label}</text>')
        for i, (factor, title) in enumerate(PANELS.items()):
            out += panel([r for r in rows if r["factor"] == factor], figure, LEFT + STEP_X * i, y0, title, top)
    out.append("</svg>")
    with open(sys.argv[2], "w") as stream:
        stream.write("\n".join(out) + "\n")


main()
