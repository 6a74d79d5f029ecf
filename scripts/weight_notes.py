#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints what a safetensors file says of itself: weight_notes.py FILE [NAME ...]. With names, their values on one line;
else all names and values. Ends with 1 where a name is missing."""

import json
import struct
import sys


def main():
    with open(sys.argv[1], 'rb') as file:
        size, = struct.unpack('<Q', file.read(8))
        notes = json.loads(file.read(size)).get('__metadata__', {})
    names = sys.argv[2:]
    missing = [name for name in names if name not in notes]
    if missing:
        print(f'{sys.argv[1]} does not say {", ".join(missing)}', file=sys.stderr)
        return 1
    print(' '.join(notes[name] for name in names) if names else '\n'.join(f'{k} {v}' for k, v in sorted(notes.items())))
    return 0


if __name__ == '__main__':
    sys.exit(main())
