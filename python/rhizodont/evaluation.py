# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far predicted roots are from true ones."""

from __future__ import annotations

import json
import os
from typing import Any, Callable, Optional

from . import _core
from .mesh import PathLike, mesh_of
from .teeth import Models, tooth_options

EvaluationProgress = Callable[[int, int, int, str], None]
"""Called before each tooth: its number, its place from 0, how many there are, and by what it is made."""


def evaluate(
    cases: PathLike,
    models: Models,
    *,
    templates: Optional[PathLike] = None,
    progress: Optional[EvaluationProgress] = None,
    **options: Any,
) -> dict[str, Any]:
    """Completes the crowns of a folder whose whole teeth are known (crown_FDI and tooth_FDI, mm) and measures how far the
    roots are off, in the words of `rhizodont evaluate --json`. templates: a folder with tooth_FDI.ply: the template fit's
    figures stand beside; options: of every tooth (`tooth_options`), without fdi. Raises InputError, UsageError; what goes
    wrong with one tooth stands in its figures."""
    text = _core.evaluate(
        os.fspath(cases),
        models._completion,
        tooth_options(**options),
        os.fspath(templates) if templates is not None else "",
        progress,
    )
    return dict(json.loads(text))


def root_figures(crown: Any, truth: Any, predicted: Any) -> dict[str, Any]:
    """How far one tooth's root is from the true one's: figures of the same names. All three are meshes in mm that stand in one
    place, the crown open at its base. Raises InputError, NoResultError."""
    a, b, c = mesh_of(crown), mesh_of(truth), mesh_of(predicted)
    text = _core.root_figures(a.vertices, a.triangles, b.vertices, b.triangles, c.vertices, c.triangles)
    return dict(json.loads(text))
