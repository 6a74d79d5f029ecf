#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Breaks each promise in small ways (scripts/mutants.toml), builds and runs the tests named for each fault, and tells
whether they found it. In a copy of the committed sources in build-mutants, so that nothing else is touched.

usage: mutants.py [--document docs/mutants.md] [--only WORD] [--here] [--list]
--only: the mutants whose name or file has the word. --here: no copy, but these sources, which must be as committed in
src/, and the folder build; for a checkout that is nobody's workplace. --list: only whether each fault still applies and
names tests that there are; nothing is built.
Ends with 1 where a fault is not found, does not compile or no longer applies. JOBS limits what is compiled at once."""

import argparse
import fnmatch
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib

SOURCE = pathlib.Path(__file__).resolve().parent.parent
PROMISES = ["crown", "solid", "triangles", "honest", "repeatable", "errors and files"]
LONGEST = 300  # s that the tests of one fault may take: one that makes them hang is found


def read_mutants():
    with open(SOURCE / "scripts/mutants.toml", "rb") as file:
        return tomllib.load(file)["mutant"]


def test_programs():
    """Name of each test program -> names of its tests as they stand in the sources."""
    programs = {}
    for listing in (SOURCE / "tests").glob("*/CMakeLists.txt"):
        for name, sources in re.findall(r"rhizodont_test\((\w+)\s+SOURCES\s+([^)]*?)(?:USES|LINKS|\))", listing.read_text()):
            text = "".join((listing.parent / s).read_text() for s in sources.split() if (listing.parent / s).exists())
            programs[name] = [f"{suite}.{test}" for suite, test in
                              re.findall(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)", text, re.MULTILINE)]
    return programs


def what_is_wrong(mutants):
    """A sentence for each mutant that cannot be applied or tested as it stands."""
    wrong = []
    programs = test_programs()
    for mutant in mutants:
        file = SOURCE / mutant["file"]
        count = file.read_text().count(mutant["search"]) if file.exists() else 0
        if count != 1:
            wrong.append(f"{mutant['name']}: its text stands {count} times in {mutant['file']}")
        if mutant["promise"] not in PROMISES:
            wrong.append(f"{mutant['name']}: no such promise: {mutant['promise']}")
        if not mutant["tests"]:
            wrong.append(f"{mutant['name']}: names no tests")
        for test in mutant["tests"]:
            program, _, filters = test.partition(":")
            if program not in programs:
                wrong.append(f"{mutant['name']}: there is no test_{program}")
                continue
            for pattern in filters.split(":") if filters else []:
                # Of tests with parameters the sources have the inner part of the name.
                if not any(fnmatch.fnmatch(name, pattern.rstrip("*") + "*") for name in programs[program]):
                    wrong.append(f"{mutant['name']}: no test of {program} is {pattern}")
    names = [mutant["name"] for mutant in mutants]
    wrong += [f"{name}: stands twice" for name in sorted({n for n in names if names.count(n) > 1})]
    wrong += [f"no fault breaks the promise {p}" for p in PROMISES if p not in {m["promise"] for m in mutants}]
    return wrong


def prepare_copy():
    """Committed sources in build-mutants/source, files that did not change untouched, and a configured build beside."""
    copy = SOURCE / "build-mutants/source"
    archive = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z"], capture_output=True, check=True).stdout
    for name in archive.decode().split("\0"):
        if not name:
            continue
        text = subprocess.run(["git", "-C", SOURCE, "show", f"HEAD:{name}"], capture_output=True).stdout
        place = copy / name
        if place.exists() and place.read_bytes() == text:
            continue
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(text)
        shutil.copymode(SOURCE / name, place)
    build = SOURCE / "build-mutants/build"
    command = ["cmake", "-S", copy, "-B", build, "-G", "Ninja", "-DRHIZODONT_BENCH=OFF", "-DRHIZODONT_WEB=OFF"]
    if shutil.which("ccache"):
        command.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
    return copy, build


def build_tests(build, programs):
    jobs = ["-j", os.environ["JOBS"]] if "JOBS" in os.environ else []
    done = subprocess.run(["ninja", "-C", build, *jobs, *(f"test_{p}" for p in programs)], capture_output=True, text=True)
    if done.returncode:
        sys.stderr.write(done.stdout[-3000:])
    return done.returncode == 0


def failing_test(build, tests):
    """The first test that fails, or how the program ended; nothing where all pass."""
    for test in tests:
        program, _, filters = test.partition(":")
        path = next((build / "tests").glob(f"*/test_{program}"))
        command = [path] + ([f"--gtest_filter={filters}"] if filters else [])
        try:
            done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=LONGEST)
        except subprocess.TimeoutExpired:
            return f"{program}: not ended after {LONGEST} s"
        if "[==========] Running 0 tests" in done.stdout:
            sys.exit(f"mutants.py: {test} runs no test")
        if done.returncode:
            failed = re.search(r"^\[  FAILED  \] (\S+?),? ", done.stdout, re.MULTILINE)
            return failed.group(1) if failed else f"{program} ended with {done.returncode}"
    return None


def try_mutant(copy, build, mutant):
    """(what became of it, by which test)"""
    file = copy / mutant["file"]
    original = file.read_text()
    file.write_text(original.replace(mutant["search"], mutant["replace"]))
    try:
        if not build_tests(build, [t.partition(":")[0] for t in mutant["tests"]]):
            return "does not compile", ""
        found_by = failing_test(build, mutant["tests"])
        return ("caught", found_by) if found_by else ("NOT caught", "")
    finally:
        file.write_text(original)


def document(mutants, results):
    commit = subprocess.run(["git", "-C", SOURCE, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    caught = sum(results[m["name"]][0] == "caught" for m in mutants)
    lines = ["<!--", "SPDX-FileCopyrightText: Rhizodont contributors", "SPDX-License-Identifier: GPL-3.0-or-later", "-->",
             "# Promises broken on purpose", "",
             "`scripts/mutants.py` makes each of these small faults (`scripts/mutants.toml`) in a copy of the sources, builds the "
             "tests named for it and runs them.", "A fault that no test finds is a test that is missing: the script ends with 1.", "",
             f"Commit {commit}, {time.strftime('%Y-%m-%d')}: {caught} of {len(mutants)} faults are caught.", "",
             "| promise | fault | file | outcome | by the test |", "|---|---|---|---|---|"]
    for mutant in sorted(mutants, key=lambda m: PROMISES.index(m["promise"])):
        outcome, test = results[mutant["name"]]
        lines.append(f"| {mutant['promise']} | {mutant['name']} | {mutant['file']} | {outcome} | {test} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--document", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--here", action="store_true")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    # A shell in the background hands on ignored signals, which tests send.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGQUIT, signal.SIG_DFL)
    mutants = read_mutants()
    wrong = what_is_wrong(mutants)
    for sentence in wrong:
        print(sentence)
    if options.list or wrong:
        print(f"{len(mutants)} faults, {len(wrong)} findings")
        return 1 if wrong else 0
    mutants = [m for m in mutants if options.only in m["name"] or options.only in m["file"]]
    if options.here:
        if subprocess.run(["git", "-C", SOURCE, "status", "--porcelain", "--", "src"], capture_output=True).stdout:
            sys.exit("mutants.py: src/ is not as committed")
        copy, build = SOURCE, SOURCE / "build"
    else:
        copy, build = prepare_copy()
    programs = sorted({t.partition(":")[0] for m in mutants for t in m["tests"]})
    if not build_tests(build, programs):
        sys.exit("mutants.py: the tests do not compile as they are")
    unfit = failing_test(build, sorted({t for m in mutants for t in m["tests"]}))
    if unfit:
        sys.exit(f"mutants.py: without any fault {unfit} fails")
    results = {}
    for mutant in mutants:
        started = time.monotonic()
        results[mutant["name"]] = try_mutant(copy, build, mutant)
        print(f"{mutant['name']}: {', '.join(filter(None, results[mutant['name']]))} ({time.monotonic() - started:.0f} s)", flush=True)
    caught = sum(outcome == "caught" for outcome, _ in results.values())
    print(f"{caught} of {len(mutants)} faults caught")
    if options.document and not options.only:
        options.document.write_text(document(mutants, results))
    return 0 if caught == len(mutants) else 1


if __name__ == "__main__":
    sys.exit(main())
