#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the program does when the machine fails it: faults.py [--program PROGRAM] [--short] [--only WORD]

Disks that are full or can only be read, limits of file sizes, full devices, signals and SIGKILL all along a run, and memory that
ends at each stage (`ulimit -v`, from the smallest in which --help runs to the smallest in which the command succeeds). After each
run every result is the older one, whole, or the new one, whole, and nothing else is left in its folder; an error is said in one
line; the exit code is the documented one (docs/reference/exit_codes.md). Prints a table; ends with 1 if any of it does not hold.
--short is what the tests run: fewer steps. Disks in memory need the right to mount (root); without it these rows say so."""

import argparse
import collections
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
CROWN = SOURCE / 'samples/crown_23.ply'
SCAN = SOURCE / 'samples/scan_lower.ply'
OLDER = b'what stood here before\n'
MOST_SECONDS = 300


class Row:
    """A line of the table: how often which end was met, and what did not hold."""

    def __init__(self, fault, command):
        self.fault, self.command, self.ends, self.faults = fault, command, collections.Counter(), []

    def add(self, end, problem=None):
        self.ends[end] += 1
        if problem:
            self.faults.append(problem)

    def print(self):
        ends = ', '.join(f'{end}: {count}' for end, count in sorted(self.ends.items()))
        print(f'| {self.fault} | {self.command} | {sum(self.ends.values())} | {ends} | {len(self.faults)} |', flush=True)
        for fault in self.faults[:5]:
            print(f'FAULT {self.fault}, {self.command}: {fault}', file=sys.stderr, flush=True)


class Command:
    """A command of the program with its outputs, which are in one folder."""

    def __init__(self, program, name, words, outputs):
        self.program, self.name, self.words, self.outputs = program, name, words, outputs
        self.reference = {}
        with tempfile.TemporaryDirectory() as folder:
            begun = time.monotonic()
            ended = self.run(folder)
            self.seconds = time.monotonic() - begun
            assert ended.returncode == 0, (name, ended.stderr)
            self.reference = contents(folder)
        assert set(self.reference) == set(outputs), (name, list(self.reference))

    def line(self, folder):
        return [str(self.program), *(word.replace('@', str(folder)) for word in self.words)]

    def run(self, folder, **more):
        try:
            return subprocess.run(self.line(folder), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  text=True, errors='replace', timeout=MOST_SECONDS, **more)
        except subprocess.TimeoutExpired:
            return subprocess.CompletedProcess(self.words, 124, '', f'no end in {MOST_SECONDS} s')

    def limited(self, folder, kind, value):
        return self.run(folder, preexec_fn=lambda: resource.setrlimit(kind, (value, resource.getrlimit(kind)[1])))


def contents(folder):
    return {path.name: path.read_bytes() for path in pathlib.Path(folder).iterdir()}


def put_older(command, folder):
    for name in command.outputs:
        (pathlib.Path(folder) / name).write_bytes(OLDER)


def is_whole(command, name, data):
    """Whether this is the older file or the new one; times in reports differ from run to run."""
    if data in (OLDER, command.reference[name]):
        return True
    if name.endswith('.json'):
        try:
            return json.loads(data).keys() == json.loads(command.reference[name]).keys()
        except ValueError:
            return False
    if name.endswith('.html'):
        reference = command.reference[name]
        return data[:100] == reference[:100] and data[-20:] == reference[-20:] and abs(len(data) - len(reference)) < 1000
    return False


def problem_with_files(command, folder, killed=False, older=True):
    """What is wrong in the folder. Killed between two moves, an older file may be left under a hidden name."""
    now = contents(folder)
    for name in command.outputs:
        if name in now and not is_whole(command, name, now.pop(name)):
            return f'{name} is half a file'
        if older and name not in contents(folder):
            return f'{name} is gone'
    strange = [name for name in now if name not in command.outputs and not (killed and name.startswith('.rhizodont-'))]
    return f'left {strange}' if strange else None


def all_older(command, folder):
    return all(data == OLDER for data in contents(folder).values())


def problem_with_end(ended, codes):
    if ended.returncode not in codes:
        return f'ended with {ended.returncode}: {ended.stderr[-200:]!r}'
    lines = [line for line in ended.stderr.splitlines() if line.strip()]
    if ended.returncode > 0 and len(lines) != 1:
        return f'{len(lines)} lines in place of one: {ended.stderr[-200:]!r}'
    if ended.returncode > 0 and not lines[0].startswith('rhizodont: '):
        return f'does not say who speaks: {lines[0]!r}'
    return None


def check_failure(row, command, folder, ended, codes):
    """A run that could not write leaves everything as it was."""
    problem = problem_with_end(ended, codes) or problem_with_files(command, folder)
    if not problem and ended.returncode != 0 and not all_older(command, folder):
        problem = 'some results are new though the command failed'
    row.add(f'exit {ended.returncode}', problem)


def file_size_limits(command, steps):
    row = Row('limit of file sizes', command.name)
    largest = max(len(data) for data in command.reference.values())
    for step in range(steps):
        with tempfile.TemporaryDirectory() as folder:
            put_older(command, folder)
            check_failure(row, command, folder, command.limited(folder, resource.RLIMIT_FSIZE, largest * step // steps), [7])
    return row


def full_disks(command, steps):
    """Disks in memory with room for a part of the results."""
    row = Row('disk full', command.name)
    needed = sum(len(data) for data in command.reference.values())
    for step in range(steps):
        with tempfile.TemporaryDirectory() as folder:
            room = 4096 * len(command.outputs) + needed * step // steps
            result = on_disk(command, folder, f'size={room}', '')
            if result is None:
                row.add('no right to mount')
                break
            ended, problem = result
            row.add(f'exit {ended.returncode}', problem_with_end(ended, [7]) or problem)
    return row


def read_only_disk(command):
    row = Row('disk that can only be read', command.name)
    with tempfile.TemporaryDirectory() as folder:
        result = on_disk(command, folder, 'size=100m', 'mount -o remount,ro "$1" &&')
        if result is None:
            row.add('no right to mount')
        else:
            row.add(f'exit {result[0].returncode}', problem_with_end(result[0], [7]) or result[1])
    return row


def on_disk(command, folder, options, then):
    """(how the command ended, what is wrong with the files) on a disk of its own; None where none can be mounted. The disk is
    gone with the process, so a copy of the files is taken."""
    with tempfile.TemporaryDirectory() as older, tempfile.TemporaryDirectory() as copy:
        put_older(command, older)
        script = ('mount -t tmpfs -o "$2" tmpfs "$1" || exit 78; cp "$3"/* "$1" || exit 78; ' + then +
                  ' true || exit 78; copy=$4; folder=$1; shift 4; "$@"; code=$?; cp -a "$folder"/. "$copy"; exit $code')
        ended = subprocess.run(['unshare', '-m', 'bash', '-c', script, 'bash', folder, options, older, copy, *command.line(folder)],
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=MOST_SECONDS)
        if ended.returncode == 78 or 'unshare' in ended.stderr:
            return None
        problem = problem_with_files(command, copy)
        return ended, problem or (None if all_older(command, copy) else 'some results are new though the command failed')


def full_devices(program, words):
    row = Row('device full', 'complete -o -, --json')
    for line in (['-o', '-'], ['-o', '/dev/full'], ['-o', '/dev/null', '--json']):
        with open('/dev/full', 'wb') as full:
            ended = subprocess.run([program, *words, *line], stdin=subprocess.DEVNULL, stdout=full, stderr=subprocess.PIPE,
                                   text=True, timeout=MOST_SECONDS)
        row.add(f'exit {ended.returncode}', problem_with_end(ended, [7]))
    return row


def signals(command, which, steps):
    """A signal at many moments of the run, most of them near its end, where results are written."""
    row = Row(which.name, command.name)
    for step in range(steps):
        share = step / steps
        wait = command.seconds * (share if step % 2 == 0 else 0.85 + 0.2 * share)
        with tempfile.TemporaryDirectory() as folder:
            put_older(command, folder)
            process = subprocess.Popen(command.line(folder), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.PIPE, text=True)
            time.sleep(wait)
            process.send_signal(which)
            said = process.communicate(timeout=MOST_SECONDS)[1]
            code = process.returncode
            problem = problem_with_files(command, folder, which == signal.SIGKILL)
            if code not in (0, -which):
                problem = f'ended with {code}: {said[-200:]!r}'
            row.add('finished before' if code == 0 else 'ended by it' if code == -which else f'exit {code}', problem)
    return row


def smallest(works, low, high):
    while high - low > max(1, high // 100):
        middle = (low + high) // 2
        low, high = (low, middle) if works(middle) else (middle, high)
    return high


def memory_limits(command, steps):
    """How far the work came is what --verbose said last."""
    row = Row('memory ends', command.name)

    def runs_help(size):
        return subprocess.run([command.program, '--help'], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size))).returncode == 0

    def works(size):
        with tempfile.TemporaryDirectory() as folder:
            return command.limited(folder, resource.RLIMIT_AS, size).returncode == 0

    least = smallest(runs_help, 1 << 20, 1 << 30)
    most = smallest(works, least, 16 << 30)
    for step in range(steps):
        size = least + (most + (most - least) // 20 - least) * step // steps
        with tempfile.TemporaryDirectory() as folder:
            put_older(command, folder)
            ended = command.limited(folder, resource.RLIMIT_AS, size)
            check_failure(row, command, folder, ended, [0, 5])
            if ended.returncode == 5 and 'memory' not in ended.stderr:
                row.faults.append(f'does not speak of memory at {size >> 10} KB: {ended.stderr[-200:]!r}')
    row.fault += f' ({least >> 20} to {most >> 20} MB)'
    return row


def commands_of(program, short):
    complete = Command(program, 'complete', ['complete', str(CROWN), '--fdi', '23', '--e', '1', '-o', '@/tooth.ply', '--report',
                                             '@/report.json', '--quiet', '--threads', '2', '--overwrite'], ['tooth.ply', 'report.json'])
    if short:
        return [complete]
    with_page = Command(program, 'complete, GLB and page', ['complete', str(CROWN), '--fdi', '23', '--e', '1', '-o', '@/tooth.glb', '--report',
                        '@/report.html', '--quiet', '--threads', '2', '--as-float'], ['tooth.glb', 'report.html'])
    render = Command(program, 'render', ['render', str(CROWN), '-o', '@/crown.png', '--quiet'], ['crown.png'])
    segment = Command(program, 'segment', ['segment', str(SCAN), '-o', '@/labels.json', '--quiet', '--overwrite'], ['labels.json'])
    measure = Command(program, 'measure', ['measure', str(CROWN), '--json', '@/figures.json', '--quiet'], ['figures.json'])
    return [complete, with_page, render, segment, measure]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--program', default=str(SOURCE / 'build/apps/rhizodont/rhizodont'))
    parser.add_argument('--short', action='store_true')
    parser.add_argument('--only', default='', help='kinds of faults whose name has this word')
    arguments = parser.parse_args()
    commands = commands_of(arguments.program, arguments.short)
    steps = 4 if arguments.short else 20
    words = ['complete', str(CROWN), '--fdi', '23', '--e', '1', '--quiet']
    tasks = []
    for command in commands:
        tasks += [('file size', lambda c=command: file_size_limits(c, steps)), ('disk full', lambda c=command: full_disks(c, steps)),
                  ('read only', lambda c=command: read_only_disk(c))]
        tasks += [('signal', lambda c=command, s=which: signals(c, s, steps)) for which in
                  (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)]
        tasks += [('memory', lambda c=command: memory_limits(c, 6 if arguments.short else 60))]
    tasks.append(('device', lambda: full_devices(arguments.program, words)))
    print('| fault | command | runs | how they ended | what did not hold |\n|---|---|---|---|---|')
    faults = 0
    for name, task in tasks:
        if arguments.only in name:
            row = task()
            row.print()
            faults += len(row.faults)
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
