#!/usr/bin/python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a call from Python costs beside the stages of the work: PYTHONPATH=build/python bench/python/call_cost.py CROWN [TIMES=7]."""

import statistics
import sys
import time

import rhizodont

models = rhizodont.Models()
crown = rhizodont.load(sys.argv[1])
shares = []
for _ in range(int(sys.argv[2]) if len(sys.argv) > 2 else 7):
    begin = time.perf_counter()
    tooth = rhizodont.complete(crown, models)
    seconds = time.perf_counter() - begin
    shares.append(100 * (seconds / sum(stage["seconds"] for stage in tooth.report["stages"]) - 1))
print(f"{len(crown.triangles)} triangles: {statistics.median(shares):.2f} % beside the stages, {seconds:.2f} s the last")
