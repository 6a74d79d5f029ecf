#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times two builds of the program in one run, in turn: compare_speed.py PROGRAM OTHER [--models FOLDER]
[--other-models FOLDER] [--runs 7] CROWN_FDI... Prints a table in Markdown with medians per crown and their ratio. Cold: the
whole process by the clock. Warm: its stages alone, which is what a program pays that holds the models. Processor: user and
system time of the process."""

import argparse
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time


def run(program, models, crown, folder):
    """Seconds by the clock, of the processor, in stages; megabytes at most."""
    report = folder / 'tooth.json'
    command = [program, 'complete', crown, '--fdi', re.search(r'_(\d\d)$', crown.stem).group(1),
               '-o', folder / 'tooth.ply', '--report', report, *(['--models', models] if models else [])]
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    if status != 0:
        sys.exit(f'{program} did not complete {crown}')
    stages = sum(stage['seconds'] for stage in json.loads(report.read_text())['stages'])
    return wall, usage.ru_utime + usage.ru_stime, stages, usage.ru_maxrss / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('program')
    parser.add_argument('other')
    parser.add_argument('crowns', nargs='+', type=pathlib.Path)
    parser.add_argument('--models')
    parser.add_argument('--other-models')
    parser.add_argument('--runs', type=int, default=7)
    options = parser.parse_args()
    print('| crown | cold, s | other | ratio | warm, s | other | ratio | processor, s | other | ratio | MB | other |')
    print('|---|---|---|---|---|---|---|---|---|---|---|---|')
    ratios = []
    with tempfile.TemporaryDirectory() as scratch:
        for crown in options.crowns:
            runs = [[], []]
            for _ in range(options.runs):
                for which, (program, models) in enumerate(((options.program, options.models),
                                                           (options.other, options.other_models))):
                    runs[which].append(run(program, models, crown, pathlib.Path(scratch)))
            ours, theirs = ([statistics.median(column) for column in zip(*r)] for r in runs)
            row, ratio = [crown.stem], []
            for i in (0, 2, 1):
                ratio.append(ours[i] / theirs[i])
                row += [f'{ours[i]:.2f}', f'{theirs[i]:.2f}', f'{ratio[-1]:.2f}']
            ratios.append(ratio)
            print('| ' + ' | '.join(row + [f'{ours[3]:.0f}', f'{theirs[3]:.0f}']) + ' |', flush=True)
    cold, warm, processor = (statistics.median(column) for column in zip(*ratios))
    print(f'\nMedian ratio over {len(ratios)} crowns: cold {cold:.2f}, warm {warm:.2f}, processor {processor:.2f}')


if __name__ == '__main__':
    main()
