#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a shared library shows: exports.py LIBRARY INCLUDE_FOLDER. Every function that the public headers mark with
RHIZODONT_EXPORT is there, and nothing but these, the members of classes so marked, and what templates and exceptions of
other libraries leave in any library. Functions that g++ builds for several processors are shown whatever is asked
(target_clones, GCC 12). Ends with 1 and a line for each symbol where that does not hold."""

import pathlib
import re
import subprocess
import sys


def promised(folder):
    """Names of functions and of classes that the headers export."""
    functions, classes = set(), set()
    for header in sorted(folder.glob('*.hpp')):
        text = re.sub(r'//[^\n]*', '', header.read_text(encoding='utf-8'))
        classes.update(re.findall(r'\bclass RHIZODONT_EXPORT (\w+)', text))
        functions.update(re.findall(r'^\s*RHIZODONT_EXPORT [^;{(]*?\b(\w+)\(', text, re.M))
    return functions, classes


def exported(library):
    lines = subprocess.run(['nm', '--dynamic', '--defined-only', '--demangle', '--format=posix', library],
                           check=True, capture_output=True, text=True).stdout.splitlines()
    # "name type [value [size]]": the name may hold blanks
    return [match.group(1) for line in lines if (match := re.match(r'(.*) [A-Za-z](?: [0-9a-f]+)*\s*$', line))]


def main():
    functions, classes = promised(pathlib.Path(sys.argv[2]))
    symbols = exported(sys.argv[1])
    about = re.compile(r'^(?:vtable for |typeinfo for |typeinfo name for )')
    standard = re.compile(r'^(?:decltype\(auto\) )?(?:[\w:<>*&, ]+ )?(?:std::|__gnu_cxx::)|^_init$|^_fini$')
    found, strange = set(), []
    several = {symbol.removesuffix(' [clone .resolver]') for symbol in symbols if symbol.endswith('[clone .resolver]')}
    for symbol in symbols:
        match = re.match(r'rhizodont::((?:\w+::)*(?:operator=|~?\w+))(?:\[abi:\w+\])?(?:\(|$)', about.sub('', symbol))
        parts = match.group(1).split('::') if match else []
        if parts and (parts[0] in classes or parts[-1] in functions):
            found.add(parts[-1])
        elif symbol.removesuffix(' [clone .resolver]') in several:
            continue
        elif about.match(symbol) and 'rhizodont::' not in symbol:
            continue
        elif not standard.match(symbol):
            strange.append(symbol)
    missing = sorted(functions - found)
    for symbol in strange:
        print(f'shown, but no header exports it: {symbol}')
    for name in missing:
        print(f'exported by a header, but not shown: {name}')
    print(f'{len(symbols)} symbols shown for {len(functions)} functions and {len(classes)} classes of the public headers, '
          f'{len(strange)} of no header, {len(missing)} missing')
    return 1 if strange or missing or not functions else 0


if __name__ == '__main__':
    sys.exit(main())
