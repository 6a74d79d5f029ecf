#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/messages.md, the table of all sentences with which the programs give up, out of the sources themselves:
message_table.py [--check]. --check: writes nothing, ends with 1 where the document is not what it would write."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCUMENT = ROOT / 'docs/messages.md'
GAP = '…'
THROWN = re.compile(r'\b(Usage|Input|NoResult|Output)Error\(')
KINDS = {'Usage': 2, 'Input': 3, 'NoResult': 4, 'Output': 7}
LITERAL = re.compile(r'"((?:[^"\\]|\\.)*)"')

# What is not thrown as one of these, but said by the programs themselves.
FIXED = {
    2: [(f"there is no command '{GAP}': {GAP}", 'command line'),
        (f'there is no option {GAP}: did you mean {GAP}? (see {GAP} --help)', 'command line'),
        (f'{GAP} (see --help)', 'command line')],
    5: [(f'a fault of the program: {GAP}', 'command line'), ("the machine's memory is not enough for this", 'command line'),
        ("the machine's memory, or the number of threads that it allows, is not enough for this", 'command line')],
    7: [(f'standard output cannot be written: {GAP}', 'command line')],
}
TITLES = {2: 'Wrong usage', 3: 'Unusable input', 4: 'No result', 5: 'Faults of the program', 7: 'Results that cannot be written'}
HEAD = f'''<!--
SPDX-FileCopyrightText: Rhizodont contributors
SPDX-License-Identifier: GPL-3.0-or-later
-->
# Messages

A command that gives up says one line, `rhizodont: SENTENCE [ids]`, on standard error, and ends with the code of its kind.
`{GAP}` stands for a name, a number or a reason; before what is wrong
with a file its name stands. The room is where in `src/` the sentence is; of `apps/` it is `command line`.
Python raises the same sentences as `UsageError` (2), `InputError` (3), `NoResultError` (4) and `OutputError` (7).
What the codes mean: [exit codes](reference/exit_codes.md).
Written by `scripts/message_table.py` from the sources; a test compares both, another has the program say some of each kind.
'''


def argument_at(text, start):
    """The first argument of the call whose bracket opens before `start`."""
    depth, i = 0, start
    while i < len(text):
        c = text[i]
        if c == '"':
            i = LITERAL.match(text, i).end()
            continue
        if c == "'" and (match := re.compile(r"'(?:[^'\\]|\\.)'").match(text, i)):
            i = match.end()
            continue
        if c in '([{':
            depth += 1
        elif c in ')]}':
            if depth == 0:
                break
            depth -= 1
        elif c == ',' and depth == 0:
            break
        i += 1
    return text[start:i].strip()


def split_at(text, separators):
    """At those of the separators that stand in no bracket or literal."""
    parts, depth, begin, i = [], 0, 0, 0
    while i < len(text):
        if text[i] == '"':
            i = LITERAL.match(text, i).end()
            continue
        if text[i] in '([{':
            depth += 1
        elif text[i] in ')]}':
            depth -= 1
        elif depth == 0 and text[i] in separators and text[i - 1:i + 2].count(':') < 2:
            parts.append(text[begin:i])
            begin = i + 1
        i += 1
    return parts + [text[begin:]]


def letters(literals):
    joined = ''.join(match.group(1) for match in LITERAL.finditer(literals))
    return joined.replace('\\"', '"').replace("\\'", "'").replace('\\\\', '\\').replace('\\n', ' ')


def sentences(argument):
    """What the expression may say."""
    argument = argument.strip()
    choice = split_at(argument, '?:')
    if len(choice) == 3:
        return sentences(choice[1]) + sentences(choice[2])
    if match := re.fullmatch(r'(?:std::string|fmt::format)\((.*)\)', argument, re.S):
        inner = argument_at(argument, argument.index('(') + 1)
        if argument.startswith('std::string'):
            return sentences(inner)
        return [re.sub(r'\{[^{}]*\}', GAP, said) for said in sentences(inner)]
    parts = split_at(argument, '+')
    if len(parts) > 1:
        texts = ['']
        for part in parts:
            texts = [text + said for text in texts for said in sentences(part)]
        return texts
    if re.fullmatch(r'(?:\s*"(?:[^"\\]|\\.)*")+\s*', argument):
        return [letters(argument)]
    return [GAP]


