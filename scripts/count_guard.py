#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fails where the program does more work than it is known to: count_guard.py [--build build] [--tolerance 3] [--update]

Counts, not times, so that they are the same whatever else the machine does:
- instructions of each stage of completing a tooth, counted by callgrind in bench_stages, on one thread: a small crown with a peg for
  a root, so that neither weights nor networks have a say; linear algebra with OpenBLAS' Haswell kernels whatever the processor is;
- allocations of a few commands (calls and bytes), counted by libcount_allocations.so, on one thread.

What is expected stands in bench/stages/expected_counts.json with the compiler and C library it was counted with; --update writes it
anew, and a change that needs it says why. A count over the tolerance (percent) is a failure; one under it by as much is told, for
then the expectation is to be updated. Ends with 77 (skipped) where valgrind or Google Benchmark is missing, where the processor has no AVX2 (the
kernels need it), or where the build is by another compiler or C library or with other flags than the expectation."""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parent.parent
EXPECTED = SOURCE / 'bench/stages/expected_counts.json'
SKIPPED = 77
ENVIRONMENT = {**os.environ, 'OPENBLAS_CORETYPE': 'Haswell', 'OMP_NUM_THREADS': '1', 'LC_ALL': 'C'}


def run(*words, **more):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, env={**ENVIRONMENT, **more})
    if done.returncode:
        sys.exit(f'{" ".join(str(w) for w in words)} ended with {done.returncode}:\n{done.stderr[-2000:]}')
    return done.stdout


def instructions(build):
    """By stage. Callgrind writes a file each time the function that runs a stage is left."""
    with tempfile.TemporaryDirectory() as folder:
        names = run('valgrind', '--tool=callgrind', f'--callgrind-out-file={folder}/counts', '--collect-atstart=no',
                    '--toggle-collect=rhizodont_counted', '--dump-after=rhizodont_counted', build / 'bench/stages/bench_stages',
                    '--once').split()
        counts = {}
        for number, name in enumerate(names, 1):
            text = (pathlib.Path(folder) / f'counts.{number}').read_text()
            counts[name] = int(re.search(r'^(?:totals|summary): (\d+)', text, re.M).group(1))
        return counts


def allocations(build):
    """By command: calls and bytes."""
    program, samples = build / 'apps/rhizodont/rhizodont', SOURCE / 'samples'
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        tooth = folder / 'tooth.ply'
        commands = {
            'complete': ('complete', samples / 'crown_23.ply', '--fdi', 23, '--threads', 1, '-o', tooth, '--quiet'),
            'check': ('check', samples / 'crown_23.ply', tooth),
            'measure': ('measure', tooth),
            'segment': ('segment', samples / 'scan_lower.ply', '--threads', 1, '-o', folder / 'labels.json', '--quiet'),
        }
        counts = {}
        for command, words in commands.items():
            file = folder / f'{command}.txt'
            run(program, *words, LD_PRELOAD=build / 'bench/stages/libcount_allocations.so', RHIZODONT_ALLOCATIONS=file)
            calls, size = file.read_text().split()
            counts[f'{command}, calls'], counts[f'{command}, bytes'] = int(calls), int(size)
        return counts


def reason_to_skip(build):
    if not shutil.which('valgrind'):
        return 'valgrind is not installed (scripts/install_dependencies.sh).'
    if not (build / 'bench/stages/bench_stages').exists():
        return f'There is no bench_stages in {build}: it needs libbenchmark-dev and RHIZODONT_BENCH.'
    if not re.search(r'^flags\s*:.*\bavx2\b', pathlib.Path('/proc/cpuinfo').read_text(), re.M):
        return 'This processor has no AVX2, with which the counts were made.'
    return None


def compare(expected, counted, tolerance):
    """Prints a table; how many are over."""
    print('| what | expected | counted | change |\n|---|---|---|---|')
    over = under = 0
    for what in sorted({*expected, *counted}, key=list({**counted, **expected}).index):
        before, now = expected.get(what), counted.get(what)
        if before is None or now is None:
            print(f'| {what} | {before or ""} | {now or ""} | OVER: not in both |')
            over += 1
            continue
        change = 100 * (now / before - 1)
        word = ' OVER' if change > tolerance else ' under' if change < -tolerance else ''
        over, under = over + (word == ' OVER'), under + (word == ' under')
        print(f'| {what} | {before:,} | {now:,} | {change:+.2f} %{word} |')
    if under:
        print(f'\n{under} counts are more than {tolerance:g} % under: count_guard.py --update keeps what was won.')
    return over


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--build', type=pathlib.Path, default=SOURCE / 'build')
    parser.add_argument('--tolerance', type=float, default=3)
    parser.add_argument('--update', action='store_true')
    arguments = parser.parse_args()
    reason = reason_to_skip(arguments.build)
    if reason:
        print(f'Skipped: {reason}')
        return SKIPPED
    made_with = run(arguments.build / 'bench/stages/bench_stages', '--compiler').strip()
    expected = json.loads(EXPECTED.read_text()) if EXPECTED.exists() else {}
    if not arguments.update and expected.get('made_with') != made_with:
        print(f'Skipped: this build is by {made_with}, the expected counts by {expected.get("made_with", "none")}.')
        return SKIPPED
    groups = {'instructions': instructions(arguments.build), 'allocations': allocations(arguments.build)}
    over = 0
    for title, counted in groups.items():
        print(f'\n{title.capitalize()}:\n')
        over += compare(expected.get(title, {}), counted, arguments.tolerance)
    if over and not arguments.update:
        print(f'\n{over} counts are more than {arguments.tolerance:g} % over what is expected. If that is meant: count_guard.py --update, and say why.')
    if arguments.update:
        EXPECTED.write_text(json.dumps({'made_with': made_with, **groups}, indent=2) + '\n')
        return 0
    return 1 if over else 0


if __name__ == '__main__':
    sys.exit(main())
