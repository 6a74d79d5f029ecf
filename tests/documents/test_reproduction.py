# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of the paper's experiments says where we are behind, what was not run and what failed."""

import copy
import os
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(os.environ["RHIZODONT_SOURCE"]) / "bench/reproduction"))

import page  # noqa: E402
import runs  # noqa: E402

GOOD = {"q_avg": 0.95, "q_min": 0.6, "theta_avg": 55, "theta_min": 30, "percent_below_30": 0}


def completed(e):
    return {"set": "samples", "fdi": "36", "e": e, "seconds": 1.0, "memory_mb": 100, "stages": {"joining": 0.5}, "guiding_mean": 0.001,
            "guiding_max": 0.01, "crown_vertices": 10, "crown_triangles": 12, "kept_triangles": 12, "bins": [10, 0, 0, 0], "solid": True,
            "new": dict(GOOD), "all": dict(GOOD)}


@pytest.fixture
def result():
    ours = {"method": "Rhizodont", "set": "samples", "fdi": "36", "failure": None, "solid": True, "kept_share": 1, "vertices": 10,
            "bins": [10, 0, 0, 0], "deviation_max": 0, "all": dict(GOOD), "new": dict(GOOD), "seconds": 1, "memory_mb": 100}
    return {"stamp": {"Commit": "abc", "data": False, "load": 0, "minutes": 1}, "completed": [completed(e) for e in runs.SIZES], "evaluated": {},
            "peers": [ours], "pictures": ["figure_7"]}


def test_even_or_better_is_not_behind(result):
    text = page.write(result)
    assert "in none of these" in text and "**behind**" not in text
    assert "| 36 | 10 | 10 | 0 | 0 | 0 | 100.0 % |" in text


def test_what_is_worse_is_said(result):
    worse = copy.deepcopy(result)
    for row in worse["completed"]:
        row["guiding_max"] = 1.0
        row["bins"] = [5, 0, 0, 5]
    text = page.write(worse)
    assert "Behind the paper's printed figures in: d_max at e = 0.5, mm (table 1); crown vertices within 1e-3 mm, % (table 3)." in text
    assert "5 of 10 within 1e-3 mm" in text


def test_what_was_not_run_or_failed_is_named(result):
    result["peers"] += [{"method": "A", "set": "samples", "fdi": "36", "missing": "A is not installed"},
                        {"method": "B", "set": "samples", "fdi": "36", "failure": "It cannot.", "seconds": 1, "memory_mb": 1}]
    text = page.write(result)
    assert "- A: not run, A is not installed." in text
    assert "- B, no result on 36: It cannot." in text


def test_a_command_is_measured_and_its_last_words_kept(tmp_path):
    bench = runs.Bench(tmp_path, tmp_path, None, tmp_path, [])
    fine = bench.run("sh", "-c", "echo 12; sleep 0.1")
    assert fine["failure"] is None and fine["output"] == "12\n" and fine["seconds"] >= 0.1 and fine["memory_mb"] > 0
    assert bench.run("sh", "-c", "echo first >&2; echo no crown >&2; exit 3")["failure"] == "no crown"
