# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole teeth with roots from scanned crowns, the crown kept to the bit.

    import rhizodont
    models = rhizodont.Models()
    tooth = rhizodont.complete("crown_36.stl", models, fdi=36)
    tooth.save("tooth_36.ply")

A predicted root is not anatomy: it is typical for such a crown, not the patient's own.
"""

from . import _core
from ._core import Error, InputError, NoResultError, OutputError, UsageError
from .arches import Arch, Clearance, FoundTooth, SegmentedScan, ToothOfArch, complete_arch, segment
from .evaluation import evaluate, root_figures
from .mesh import Mesh, load, measure, mesh_of
from .teeth import (
    PREDICTED,
    SCAN,
    TRANSITION,
    Models,
    PreparedTooth,
    Tooth,
    candidates,
    check,
    complete,
    prepare,
    tooth_options,
)

__version__: str = _core.version

__all__ = [
    "Arch",
    "Clearance",
    "Error",
    "FoundTooth",
    "InputError",
    "Mesh",
    "Models",
    "NoResultError",
    "OutputError",
    "PREDICTED",
    "PreparedTooth",
    "SCAN",
    "SegmentedScan",
    "TRANSITION",
    "Tooth",
    "ToothOfArch",
    "UsageError",
    "candidates",
    "check",
    "complete",
    "complete_arch",
    "evaluate",
    "load",
    "measure",
    "mesh_of",
    "prepare",
    "root_figures",
    "segment",
    "tooth_options",
]
