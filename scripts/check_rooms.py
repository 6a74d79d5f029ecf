#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Proves the order of the rooms: check_rooms.py [--self-test]. Every include between rooms of src/ is in the room's USES
and goes to a room that stands before it in src/CMakeLists.txt; the table of rooms in docs/architecture.md says the same as
USES; the programs include no room of geometry; no type is defined twice at namespace scope, which the linker would not
notice. Types in anonymous namespaces and inside of others do not count. Ends with 1 where that does not hold. --self-test
plants each of these faults in a copy and ends with 1 if one is not found."""

import collections
import pathlib
import re
import shutil
import sys
import tempfile

from check_lengths import OPAQUE, blank, closing

DIRECTIVE = re.compile(r'^[ \t]*#[^\n]*(\\\n[^\n]*)*', re.M)
# What the programs leave to the rooms above these.
GEOMETRY = {'mesh', 'operators', 'completion', 'skirt', 'segment', 'intake', 'poisson', 'isosurface', 'guiding', 'voronoi',
            'fusion'}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"([^"]+)"', re.M)
NAMESPACE = re.compile(r'^(?:inline\s+)?namespace\b\s*([\w:\s]*)$')
TYPE = re.compile(r'^(?:template\s*<.*>\s*)?(?:struct|class|union|enum(?:\s+(?:class|struct))?)\b\s*'
                  r'(?:\[\[.*?\]\]\s*|alignas\s*\([^)]*\)\s*|RHIZODONT_EXPORT\b\s*)*([\w:]*(?:\s*<[^{]*>)?)\s*(?:final\s*)?(?::(?!:).*)?$', re.S)


def defined_types(text):
    """(qualified name, line) of each type that is defined at the scope of a namespace with a name."""
    text = DIRECTIVE.sub(blank, OPAQUE.sub(blank, text))
    scopes = []  # names of the namespaces around, '' for anonymous ones
    start = i = 0
    while i < len(text):
        if text[i] == '}' and scopes:
            scopes.pop()
        if text[i] in ';}':
            start = i + 1
        elif text[i] == '{':
            head = ' '.join(text[start:i].split())
            if match := NAMESPACE.match(head):
                scopes.append(match.group(1).strip())
            elif head == 'extern':
                scopes.append('extern')
            else:
                match = TYPE.match(head)
                if match and match.group(1) and '' not in scopes:
                    yield '::'.join([s for s in scopes if s != 'extern'] + [match.group(1)]), text.count('\n', 0, i) + 1
                i = closing(text, i)
            start = i + 1
        i += 1


def source_files(folder):
    return sorted(p for p in folder.rglob('*') if p.suffix in ('.cpp', '.hpp'))


def rooms_in_order(root):
    return re.search(r'foreach\(room ([^)]*)\)', (root / 'src/CMakeLists.txt').read_text()).group(1).split()


def used_rooms(root, room):
    text = re.sub(r'#[^\n]*', '', (root / 'src' / room / 'CMakeLists.txt').read_text())
    call = re.search(r'rhizodont_room\(([^)]*)\)', text).group(1)
    match = re.search(r'\bUSES\b(.*?)(?:\b(?:SOURCES|LINKS|PRIVATE_LINKS|APART)\b|$)', call, re.S)
    return match.group(1).split() if match else []


def table_of_rooms(root):
    """(room, those that it uses) for each row of the table."""
    section = (root / 'docs/architecture.md').read_text().split('\n## Rooms\n')[1].split('\n## ')[0]
    rows = re.findall(r'^\| `(\w+)` \|.*\| ([^|]*) \|$', section, re.M)
    return [(room, [] if uses == '-' else uses.split(', ')) for room, uses in rows]


def faults_of_rooms(root, rooms, uses):
    folders = sorted(p.name for p in (root / 'src').iterdir() if p.is_dir())
    if folders != sorted(rooms):
        yield f'src/CMakeLists.txt lists {sorted(rooms)}, the folders are {folders}'
    for room in rooms:
        for used in uses[room]:
            if used not in rooms[:rooms.index(room)]:
                yield f'src/{room}/CMakeLists.txt: {room} uses {used}, which does not stand before it'
    table = table_of_rooms(root)
    if [room for room, _ in table] != rooms:
        yield f'docs/architecture.md: the table has the rooms {[room for room, _ in table]}, src/CMakeLists.txt {rooms}'
    for room, said in table:
        if room in uses and sorted(said) != sorted(uses[room]):
            yield f'docs/architecture.md: {room} uses {said}, by its CMakeLists.txt {uses[room]}'


def faults_of_includes(root, rooms, uses):
    for file in source_files(root / 'src') + source_files(root / 'include'):
        name = file.relative_to(root)
        text = file.read_text(encoding='utf-8')
        for match in INCLUDE.finditer(text):
            other = match.group(1).split('/')[0]
            where = f'{name}:{text.count(chr(10), 0, match.start()) + 1}: includes {match.group(1)}'
            if other == 'rhizodont':
                continue
            if name.parts[0] == 'include':
                yield f'{where}, but public headers stand by themselves'
                continue
            room = name.parts[1]
            if other not in rooms:
                yield f'{where}, which lies in no room'
            elif rooms.index(other) > rooms.index(room):
                yield f'{where}, but {other} stands after {room}'
            elif other != room and other not in uses[room]:
                yield f'{where}, but {other} is not in the USES of {room}'


def faults_of_programs(root):
    for file in source_files(root / 'apps'):
        text = file.read_text(encoding='utf-8')
        for match in INCLUDE.finditer(text):
            if match.group(1).split('/')[0] in GEOMETRY:
                yield (f'{file.relative_to(root)}:{text.count(chr(10), 0, match.start()) + 1}: includes {match.group(1)}, '
                       'but programs do no geometry')


def faults_of_names(root):
    places = collections.defaultdict(list)
    for folder in ('include', 'src', 'apps'):
        for file in source_files(root / folder):
            for name, line in defined_types(file.read_text(encoding='utf-8')):
                places[name].append(f'{file.relative_to(root)}:{line}')
    for name, found in places.items():
        if len(found) > 1:
            yield f'{name} is defined {len(found)} times: {", ".join(found)}'
    if not places:
        yield 'no type was found at all'


def faults(root):
    rooms = rooms_in_order(root)
    uses = {room: used_rooms(root, room) for room in rooms}
    return [*faults_of_rooms(root, rooms, uses), *faults_of_includes(root, rooms, uses), *faults_of_programs(root),
            *faults_of_names(root)]


def planted_faults(root):
    """(what is planted, file, its new text, what must be said of it)."""
    def text(name):
        return (root / name).read_text(encoding='utf-8')

    closest = text('src/mesh/closest_point.hpp')
    join = text('src/fusion/join.hpp')
    yield ('an upward include', 'src/mesh/closest_point.hpp',
           closest.replace('#include "rhizodont/mesh.hpp"', '#include "rhizodont/mesh.hpp"\n#include "fusion/join.hpp"'),
           'fusion stands after mesh')
    yield ('an include of a room that is not used', 'src/fusion/join.hpp',
           join.replace('#pragma once', '#pragma once\n#include "io/stl.hpp"'), 'io is not in the USES of fusion')
    yield ('a private header in a public one', 'include/rhizodont/mesh.hpp',
           text('include/rhizodont/mesh.hpp').replace('#pragma once', '#pragma once\n#include "mesh/closest_point.hpp"'),
           'public headers stand by themselves')
    yield ('a type that another room has', 'src/skirt/planted.cpp',
           'namespace rhizodont {\nnamespace {\nstruct Joining {};\n}\nstruct Joining final : Base<int> { int b; };\n}\n',
           'rhizodont::Joining is defined 2 times')
    yield ('an enumeration that a public header has', 'src/skirt/planted.hpp',
           'namespace rhizodont {\nvoid f(struct Joining& j) { struct Point {}; }\nenum class CapHandling { drop };\n}\n',
           'rhizodont::CapHandling is defined 2 times')
    yield ('geometry in a program', 'apps/rhizodont/planted.cpp', '#include "mesh/geometry.hpp"\n',
           'programs do no geometry')
    yield ('a use that goes upward', 'src/mesh/CMakeLists.txt',
           text('src/mesh/CMakeLists.txt').replace('USES base', 'USES base fusion', 1),
           'mesh uses fusion')
    yield ('a table that is not true', 'docs/architecture.md',
           re.sub(r'^(\| `fusion` \|.*\|) .* \|$', r'\1 mesh |', text('docs/architecture.md'), flags=re.M),
           "fusion uses ['mesh']")


def self_test(root):
    missed = 0
    for what, name, planted, said in planted_faults(root):
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder)
            for part in ('src', 'include', 'apps', 'docs'):
                shutil.copytree(root / part, copy / part)
            (copy / name).write_text(planted, encoding='utf-8')
            found = [fault for fault in faults(copy) if said in fault]
        print(f'planted {what}: {found[0] if found else "NOT FOUND"}')
        missed += not found
    return missed


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    if sys.argv[1:] == ['--self-test']:
        return 1 if self_test(root) else 0
    found = faults(root)
    for fault in found:
        print(fault)
    print(f'{len(rooms_in_order(root))} rooms, {len(found)} faults')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main())
