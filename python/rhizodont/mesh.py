# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle meshes: the module's own, and those of other libraries."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from typing import Any, Mapping, Union

import numpy as np
import numpy.typing as npt

from . import _core

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
PathLike = Union[str, "os.PathLike[str]"]


@dataclass(eq=False)
class Mesh:
    """An indexed triangle mesh: vertices n x 3 (float64), triangles m x 3 (int32), counterclockwise from outside."""

    vertices: Floats
    triangles: Ints
    vertex_attributes: Mapping[str, Floats] = field(default_factory=dict)
    triangle_attributes: Mapping[str, Floats] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    """What reading the file found and mended, a sentence each."""

    def save(self, path: PathLike) -> None:
        """Writes .ply, .stl, .obj or .glb. Attributes of vertices go to .ply alone, as float32 (`source` as uint8);
        those of triangles are not written."""
        _core.save(os.fspath(path), self.vertices, self.triangles, dict(self.vertex_attributes))

    def measure(self) -> dict[str, Any]:
        """Quality, topology and sizes, in the words of `rhizodont measure --json`."""
        return measure(self)


def load(path: PathLike) -> Mesh:
    """Reads STL, PLY, OBJ, OFF, VTP or VTK, gzip around it too. Raises InputError."""
    return Mesh(*_core.load(os.fspath(path)))


def mesh_of(source: Any) -> Mesh:
    """A mesh of whatever has one: Mesh, Tooth, a file's name, (vertices, triangles), or a mesh of trimesh, Open3D,
    PyVista or VTK. Raises TypeError for anything else, and for cells that are no triangles."""
    if isinstance(source, Mesh):
        return source
    if isinstance(source, (str, os.PathLike)):
        return load(source)
    if hasattr(source, "to_legacy"):  # Open3D's mesh of tensors
        return mesh_of(source.to_legacy())
    if hasattr(source, "mesh") and isinstance(source.mesh, Mesh):
        return source.mesh
    if isinstance(source, (tuple, list)) and len(source) == 2:
        return _of_arrays(source[0], source[1])
    if hasattr(source, "vertices") and hasattr(source, "faces"):  # trimesh
        return _of_arrays(source.vertices, source.faces)
    if hasattr(source, "vertices") and hasattr(source, "triangles"):  # Open3D
        return _of_arrays(source.vertices, source.triangles)
    if hasattr(source, "GetPolys") and hasattr(source, "GetPoints"):  # VTK, and PyVista, which is VTK
        return _of_vtk(source)
    raise TypeError(f"A {type(source).__name__} is no mesh that is known here.")


def measure(mesh: Any) -> dict[str, Any]:
    """Figures of a mesh, in the words of `rhizodont measure --json`. Raises InputError for one that is damaged."""
    of = mesh_of(mesh)
    figures: dict[str, Any] = json.loads(_core.measure(of.vertices, of.triangles))
    return figures


def whole_numbers(values: Any, what: str) -> Ints:
    """As int32. Raises InputError where that would change a value."""
    given = np.asarray(values)
    with np.errstate(invalid="ignore"):
        numbers = np.ascontiguousarray(given, dtype=np.int32)
    if not np.array_equal(numbers, given):
        raise _core.InputError(f"{what} must be whole numbers below 2^31.")
    return numbers


def _of_arrays(vertices: Any, triangles: Any) -> Mesh:
    return Mesh(np.ascontiguousarray(vertices, dtype=np.float64), whole_numbers(triangles, "Vertices of triangles"))


def _of_vtk(data: Any) -> Mesh:
    from vtkmodules.util.numpy_support import vtk_to_numpy  # type: ignore[import]

    offsets = vtk_to_numpy(data.GetPolys().GetOffsetsArray())
    if np.any(np.diff(offsets) != 3):
        raise TypeError("The VTK data has polygons that are no triangles: triangulate it first.")
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    return _of_arrays(vtk_to_numpy(data.GetPoints().GetData()), corners.reshape(-1, 3))
