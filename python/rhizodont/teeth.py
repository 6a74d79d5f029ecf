# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Single crowns to whole teeth."""

from __future__ import annotations

import json
import os
from functools import cached_property
from typing import Any, Callable, Iterable, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core
from .mesh import Floats, Ints, Mesh, PathLike, mesh_of
from .notebooks import in_frame

Progress = Callable[[str], None]

SCAN, TRANSITION, PREDICTED = 0, 1, 2
"""Values of `Tooth.source`: given with the crown; new, between crown and root; predicted."""


class Models:
    """Weights and mean crowns, loaded once and used for many teeth, from several threads if wished."""

    def __init__(self, folder: Optional[PathLike] = None) -> None:
        """folder: None for the shipped models ($RHIZODONT_MODELS where it is set). Raises InputError."""
        self.folder = os.fspath(folder) if folder is not None else os.fspath(_core.default_models_folder())
        self._completion = _core.CompletionModels.load(self.folder)

    @cached_property
    def _segment(self) -> _core.SegmentModels:
        return _core.SegmentModels.load(self.folder)


class Tooth:
    """A whole tooth: the kept crown's vertices and triangles first, bit for bit. The arrays are read-only views."""

    def __init__(self, core: _core.CompletedTooth, crown: Mesh) -> None:
        self._core = core
        self.crown = crown
        """As it was given."""

    @cached_property
    def mesh(self) -> Mesh:
        return Mesh(
            self._core.vertices,
            self._core.triangles,
            {"source": self.source.astype(np.float64), "uncertainty": self.uncertainty},
        )

    @property
    def vertices(self) -> Floats:
        return self._core.vertices

    @property
    def triangles(self) -> Ints:
        return self._core.triangles

    @property
    def source(self) -> npt.NDArray[np.uint8]:
        """Per vertex SCAN, TRANSITION or PREDICTED."""
        return self._core.source

    @property
    def uncertainty(self) -> Floats:
        """mm, per vertex: expected distance from the true surface; 0 on the crown."""
        return self._core.uncertainty

    @property
    def kept_vertices(self) -> Ints:
        """Of the crown, ascending: vertex i of the tooth is vertex kept_vertices[i] of the crown."""
        return self._core.kept_vertices

    @property
    def fdi(self) -> int:
        return self._core.fdi

    @property
    def root_length(self) -> float:
        """mm, along the growth axis from the crown's lowest point to the apex."""
        return self._core.root_length

    @property
    def root_interval(self) -> Optional[tuple[float, float]]:
        """mm: holds the root's length with 80 % probability; None where the user steered the root."""
        return self._core.root_interval

    @property
    def warnings(self) -> list[str]:
        return self._core.warnings

    @cached_property
    def report(self) -> dict[str, Any]:
        """As `rhizodont complete --report` writes it (docs/report.schema.json), without a file's hash."""
        return dict(json.loads(self._core.report()))

    @property
    def options(self) -> dict[str, Any]:
        return dict(json.loads(self._core.options))

    def check(self, crown: Any) -> dict[str, Any]:
        """Proves the promises against the crown, in the words of `rhizodont check --json`."""
        of = mesh_of(crown)
        return dict(json.loads(_core.check_tooth(of.vertices, of.triangles, self._core)))

    def save(self, path: PathLike) -> None:
        """Writes .ply (with source and uncertainty), .stl, .obj or .glb. Raises OutputError, UsageError."""
        self._core.save(os.fspath(path))

    def page(self) -> str:
        """The report to look at, with tooth and crown in three dimensions: HTML in one file. Raises UsageError where the
        library was built without its pages."""
        return _core.tooth_page(self._core, self.crown.vertices, self.crown.triangles)

    def _repr_html_(self) -> Optional[str]:
        return in_frame(self.page()) if _core.has_report_pages() else None

    def __repr__(self) -> str:
        return f"<Tooth {self.fdi}: root {self.root_length:.1f} mm, {len(self.vertices)} vertices>"


class PreparedTooth:
    """A crown with all that does not depend on what is wished of the root; `finish` makes a tooth of it in half the
    time of `complete`."""

    def __init__(self, core: _core.PreparedTooth, crown: Mesh) -> None:
        self._core = core
        self._crown = crown

    @property
    def fdi(self) -> int:
        return self._core.fdi

    def finish(
        self,
        *,
        root_length: Optional[float] = None,
        tip: Optional[float] = None,
        torque: Optional[float] = None,
        bend: Optional[float] = None,
        transition: Optional[float] = None,
        progress: Optional[Progress] = None,
    ) -> Tooth:
        """root_length, transition: mm; tip, torque, bend: degrees, as in `complete`."""
        options = {"steering": _steering(root_length, tip, torque, bend), "transition_mm": transition}
        return Tooth(_core.finish(self._core, _json(options), progress), self._crown)