def arguments_at(text, start):
    """All arguments of the call whose bracket opens before `start`."""
    while start < len(text):
        argument = argument_at(text, start)
        yield argument
        start = text.index(argument, start) + len(argument) if argument else start
        start = re.compile(r'\s*').match(text, start).end()
        if text[start:start + 1] != ',':
            return
        start += 1


def helped(text):
    """(code, sentence) of what is thrown by a function of the file that only does that, such as fail("why")."""
    helpers = {}
    for match in re.finditer(r'\[\[noreturn\]\][^;{(]*?\b(\w+)\([^;{]*\{', text):
        if thrown := THROWN.search(text, match.end(), text.find('\n}', match.end()) if text[match.start() - 1] == '\n' else match.end() + 400):
            helpers[match.group(1)] = (KINDS[thrown.group(1)], sentences(argument_at(text, thrown.end())))
    for name, (code, frames) in {'fail': (3, [GAP]), 'faults.add': (3, [f'Line {GAP}: {GAP}.']), **helpers}.items():
        for call in re.finditer(r'(?<![\w.:>])' + re.escape(name) + r'\(', text):
            for argument in arguments_at(text, call.end()):
                if '"' not in argument or argument.startswith('const '):
                    continue
                for said in sentences(argument):
                    for frame in frames:
                        head, gap, tail = frame.rpartition(GAP)
                        yield code, head + said + tail if gap else frame


def messages():
    """{code: {(sentence, room)}}"""
    found = {code: set(rows) for code, rows in FIXED.items()}

    def add(code, said, room):
        said = re.sub(f'{GAP}(?:{GAP})+', GAP, ' '.join(said.split()))
        if len(re.findall(r'[A-Za-z]', said)) >= 8:
            found.setdefault(code, set()).add((said, room))

    for folder in ('src', 'apps'):
        for file in sorted((ROOT / folder).rglob('*.[ch]pp')):
            text = re.sub(r'^\s*//[^\n]*', '', file.read_text(encoding='utf-8'), flags=re.M)
            room = file.relative_to(ROOT).parts[1] if folder == 'src' else 'command line'
            if file.parts[-2] == 'rhizodont-train' or room in ('learning', 'training'):
                room = 'rhizodont-train'
            for thrown in THROWN.finditer(text):
                code = KINDS[thrown.group(1)]
                for said in sentences(argument_at(text, thrown.end())):
                    add(code, said, room)
            for code, said in helped(text):
                add(code, said, room)
    return found


def document():
    text = HEAD
    for code, rows in sorted(messages().items()):
        text += f'\n## {TITLES[code]} ({code})\n\n| sentence | room |\n|---|---|\n'
        for said, room in sorted(rows, key=lambda row: (row[1] != 'command line', row[1], row[0])):
            text += f'| {said.replace("|", chr(92) + "|")} | {room} |\n'
    return text


def main():
    wanted = document()
    if sys.argv[1:] != ['--check']:
        DOCUMENT.write_text(wanted, encoding='utf-8')
        return 0
    there = DOCUMENT.read_text(encoding='utf-8') if DOCUMENT.exists() else ''
    if there == wanted:
        return 0
    for line in sorted(set(wanted.splitlines()) ^ set(there.splitlines()))[:20]:
        print(('missing: ' if line in wanted else 'no more: ') + line)
    print('docs/messages.md is not what the sources say: run scripts/message_table.py')
    return 1


if __name__ == '__main__':
    sys.exit(main())
