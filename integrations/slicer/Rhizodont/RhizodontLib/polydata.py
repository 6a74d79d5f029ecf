# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces between Slicer and files. Nodes hold RAS, files are LPS: x and y change their signs, which changes no digit and, being half a
turn about z, no orientation of a triangle. PLY is read and written here since VTK's classes know neither doubles nor attributes."""

import pathlib

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4", "float": "<f4", "double": "<f8"}
PLY_NAMES = {np.dtype(code): name for name, code in PLY_TYPES.items()}

RAS_TO_LPS = np.array([-1, -1, 1])  # and back


def triangles_of(polydata):
    """The same surface of triangles alone, with its points as they are, in their order."""
    polygons = polydata.GetPolys()
    only = polydata.GetNumberOfStrips() == 0 and polygons.GetNumberOfCells() > 0
    if only and polygons.GetMaxCellSize() == 3 and polygons.GetNumberOfConnectivityIds() == 3 * polygons.GetNumberOfCells():
        return polydata
    cut = vtk.vtkTriangleFilter()
    cut.PassVertsOff()
    cut.PassLinesOff()
    cut.SetInputData(polydata)
    cut.Update()
    return cut.GetOutput()


def labels_of(polydata):
    """Arrays of one whole number a point, which may be labels, by name; as int32."""
    found = {}
    of_points = polydata.GetPointData()
    for i in range(of_points.GetNumberOfArrays()):
        array = of_points.GetArray(i)
        if array is None or array.GetNumberOfComponents() != 1 or not (array.GetName() or "").isidentifier():
            continue
        values = vtk_to_numpy(array)
        if np.all(np.isfinite(values)) and np.array_equal(values, np.round(values)) and np.all(np.abs(values) < 2**31):
            found[array.GetName()] = values.astype("<i4")
    return found


def write_lps(path, polydata_ras):
    """A node's surface as PLY in LPS: coordinates as floats or doubles, whichever the node has. ValueError for one without triangles."""
    surface = triangles_of(polydata_ras)
    if surface.GetNumberOfPoints() == 0 or surface.GetNumberOfPolys() == 0:
        raise ValueError("The node has no surface.")
    points = vtk_to_numpy(surface.GetPoints().GetData())
    kind = "<f8" if points.dtype == np.float64 else "<f4"
    labels = labels_of(surface)
    table = np.empty(len(points), dtype=[("x", kind), ("y", kind), ("z", kind), *((name, "<i4") for name in labels)])
    for column, axis in enumerate("xyz"):
        table[axis] = points[:, column] * RAS_TO_LPS[column]
    for name, values in labels.items():
        table[name] = values
    faces = np.empty(surface.GetNumberOfPolys(), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    properties = "".join(f"property {PLY_NAMES[table.dtype[name]]} {name}\n" for name in table.dtype.names)
    header = (
        f"ply\nformat binary_little_endian 1.0\ncomment SPACE=LPS\nelement vertex {len(table)}\n{properties}"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    pathlib.Path(path).write_bytes(header.encode() + table.tobytes() + faces.tobytes())


def read_lps(path):
    """A mesh as the program writes it, as a surface in RAS, its attributes as arrays of points."""
    content = pathlib.Path(path).read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    fields, count, element = [], {}, None
    for line in content[:end].decode().splitlines():
        words = line.split()
        if words[0] == "element":
            element = words[1]
            count[element] = int(words[2])
        elif words[0] == "property" and element == "vertex":
            fields.append((words[2], PLY_TYPES[words[1]]))
    of_vertex = np.dtype(fields)
    table = np.frombuffer(content, of_vertex, count["vertex"], end)
    of_face = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
    corners = np.frombuffer(content, of_face, count["face"], end + count["vertex"] * of_vertex.itemsize)["corners"]

    points = np.column_stack([table[axis] for axis in "xyz"])
    points = np.ascontiguousarray(points * RAS_TO_LPS.astype(points.dtype))
    polydata = vtk.vtkPolyData()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    polydata.SetPoints(places)
    cells = vtk.vtkCellArray()
    offsets = np.arange(0, 3 * len(corners) + 1, 3, dtype=np.int64)
    cells.SetData(
        numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(corners.astype(np.int64).ravel(), deep=True)
    )
    polydata.SetPolys(cells)
    for name in of_vertex.names:
        if name not in "xyz":
            array = numpy_to_vtk(np.ascontiguousarray(table[name]), deep=True)
            array.SetName(name)
            polydata.GetPointData().AddArray(array)
    return polydata
