#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists functions and files that are too long: check_lengths.py [FILE ...], by default all C++ files under version
control. Ends with 1 if there are any. A function counts from the line of its name to its closing brace."""

import re
import subprocess
import sys

LONGEST_FUNCTION = 80
LONGEST_FILE = 600

# Comments and literals: their braces mean nothing.
OPAQUE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'', re.S)
TRANSPARENT = re.compile(r'\b(namespace|class|struct|union|enum|extern)\b')


def blank(match):
    return re.sub(r'[^\n]', ' ', match.group())


def closing(text, start):
    depth = 0
    for i in range(start, len(text)):
        depth += {'{': 1, '}': -1}.get(text[i], 0)
        if depth == 0:
            return i
    return len(text) - 1


def functions(text):
    """(first line, last line, head) of each function, lambdas and local classes counting to what they stand in."""
    text = re.sub(r'^[ \t]*#[^\n]*(\\\n[^\n]*)*', blank, OPAQUE.sub(blank, text), flags=re.M)
    head_start = i = 0
    while i < len(text):
        if text[i] in ';}':
            head_start = i + 1
        elif text[i] == '{':
            head = text[head_start:i]
            if TRANSPARENT.search(head) and not re.search(r'\)\s*(const|noexcept|override|final|\s)*$', head):
                head_start = i + 1
            else:
                end = closing(text, i)
                # Braces in a list of members' initialisers belong to the head.
                if text[end + 1:].lstrip()[:1] in (',', '{') and '(' in head:
                    i = end + 1
                    continue
                if '(' in head:
                    lead = len(head) - len(head.lstrip())
                    first = text.count('\n', 0, head_start + lead) + 1
                    yield first, text.count('\n', 0, end) + 1, ' '.join(head.split())
                i = end
                head_start = end + 1
        i += 1


def main():
    files = sys.argv[1:] or subprocess.run(
        ['git', 'ls-files', '*.cpp', '*.hpp'], check=True, capture_output=True, text=True).stdout.split()
    bad = 0
    count = 0
    for name in files:
        with open(name, encoding='utf-8') as file:
            text = file.read()
        lines = text.count('\n')
        if lines > LONGEST_FILE:
            bad += 1
            print(f'{name}: {lines} lines')
        for first, last, head in functions(text):
            count += 1
            if last - first + 1 > LONGEST_FUNCTION:
                bad += 1
                print(f'{name}:{first}: {last - first + 1} lines: {head[:80]}')
    print(f'{len(files)} files with {count} functions, {bad} too long')
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
