# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole scans: teeth found, and every tooth with its root."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Callable, Mapping, Optional, Sequence

import numpy.typing as npt

from . import _core
from .mesh import Floats, Ints, Mesh, mesh_of, whole_numbers
from .notebooks import in_frame
from .teeth import Models, Tooth, tooth_options

ArchProgress = Callable[[int, int, int], None]
"""Called after each tooth: how many are done, of how many, and the last one's number."""


@dataclass
class FoundTooth:
    fdi: int
    confidence: float
    """0 to 1: that there is a tooth and this is its number."""
    second: Optional[int]
    """The number that is next likely; None: that it is no tooth."""
    second_confidence: float
    middle: tuple[float, float, float]
    vertices: int


@dataclass(eq=False)
class SegmentedScan:
    labels: Ints
    """Per vertex of the scan its FDI number, 0 for gum and everything else."""
    teeth: list[FoundTooth]
    jaw: str
    jaw_confidence: float
    jaw_reason: str
    notes: list[str]


@dataclass(eq=False)
class ToothOfArch:
    fdi: int
    crown: Mesh
    scan_vertices: Ints
    """Of the scan, for each vertex of the crown."""
    tooth: Optional[Tooth]
    clearance: Floats
    """mm, per vertex of the tooth: signed distance from the nearest other tooth, at most 3."""
    refusal: str
    """Why there is no tooth; empty if there is one."""


@dataclass
class Clearance:
    """mm between two teeth; negative where they run into each other; None beyond what was asked."""

    first: int
    second: int
    crown_crown: Optional[float]
    root_root: Optional[float]
    root_crown: Optional[float]
    crown_root: Optional[float]


@dataclass(eq=False)
class Arch:
    teeth: list[ToothOfArch]
    clearances: list[Clearance]
    gum: Mesh
    notes: list[str]
    _core: _core.CompletedArch = field(repr=False)

    def page(self) -> str:
        """All teeth to look at, in three dimensions: HTML in one file. Raises UsageError where the library was built without
        its pages."""
        return self._core.page()

    def _repr_html_(self) -> Optional[str]:
        return in_frame(self.page()) if _core.has_report_pages() else None

    def __getitem__(self, fdi: int) -> ToothOfArch:
        for tooth in self.teeth:
            if tooth.fdi == fdi:
                return tooth
        raise KeyError(fdi)


def segment(
    scan: Any,
    models: Models,
    *,
    jaw: Optional[str] = None,
    missing: Sequence[int] = (),
    teeth: Optional[Mapping[int, Sequence[float]]] = None,
    millimetres_per_unit: float = 1,
    threads: int = 0,
) -> SegmentedScan:
    """Finds and numbers the permanent teeth of one jaw. jaw: "upper", "lower" or None to find it; missing: numbers that
    are not there; teeth: numbers with a place on each. Raises InputError for what is no scan of an arch."""
    of = mesh_of(scan)
    places = {number: tuple(float(x) for x in place) for number, place in (teeth or {}).items()}
    found = _core.segment(
        of.vertices, of.triangles, models._segment, millimetres_per_unit, jaw, set(missing), places, threads
    )
    return SegmentedScan(
        found["labels"],
        [FoundTooth(**tooth) for tooth in found["teeth"]],
        found["jaw"],
        found["jaw_confidence"],
        found["jaw_reason"],
        found["notes"],
    )


def complete_arch(
    scan: Any,
    models: Models,
    labels: Optional[npt.ArrayLike] = None,
    *,
    root_lengths: Optional[Mapping[int, float]] = None,
    resolve_collisions: bool = False,
    clearance: float = 0.5,
    progress: Optional[ArchProgress] = None,
    **options: Any,
) -> Arch:
    """Every tooth of a scan with its root. labels: per vertex the FDI number, 0 for gum; None: teeth are found first.
    root_lengths: FDI number to mm, measured on X-rays; progress is called with how many teeth are done, of how many, and the
    last one's number; clearance: mm, for resolve_collisions; options: of every tooth
    (`tooth_options`), by default with the skirt dropped and defects mended. A tooth that is refused does not stop the
    others. Raises InputError, UsageError."""
    of = mesh_of(scan)
    numbers = segment(of, models).labels if labels is None else whole_numbers(labels, "Labels")
    tooth = tooth_options(_core.arch_tooth_options(), **options)
    done = _core.arch(
        of.vertices,
        of.triangles,
        numbers,
        models._completion,
        tooth,
        dict(root_lengths or {}),
        resolve_collisions,
        clearance,
        progress,
    )
    teeth = []
    for one in done.teeth:
        crown = Mesh(*one["crown"])
        tooth_of_crown = Tooth(one["tooth"], crown) if one["tooth"] is not None else None
        teeth.append(
            ToothOfArch(one["fdi"], crown, one["scan_vertices"], tooth_of_crown, one["clearance"], one["refusal"])
        )
    return Arch(teeth, [Clearance(**pair) for pair in done.clearances], Mesh(*done.gum), done.notes, done)
