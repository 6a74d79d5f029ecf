#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/messages.md against the sources and against what the program says: messages.py PROGRAM SOURCE. Each call below must end
with its code and say one line that stands in the table under that code."""

import pathlib
import re
import subprocess
import sys
import tempfile

PROGRAM, SOURCE = (pathlib.Path(word).resolve() for word in sys.argv[1:])
FLAT = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'

CALLS = [
    (2, 'complet crown_34.ply -o tooth.ply'),
    (2, 'crown_34.ply'),
    (2, 'complete crown_34.ply -o tooth.ply --fdl 34'),
    (2, 'complete crown_34.ply -o tooth.ply --fdi x'),
    (2, 'complete crown_34.ply'),
    (2, 'complete crown_34.ply -o tooth.doc'),
    (2, 'complete crown_34.ply -o crown_34.ply'),
    (2, 'complete crown_34.ply -o tooth.ply --e 9'),
    (2, 'complete crown_34.ply -o tooth.ply --fdi 39'),
    (2, 'complete crown_34.ply -o tooth.ply --root-length 99'),
    (2, 'complete crown_34.ply -o tooth.ply --unit parsec'),
    (2, 'complete crown_34.ply -o tooth.ply --skirt much'),
    (2, 'complete crown_34.ply -o tooth.ply --candidates 10'),
    (2, 'complete crown_34.ply crown_34.ply -o folder/'),
    (2, 'complete - - -o folder/'),
    (2, 'complete crown_34.ply -o - --json'),
    (2, 'arch crown_34.ply -o out --root-length 36:14'),
    (2, 'arch crown_34.ply -o out --report arch.json'),
    (2, 'batch'),
    (2, 'batch cases.csv -o out --shard 5/4'),
    (2, 'render crown_34.ply -o a.jpg'),
    (2, 'render crown_34.ply -o a.png --color-by luck'),
    (2, 'manual nothing'),
    (3, 'measure none.ply'),
    (3, 'measure empty.stl'),
    (3, 'measure text.ply'),
    (3, 'measure nan.obj'),
    (3, 'complete flat.obj --fdi 11 -o tooth.ply'),
    (3, 'complete crown_34.ply -o tooth.ply --unit m'),
    (3, 'complete crown_34.ply -o tooth.ply --models .'),
    (3, 'arch crown_34.ply -o out'),
    (3, 'segment crown_34.ply -o labels.json'),
    (3, 'evaluate .'),
    (3, 'batch wrong.csv -o out'),
    (3, 'check crown_34.ply crown_34.ply --report text.ply'),
    (7, 'complete crown_34.ply -o crown_34.ply/tooth.ply'),
    (7, 'measure crown_34.ply --json /proc/none/figures.json'),
    (7, 'complete crown_34.ply --e 2 -o tooth.ply --report /dev/full'),
    (7, 'measure crown_34.ply > /dev/full'),
]


def table():
    """{code: [(sentence, expression)]} of the document."""
    found, code = {}, None
    for line in (SOURCE / 'docs/messages.md').read_text(encoding='utf-8').splitlines():
        if match := re.fullmatch(r'## .* \((\d)\)', line):
            code = int(match.group(1))
        elif code and (match := re.fullmatch(r'\| (.*) \| [\w -]+ \|', line)) and match.group(1) not in ('sentence', '---'):
            sentence = match.group(1).replace('\\|', '|')
            found.setdefault(code, []).append((sentence, re.compile('.*'.join(re.escape(part) for part in sentence.split('…')), re.S)))
    return found


def main():
    subprocess.run([sys.executable, SOURCE / 'scripts/message_table.py', '--check'], check=True)
    rows = table()
    assert all(len(rows[code]) > 5 for code in (2, 3, 4)) and 5 in rows and 7 in rows, rows.keys()
    faults, said = [], set()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / 'crown_34.ply').write_bytes((SOURCE / 'samples/crown_34.ply').read_bytes())
        for file, text in [('flat.obj', FLAT), ('nan.obj', FLAT.replace('1 0 0', '1 0 nan')), ('empty.stl', ''), ('text.ply', 'a letter'),
                           ('cases.csv', 'scan,fdi\ncrown_34.ply,34\n'), ('wrong.csv', 'name\nx\n')]:
            (folder / file).write_text(text)
        for code, call in CALLS:
            done = subprocess.run(f"'{PROGRAM}' {call}", shell=True, cwd=folder, capture_output=True, text=True, stdin=subprocess.DEVNULL)
            line = done.stderr.removesuffix('\n')
            if done.returncode != code or '\n' in line or not line.startswith('rhizodont: '):
                faults.append(f'{call}: ended with {done.returncode}, not {code}, and said {done.stderr!r}')
                continue
            sentence = re.sub(r' \[\d[^\]]*\]$', '', line.removeprefix('rhizodont: '))
            # a row of a few letters and gaps would hold anything
            forms = [sentence, sentence.partition(': ')[2]]  # without the name of the file
            fitting = [row for row, expression in rows[code]
                       if any(expression.fullmatch(form) for form in forms) and len(row.replace('…', '')) > 9]
            if not fitting:
                faults.append(f'{call}: {sentence!r} does not stand in the table under {code}')
            said.update((code, row) for row in fitting[:1])
    for fault in faults:
        print(fault)
    print(f'{len(CALLS)} calls, {len(said)} different rows of {sum(map(len, rows.values()))}')
    sys.exit(1 if faults else 0)


if __name__ == '__main__':
    main()
