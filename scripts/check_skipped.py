#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Names the tests that were skipped; fails where one of them was skipped for want of shared data that is there.

usage: check_skipped.py RESULTS [SHARED=../shared]
RESULTS: a folder of GoogleTest's XML results (GTEST_OUTPUT=xml:RESULTS/).
"""
import sys
import xml.etree.ElementTree as xml
from pathlib import Path


def skipped_tests(results):
    """(name, reason) of each skipped test in the folder's files."""
    for file in sorted(results.glob("*.xml")):
        for case in xml.parse(file).getroot().iter("testcase"):
            for skipped in case.iter("skipped"):
                reason = (skipped.get("message") or skipped.text or "").strip().splitlines()
                yield f"{case.get('classname')}.{case.get('name')}", reason[-1] if reason else "no reason given"


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    root = Path(__file__).resolve().parent.parent
    results = Path(sys.argv[1])
    shared = Path(sys.argv[2]) if len(sys.argv) > 2 else root.parent / "shared"
    if not any(results.glob("*.xml")):
        sys.exit(f"{results} has no results of tests.")
    wrong = 0
    for name, reason in skipped_tests(results):
        for_want_of_data = "shared/" in reason
        print(f"skipped: {name}: {reason}")
        wrong += for_want_of_data and shared.is_dir()
    if wrong:
        sys.exit(f"{wrong} tests were skipped for want of data although {shared} is there.")


if __name__ == "__main__":
    main()
