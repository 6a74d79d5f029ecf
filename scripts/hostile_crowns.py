#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Completes bad crowns by the thousand: hostile_crowns.py [COUNT=10000] [--first 0] [--out FOLDER] [--minutes M] [--jobs N] [--build FOLDER]

Crown number n is always the same: its kind of defect, seed, sample, size (most up to 1,500 vertices, one in 20 to 10,000, one
in 250 to 60,000, one in 2,500 of 500,000), fineness and whether it is repaired follow from n. Each tooth that is made is proved
in the same process with the project's own check, exactly and as a user checks it. Outcomes are appended to FOLDER/outcomes.tsv
(results/hostile), so that a run that was stopped, also by --minutes, goes on where it was; --table prints the table alone.
--first leaves out the numbers below it, so that several machines may share the work: their outcomes.tsv put together are one run.

Ends with 1 if a crown crashed the program, needed more than 60 s of processor time, ended in an exception that is no refusal, or
became a tooth that breaks a promise. Needs the target complete_hostile_crowns (scripts/test.sh). hostile_crowns.sh does the same
with the command line, whose exit codes and files it looks at, for fewer."""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import re
import select
import signal
import subprocess
import sys
import threading
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
SAMPLES = ['crown_36.stl', 'crown_23.ply', 'crown_16.ply', 'crown_11.stl', 'crown_34.ply']
SMALL = [100, 140, 200, 280, 400, 560, 800, 1100, 1500]  # few, for the clean crowns of these sizes are made once
MOST_SECONDS = 60  # of processor time, from the crown to the proved tooth
MOST_WAITING = 1800  # s on the clock: a program that waits for ever needs no processor time
FAULTS = ['broken', 'error', 'crashed', 'hangs']


def kinds_of(build):
    text = subprocess.run([build / 'tests/common/write_hostile_crown'], capture_output=True, text=True, check=True).stdout
    return text.splitlines()


def crown_number(n, kinds):
    """The line that asks for crown n."""
    rng = random.Random(n)
    kind, sample = kinds[n % len(kinds)], rng.choice(SAMPLES)
    if n % 2500 == 1250:
        vertices = 500_000
    elif n % 250 == 125:
        vertices = rng.randrange(10_000, 60_000)
    elif n % 20 == 10:
        vertices = rng.randrange(1_500, 10_000)
    else:
        vertices = rng.choice(SMALL)
    e = rng.choice([0.5, 0.8]) if rng.random() < 0.1 else 1.5
    return f'{sample}|{kind}|{n}|{vertices}|{e}|{int(rng.random() < 0.5)}'


class Worker:
    """A process that completes crowns until one ends it."""

    def __init__(self, program):
        self.program, self.process, self.read = program, None, b''

    def seconds(self):
        fields = pathlib.Path(f'/proc/{self.process.pid}/stat').read_text().rpartition(')')[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')

    def line(self, most_seconds):
        """The next line, or how the program ended instead."""
        begun, clock = self.seconds(), time.monotonic()
        while b'\n' not in self.read:
            if select.select([self.process.stdout], [], [], 0.5)[0]:
                more = os.read(self.process.stdout.fileno(), 65536)
                self.read += more
                if not more:
                    code = self.process.wait()
                    self.process = None
                    return f'crashed|{signal.Signals(-code).name if code < 0 else f"ended with {code}"}'
            elif self.seconds() - begun > most_seconds or time.monotonic() - clock > MOST_WAITING:
                self.process.kill()
                self.process.wait()
                self.process = None
                return 'hangs|'
        line, _, self.read = self.read.partition(b'\n')
        return line.decode(errors='replace')

    def complete(self, crown):
        """(outcome, sentence, s of processor time)"""
        if self.process is None:
            self.process = subprocess.Popen([self.program, SOURCE], stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
            self.read = b''
        self.process.stdin.write(crown.encode() + b'\n')
        ready = self.line(600)  # the making of the crown, which is the tests' own
        if ready != 'ready':
            return ('unmade', ready, 0)
        begun = self.seconds()
        outcome, _, sentence = self.line(MOST_SECONDS).partition('|')
        return outcome, sentence, self.seconds() - begun if self.process else MOST_SECONDS


def read_outcomes(path):
    rows = {}
    if path.exists():
        for line in path.read_text().splitlines():
            n, crown, outcome, seconds, sentence = line.split('\t')
            rows[int(n)] = (crown, outcome, float(seconds), sentence)
    return rows


def run(arguments, path, build):
    done, kinds = read_outcomes(path), kinds_of(build)
    left = iter([n for n in range(arguments.first, arguments.count) if n not in done])
    until = time.monotonic() + 60 * arguments.minutes if arguments.minutes else None
    lock = threading.Lock()

    def work():
        worker = Worker(build / 'tests/pipeline/complete_hostile_crowns')
        while until is None or time.monotonic() < until:
            with lock:
                n = next(left, None)
            if n is None:
                break
            crown = crown_number(n, kinds)
            outcome, sentence, seconds = worker.complete(crown)
            sentence = re.sub(r'\s+', ' ', sentence)
            with lock, path.open('a') as file:
                file.write(f'{n}\t{crown}\t{outcome}\t{seconds:.2f}\t{sentence}\n')
        if worker.process:
            worker.process.stdin.close()
            worker.process.wait()

    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for future in [pool.submit(work) for _ in range(arguments.jobs)]:
            future.result()


def reason_of(sentence):
    """A sentence without what differs from crown to crown."""
    words = re.sub(r'-?\d[\d,]*(\.\d+)?(e[-+]?\d+)?', 'N', sentence)
    words = re.sub(r'\((?:N(?:, |-| and )?)+(?:, \.\.\.)?\)', '', words)
    return words.split('. ')[0].split(': ')[0].strip().rstrip('.')


def tables(rows):
    by_kind = collections.defaultdict(collections.Counter)
    sizes, slowest, reasons = collections.Counter(), collections.Counter(), collections.Counter()
    for crown, outcome, seconds, sentence in rows.values():
        _, kind, _, vertices, _, _ = crown.split('|')
        by_kind[kind][outcome] += 1
        slowest[kind] = max(slowest[kind], seconds)
        sizes[next(most for most in (500, 1_500, 10_000, 60_000, 500_000) if int(vertices) <= most)] += 1
        if outcome in ('unusable', 'no_result'):
            reasons[(3 if outcome == 'unusable' else 4, reason_of(sentence))] += 1
    columns = ['made', 'warned', 'unusable', 'no_result', *FAULTS]
    print('| defect | crowns | made | made, with a warning | refused (3) | no result (4) | broken promises | other exceptions | crashes '
          '| over 60 s | longest, s |\n|---|' + '---|' * (len(columns) + 2))
    total = collections.Counter()
    for kind in sorted(by_kind):
        counts = by_kind[kind]
        total.update(counts)
        number = sum(counts[c] for c in columns)
        print(f'| {kind} | {number} | ' + ' | '.join(str(counts[c]) for c in columns) + f' | {slowest[kind]:.1f} |')
    print(f'| all | {sum(total[c] for c in columns)} | ' + ' | '.join(str(total[c]) for c in columns) +
          f' | {max(slowest.values(), default=0):.1f} |')
    print('\nSizes: ' + ', '.join(f'{count} to {most:,} vertices' for most, count in sorted(sizes.items())) + '.\n')
    print('| exit | reason | crowns |\n|---|---|---|')
    for (code, reason), count in sorted(reasons.items(), key=lambda item: (item[0][0], -item[1])):
        print(f'| {code} | {reason} | {count} |')
    for n, (crown, outcome, _, sentence) in sorted(rows.items()):
        if outcome in FAULTS or outcome == 'unmade':
            print(f'\n- crown {n} ({crown}): {outcome} {sentence}')
    return sum(total[c] for c in FAULTS)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('count', nargs='?', type=int, default=10_000)
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--out', type=pathlib.Path, default=SOURCE / 'results/hostile')
    parser.add_argument('--build', type=pathlib.Path, default=SOURCE / 'build')
    parser.add_argument('--minutes', type=float)
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--table', action='store_true')
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    path = arguments.out / 'outcomes.tsv'
    if not arguments.table:
        run(arguments, path, arguments.build)
    return 1 if tables(read_outcomes(path)) else 0


if __name__ == '__main__':
    sys.exit(main())
