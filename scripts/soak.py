#!/usr/bin/python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Completes many teeth in one process and asserts that its memory stays flat: PYTHONPATH=build/python scripts/soak.py [TEETH=2000]
[--threads 1] [--minutes M] [--document]

The samples in turn, each with its own fineness, roots and ways of use, all from the crown's number: completed whole; prepared once
and finished three times; three candidates; repaired; skirt dropped. Of one crown in ten a tooth is also checked, saved in four
formats and made a page of, and one crown in 25 has to be refused first. Every 20 teeth, after a garbage collection, two
sizes are read: what the process holds in memory (RSS), and what of its heap is in use (mallinfo2).

The rule, on readings after tooth 100: of those of the last fifth the lowest RSS is at most 2 % above the lowest of the first fifth, and the
highest 5 % above the highest (the two, not a mean: RSS goes to and fro between two levels, and a leak raises
both); between the fifths' medians the heap in use grows by at most 0.5 KB per tooth. Prints a row of a table in Markdown; --document writes it and the plot into
docs/faults.md and docs/soak.svg. Ends with 1 if the rule does not hold or a tooth ends otherwise than it should."""

import argparse
import ctypes
import datetime
import gc
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile
import time

import rhizodont

SOURCE = pathlib.Path(__file__).resolve().parent.parent
SAMPLES = ['crown_36.stl', 'crown_23.ply', 'crown_34.ply', 'crown_16.ply', 'crown_11.stl', 'crown_23.ply', 'skirt_36.ply', 'crown_34.ply',
           'crown_11.stl']
EVERY = 20  # teeth between readings
WARM = 100  # teeth before the first reading that counts
LEAST_TEETH = WARM + 5 * EVERY
MOST_LOWEST, MOST_HIGHEST = 1.02, 1.05  # RSS of the last fifth to that of the first
MOST_HEAP = 512  # bytes per tooth
ROW_MARK = '<!-- rows of scripts/soak.py -->'


class HeapFigures(ctypes.Structure):
    """glibc's struct mallinfo2."""

    _fields_ = [(name, ctypes.c_size_t) for name in
                'arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost'.split()]


LIBC = ctypes.CDLL(None)
LIBC.mallinfo2.restype = HeapFigures


def reading():
    """Bytes held, bytes of the heap in use."""
    gc.collect()
    held = int(pathlib.Path('/proc/self/statm').read_text().split()[1]) * os.sysconf('SC_PAGE_SIZE')
    heap = LIBC.mallinfo2()
    return held, heap.uordblks + heap.hblkhd


def must_refuse(crown, models, **options):
    """A crown with a triangle turned over. No option may take the triangle away."""
    triangles = crown.triangles.copy()
    triangles[len(triangles) // 2] = triangles[len(triangles) // 2][::-1]
    try:
        rhizodont.complete((crown.vertices, triangles), models, **options)
    except rhizodont.InputError:
        return
    raise AssertionError('A crown with a flipped triangle was not refused.')


def use(tooth, crown, folder):
    """What a program does with a tooth. Its files go in a folder in which the last ones are."""
    if not tooth.check(crown)['holds']:
        raise AssertionError('A tooth does not hold its promises.')
    for suffix in ('ply', 'stl', 'obj', 'glb'):
        tooth.save(folder / f'tooth.{suffix}')
    rhizodont.load(folder / 'tooth.ply').measure()
    tooth.page()


def a_root(rng):
    return {'root_length': round(rng.uniform(9, 18), 1), 'tip': round(rng.uniform(-8, 8), 1), 'torque': round(rng.uniform(-8, 8), 1),
            'bend': round(rng.uniform(-15, 15), 1)}


def complete(n, crowns, models, threads, folder):
    """Teeth of crown number n; how many."""
    rng = random.Random(n)
    name = SAMPLES[n % len(SAMPLES)]
    crown = crowns[name]
    options = {'fdi': int(re.search(r'_(\d\d)', name).group(1)), 'e': rng.choice([1.0, 1.2, 1.5]), 'threads': threads,
               'repair': rng.random() < 0.2}
    if n % 25 == 24:
        must_refuse(crown, models, **{**options, 'repair': False})
    if name.startswith('skirt'):
        options['skirt'] = 'auto'
    way = rng.random()
    if way < 0.4:
        teeth = [rhizodont.complete(crown, models, **options, **(a_root(rng) if rng.random() < 0.5 else {}))]
    elif way < 0.85:
        prepared = rhizodont.prepare(crown, models, **options)
        teeth = [prepared.finish(), prepared.finish(**a_root(rng)), prepared.finish(**a_root(rng))]
    else:
        teeth = rhizodont.candidates(crown, models, 3, **options)
    if n % 10 == 9:
        use(teeth[-1], crown, folder)
    return len(teeth)


def plot(readings):
    """The two sizes by teeth, as SVG."""
    width, height, left, top, wide, high = 760, 330, 60, 40, 660, 230
    right = readings[-1][0]
    most = 1.15 * max(held for _, held, _ in readings) / 1e6
    step = next(s for s in (10, 20, 50, 100, 200, 500, 1000, 2000) if most / s <= 6)
    x = lambda n: left + wide * n / right
    y = lambda mb: top + high * (1 - mb / most)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
           f'<rect width="{width}" height="{height}" fill="white"/>',
           f'<text x="{left + wide / 2}" y="22" text-anchor="middle" font-size="15">One process, {right:,} teeth</text>',
           f'<rect x="{x(0)}" y="{top}" width="{wide * WARM / right:.1f}" height="{high}" fill="#f0f0f0"/>',
           f'<rect x="{left}" y="{top}" width="{wide}" height="{high}" fill="none" stroke="#888"/>']
    for mb in range(0, int(most) + 1, step):
        out.append(f'<text x="{left - 8}" y="{y(mb) + 4:.1f}" text-anchor="end">{mb}</text>')
        out.append(f'<line x1="{left}" y1="{y(mb):.1f}" x2="{left + wide}" y2="{y(mb):.1f}" stroke="#e4e4e4"/>')
    for i in range(5):
        out.append(f'<text x="{x(right * i / 4):.1f}" y="{top + high + 18}" text-anchor="middle">{right * i // 4}</text>')
    for column, colour, words in ((1, '#c2471c', 'memory held (RSS)'), (2, '#27609c', 'heap in use')):
        points = ' '.join(f'{x(r[0]):.1f},{y(r[column] / 1e6):.1f}' for r in readings)
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        out.append(f'<text x="{left + wide - 8}" y="{y(readings[-1][column] / 1e6) - 8:.1f}" text-anchor="end" fill="{colour}">{words}</text>')
    out.append(f'<text x="{left + wide / 2}" y="{top + high + 42}" text-anchor="middle">teeth (grey: before the rule begins)</text>')
    out.append(f'<text transform="translate(18 {top + high / 2}) rotate(-90)" text-anchor="middle">MB</text></svg>')
    return '\n'.join(out) + '\n'


