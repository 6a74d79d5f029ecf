# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures against true teeth: those of the program, and those that are known."""

import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

import rhizodont

SOURCE = pathlib.Path(os.environ["RHIZODONT_SOURCE"])
PROGRAM = os.environ["RHIZODONT_PROGRAM"]
CROWN = SOURCE / "samples" / "crown_34.ply"


@pytest.fixture(scope="module")
def truth(models):
    return rhizodont.complete(CROWN, models, fdi=34, e=1, root_length=15)


@pytest.fixture(scope="module")
def cases(truth, tmp_path_factory):
    folder = tmp_path_factory.mktemp("cases")
    (folder / "crown_34.ply").write_bytes(CROWN.read_bytes())
    truth.save(folder / "tooth_34.ply")
    return folder


def without_times(figures):
    if isinstance(figures, dict):
        return {name: without_times(value) for name, value in figures.items() if name != "seconds"}
    return [without_times(value) for value in figures] if isinstance(figures, list) else figures


def test_figures_are_those_of_the_program(cases, models):
    seen = []
    ours = rhizodont.evaluate(cases, models, e=2, templates=cases, progress=lambda *step: seen.append(step))
    printed = subprocess.run(
        [PROGRAM, "evaluate", cases, "--e", "2", "--templates", cases, "--json"], capture_output=True, text=True
    ).stdout
    assert without_times(ours) == without_times(json.loads(printed))
    assert seen == [(34, 0, 1, "rhizodont"), (34, 0, 1, "template")]


def test_errors_are_python_exceptions(cases, models, tmp_path):
    with pytest.raises(rhizodont.InputError):
        rhizodont.evaluate(tmp_path, models)
    with pytest.raises(rhizodont.UsageError):
        rhizodont.evaluate(cases, models, fdi=34)
    with pytest.raises(rhizodont.InputError, match="where the templates should be"):
        rhizodont.evaluate(cases, models, templates=tmp_path / "nowhere")

    def stop(*step):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        rhizodont.evaluate(cases, models, progress=stop)


def test_root_figures_of_roots_that_are_known(truth, models):
    same = rhizodont.root_figures(CROWN, truth, truth)
    assert same["root_length_error_mm"] == 0
    assert same["apex_distance_mm"] == 0
    shorter = rhizodont.complete(CROWN, models, fdi=34, e=1, root_length=12)
    figures = rhizodont.root_figures(CROWN, truth, shorter)
    assert figures["root_length_error_mm"] == pytest.approx(-3, abs=0.3)
    assert figures["apex_distance_mm"] > 2.5
    closed = rhizodont.Mesh(np.asarray(truth.vertices), np.asarray(truth.triangles))
    with pytest.raises(rhizodont.InputError):
        rhizodont.root_figures(closed, truth, shorter)
