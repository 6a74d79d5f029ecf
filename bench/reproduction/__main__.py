# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reproduces the paper's experiments; called by scripts/reproduce.sh, which says how."""
import argparse
import json
import os
import shlex
import shutil
import sys
import time
from pathlib import Path

sys.path.insert(0, os.path.dirname(__file__))
import page  # noqa: E402
import pictures  # noqa: E402
import runs  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(prog="reproduce.sh")
    parser.add_argument("data", nargs="?", help="folder with templates, crowns and validation teeth")
    parser.add_argument("--build", default="build")
    parser.add_argument("--out", default="docs", help="folder for reproduction.md and reproduction/")
    parser.add_argument("--repeats", type=int, default=3, help="runs of each time of table 4")
    parser.add_argument("--each", type=int, default=2, help="generated teeth of each of 16 types in table 2")
    parser.add_argument("--alone", default="", help="words put before each command whose time is taken")
    parser.add_argument("--page-only", action="store_true", help="writes the page from the last run's figures")
    return parser.parse_args()


def main():
    options = arguments()
    root = Path(__file__).resolve().parents[2]
    build = Path(options.build).resolve()
    scratch = build / "reproduction"
    figures = scratch / "figures.json"
    if not options.page_only:
        shutil.rmtree(scratch, ignore_errors=True)  # nothing of an earlier run is taken for this one's
        scratch.mkdir(parents=True)
        began = time.monotonic()

        def step(text):
            print(f"{time.monotonic() - began:6.0f} s  {text}", flush=True)

        bench = runs.Bench(root, build, Path(options.data).resolve() if options.data else None, scratch,
                           shlex.split(options.alone))
        result = {"stamp": page.stamp(root, build, bench.data)}
        step("crowns")
        sets = runs.crown_sets(bench)
        step("tables 1, 3, 4 and 5: completed at four sizes")
        result["completed"] = runs.complete_all(bench, sets, options.repeats)
        step("table 2: true teeth")
        result["evaluated"] = runs.evaluate(bench, options.each)
        step("peers")
        result["peers"] = runs.compare(bench, sets)
        step("pictures")
        result["pictures"] = pictures.draw_all(bench, Path(options.out) / "reproduction")
        result["stamp"]["minutes"] = (time.monotonic() - began) / 60
        figures.write_text(json.dumps(result))
    text = page.write(json.loads(figures.read_text()))
    target = Path(options.out) / "reproduction.md"
    target.write_text(text)
    print(target)


main()