def machine():
    model = re.search(r'^model name\s*:\s*(.*)$', pathlib.Path('/proc/cpuinfo').read_text(), re.M)
    return f'{model.group(1) if model else os.uname().machine}, {os.cpu_count()} cores'


def commit():
    git = lambda *words: subprocess.run(['git', '-C', SOURCE, *words], capture_output=True, text=True)
    changed = git('diff', '--quiet', 'HEAD', '--', 'src', 'include', 'python', 'models').returncode
    return git('rev-parse', '--short', 'HEAD').stdout.strip() + (' with changes' if changed else '')


def row_of(readings, minutes, state):
    """A row for the table, and whether what is held is flat."""
    counted = [r for r in readings if r[0] > WARM]
    fifth = max(1, len(counted) // 5)
    first, last = counted[:fifth], counted[-fifth:]
    middle = lambda rows, column: statistics.median(r[column] for r in rows)
    lowest, highest = [min(r[1] for r in rows) / 1e6 for rows in (first, last)], [max(r[1] for r in rows) / 1e6 for rows in (first, last)]
    heap = [middle(rows, 2) for rows in (first, last)]
    growth = (heap[1] - heap[0]) / max(1, middle(last, 0) - middle(first, 0))
    flat = lowest[1] <= MOST_LOWEST * lowest[0] and highest[1] <= MOST_HIGHEST * highest[0] and growth <= MOST_HEAP
    figures = [datetime.date.today(), state, machine(), f'{readings[-1][0]:,}', f'{minutes:.0f}', f'{lowest[0]:.1f}', f'{lowest[1]:.1f}',
               f'{highest[0]:.1f}', f'{highest[1]:.1f}', f'{heap[0] / 1e6:.2f}', f'{heap[1] / 1e6:.2f}', f'{growth:.0f}', 'yes' if flat else 'no']
    return '| ' + ' | '.join(str(f) for f in figures) + ' |', flat


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('teeth', nargs='?', type=int, default=2000)
    parser.add_argument('--threads', type=int, default=1)
    parser.add_argument('--minutes', type=float, help='ends earlier, with as many teeth as there are then')
    parser.add_argument('--document', action='store_true')
    arguments = parser.parse_args()
    if arguments.teeth < LEAST_TEETH:
        parser.error(f'{LEAST_TEETH} teeth at least: the first {WARM} do not count.')
    models = rhizodont.Models(SOURCE / 'models')
    crowns = {name: rhizodont.load(SOURCE / 'samples' / name) for name in SAMPLES}
    readings, begun, state = [], time.monotonic(), commit()
    with tempfile.TemporaryDirectory() as folder:
        crown = teeth = 0
        while teeth < arguments.teeth and not (arguments.minutes and time.monotonic() - begun > 60 * arguments.minutes):
            more = complete(crown, crowns, models, arguments.threads, pathlib.Path(folder))
            crown += 1
            if (teeth + more) // EVERY > teeth // EVERY:
                readings.append((teeth + more, *reading()))
                print(f'{teeth + more} teeth, {time.monotonic() - begun:.0f} s: {readings[-1][1] / 1e6:.1f} MB held, '
                      f'{readings[-1][2] / 1e6:.2f} MB of heap in use', file=sys.stderr, flush=True)
            teeth += more
    if teeth < LEAST_TEETH:
        sys.exit(f'Only {teeth} teeth were made: too few for the rule.')
    row, flat = row_of(readings, (time.monotonic() - begun) / 60, state)
    print(row)
    if arguments.document:
        page = SOURCE / 'docs/faults.md'
        page.write_text(page.read_text().replace(ROW_MARK, row + '\n' + ROW_MARK))
        (SOURCE / 'docs/soak.svg').write_text(plot(readings))
    return 0 if flat else 1


if __name__ == '__main__':
    sys.exit(main())
