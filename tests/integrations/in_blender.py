# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on in Blender itself: blender --background --factory-startup --python-exit-code 1 --python in_blender.py -- SOURCE FOLDER

The program is $RHIZODONT. Every `assert` that fails ends Blender with 1."""

import importlib.util
import os
import pathlib
import subprocess
import sys

import bmesh
import bpy
import numpy as np

source, folder = map(pathlib.Path, sys.argv[sys.argv.index("--") + 1 :])
program = os.environ["RHIZODONT"]
spec = importlib.util.spec_from_file_location("rhizodont_addon", source / "integrations/blender/rhizodont_addon.py")
addon = importlib.util.module_from_spec(spec)
sys.modules["rhizodont_addon"] = addon
spec.loader.exec_module(addon)
addon.register()


def clear():
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()


def is_closed(mesh):
    edges = bmesh.new()
    edges.from_mesh(mesh)
    closed = all(edge.is_manifold for edge in edges.edges)
    edges.free()
    return closed


def prove(crown, tooth):
    """By the program's own check, on files that the add-on writes."""
    paths = folder / "crown.ply", folder / "tooth.ply"
    for path, mesh in zip(paths, (crown.data, tooth.data)):
        addon.write_ply(path, *addon.mesh_arrays(mesh))
    checked = subprocess.run([program, "check", *paths], capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr


def import_and_complete(file):
    clear()
    assert bpy.ops.rhizodont.import_crown(filepath=str(source / "samples" / file)) == {"FINISHED"}
    crown = bpy.context.object
    crown.rhizodont.e = 1
    assert bpy.ops.rhizodont.complete() == {"FINISHED"}
    return crown, bpy.context.object


# A crown is read as it is in its file, and becomes a tooth in its place.
crown, tooth = import_and_complete("crown_34.ply")
assert crown.rhizodont.fdi == 34
raw, _, _ = addon.read_ply(source / "samples/crown_34.ply")
kept, _ = addon.mesh_arrays(crown.data)
assert np.array_equal(raw.astype(np.float32).view(np.uint32), kept.view(np.uint32))
assert tooth is not crown and tooth["fdi"] == 34 and crown.hide_get()
assert is_closed(tooth.data)
prove(crown, tooth)
vertices, triangles = addon.mesh_arrays(tooth.data)
assert np.array_equal(vertices[: len(kept)].view(np.uint32), kept.view(np.uint32))

# Where vertices come from: the crown's are scanned, and have no uncertainty.
origin = np.empty(len(vertices), dtype=np.int32)
tooth.data.attributes["source"].data.foreach_get("value", origin)
uncertainty = np.empty(len(vertices), dtype=np.float32)
tooth.data.attributes["uncertainty"].data.foreach_get("value", uncertainty)
assert (origin[: len(kept)] == 0).all() and (origin[len(kept) :] > 0).all()
assert (uncertainty[: len(kept)] == 0).all() and uncertainty.max() > 0.1
assert [m.name for m in tooth.data.materials] == ["Rhizodont scan", "Rhizodont transition", "Rhizodont predicted"]
assert {p.material_index for p in tooth.data.polygons} == {0, 1, 2}

# The root's length is a property: changed, the root is another, the crown and the object are the same.
assert tooth["root_length_low_mm"] < tooth["root_length_mm"] < tooth["root_length_high_mm"]
crown.location = tooth.location = (5, 0, 0)
wished = round(tooth["root_length_mm"] + 2, 1)
tooth.rhizodont.root_length = wished
objects = len(bpy.data.objects)
assert bpy.ops.rhizodont.complete() == {"FINISHED"}
assert bpy.context.object is tooth and len(bpy.data.objects) == objects
assert abs(tooth["root_length_mm"] - wished) < 0.3 and "root_length_low_mm" not in tooth
assert tuple(tooth.location) == (5, 0, 0)
prove(crown, tooth)

# A whole tooth's own crown is used again; what is no crown is refused in the program's words.
clear()
bpy.ops.mesh.primitive_cube_add(size=8)
try:
    result, said = bpy.ops.rhizodont.complete(), ""
except RuntimeError as error:  # how Blender passes on an operator's error to scripts
    result, said = {"CANCELLED"}, str(error)
assert result == {"CANCELLED"} and len(said) > 20 and str(folder) not in said and "/tmp" not in said, said
print("refused:", said.strip())

# STL too, and without the program that is said.
crown, tooth = import_and_complete("crown_36.stl")
assert tooth["fdi"] == 36
prove(crown, tooth)
os.environ["RHIZODONT"], os.environ["PATH"] = "", ""
try:
    addon.find_program()
    raise AssertionError("a program was found where there is none")
except addon.Refused as refusal:
    assert "preferences" in str(refusal)

# OBJ keeps its axes, too.
clear()
corners = [(0, 0, 0), (8, 0, 0), (0, 7, 0), (0, 0, 6)]
faces = [(1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4)]
lines = ["v %g %g %g" % corner for corner in corners] + ["f %d %d %d" % face for face in faces]
(folder / "crown_21.obj").write_text("\n".join(lines) + "\n")
assert bpy.ops.rhizodont.import_crown(filepath=str(folder / "crown_21.obj")) == {"FINISHED"}
crown = bpy.context.object
world = [tuple(round(c, 6) for c in crown.matrix_world @ v.co) for v in crown.data.vertices]
assert sorted(world) == sorted(corners), world
assert crown.rhizodont.fdi == 21

assert addon.fdi_in_name("crown_36.stl") == 36
assert addon.fdi_in_name("2021-11-16 b.stl") == 0
addon.unregister()
print("The add-on does what it says.")