def _json(options: dict[str, Any]) -> str:
    def plain(value: Any) -> Any:
        if isinstance(value, (np.generic, np.ndarray)):
            return value.tolist()
        raise TypeError(f"A {type(value).__name__} is no value of an option.")

    try:
        return json.dumps(options, default=plain, allow_nan=False)
    except ValueError:
        raise _core.UsageError("An option of the tooth is not a finite number.") from None


def _steering(
    root_length: Optional[float], tip: Optional[float], torque: Optional[float], bend: Optional[float]
) -> dict[str, Any]:
    named = {"root_length_mm": root_length, "tip_degrees": tip, "torque_degrees": torque, "bend_degrees": bend}
    return {name: value for name, value in named.items() if value is not None}


def tooth_options(
    defaults: str = "{}",
    *,
    fdi: Optional[int] = None,
    e: Optional[float] = None,
    skirt: Union[str, float, None] = None,
    repair: Optional[bool] = None,
    cap: Optional[str] = None,
    millimetres_per_unit: Optional[float] = None,
    transition: Optional[float] = None,
    directions: Optional[dict[str, list[float]]] = None,
    root_length: Optional[float] = None,
    tip: Optional[float] = None,
    torque: Optional[float] = None,
    bend: Optional[float] = None,
    threads: Optional[int] = None,
) -> str:
    """The options of a tooth as the library's JSON; what is None stays as it is in `defaults`, else the library's own.

    fdi: number, unset to guess; e: mm, 0.2 to 2, side of the lattice, new edges are about half of it; skirt: "keep",
    "auto" or a confidence above 0 and below 1; cap: "drop" or "keep"; transition: mm, 0 to 5, width of the smoothed
    band; directions: {"occlusal": [x, y, z], "buccal": [x, y, z]}; root_length: mm, 3 to 30; tip, torque: degrees,
    -30 to 30; bend: degrees, -45 to 45; threads: 0 for all.
    """
    named = {
        "fdi": fdi,
        "e_mm": e,
        "skirt": skirt,
        "repair": repair,
        "cap": cap,
        "millimetres_per_unit": millimetres_per_unit,
        "transition_mm": transition,
        "directions": directions,
        "threads": threads,
        "steering": _steering(root_length, tip, torque, bend) or None,
    }
    given = {name: value for name, value in named.items() if value is not None}
    return _json({**json.loads(defaults), **given})


def complete(crown: Any, models: Models, *, progress: Optional[Progress] = None, **options: Any) -> Tooth:
    """A whole tooth of a crown; options: see `tooth_options`. progress is called with each stage's name; what it raises
    ends the work and comes through. Raises InputError, NoResultError, UsageError."""
    of = mesh_of(crown)
    core = _core.complete(of.vertices, of.triangles, models._completion, tooth_options(**options), progress)
    return Tooth(core, of)


def prepare(crown: Any, models: Models, *, progress: Optional[Progress] = None, **options: Any) -> PreparedTooth:
    """The first half of `complete`. What is wished of the root is `finish`'s to take: TypeError if it is given here."""
    late = {"root_length", "tip", "torque", "bend", "transition"} & options.keys()
    if late:
        raise TypeError(f"{', '.join(sorted(late))}: an option of finish, not of prepare")
    of = mesh_of(crown)
    core = _core.prepare(of.vertices, of.triangles, models._completion, tooth_options(**options), progress)
    return PreparedTooth(core, of)


def candidates(
    crown: Any, models: Models, count: int, *, progress: Optional[Progress] = None, **options: Any
) -> list[Tooth]:
    """The expected tooth and count - 1 others whose lengths spread over the 80 % interval; count: 1 to 9."""
    of = mesh_of(crown)
    cores = _core.candidates(of.vertices, of.triangles, models._completion, count, tooth_options(**options), progress)
    return [Tooth(core, of) for core in cores]


def check(crown: Any, tooth: Any, *, dropped_vertices: Optional[Iterable[int]] = None) -> dict[str, Any]:
    """Proves that a mesh is a solid that holds the crown bit for bit, however it was made; in the words of
    `rhizodont check --json`. dropped_vertices: of the crown, that are not the tooth's."""
    if isinstance(tooth, Tooth) and dropped_vertices is None:
        return tooth.check(crown)
    a, b = mesh_of(crown), mesh_of(tooth)
    dropped = [] if dropped_vertices is None else [int(v) for v in dropped_vertices]
    text = _core.check(a.vertices, a.triangles, b.vertices, b.triangles, dropped)
    return dict(json.loads(text))
