# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole teeth from scanned crowns in Blender: calls the program `rhizodont`, nothing else. One Blender unit is one millimetre.

A predicted root is not anatomy: it is typical for such a crown, not the patient's own."""

bl_info = {
    "name": "Rhizodont",
    "description": "Whole teeth with roots from scanned crowns, the crown kept to the bit",
    "author": "Rhizodont contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D Viewport > Sidebar > Rhizodont",
    "category": "Mesh",
}

import json
import os
import pathlib
import shutil
import subprocess
import tempfile

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

NOTICE = "A predicted root is typical for such a crown, not the patient's anatomy"

# Names and colours of materials by where a triangle comes from; as in the program's pictures.
SOURCES = (("scan", (0.85, 0.82, 0.75, 1)), ("transition", (0.1, 0.45, 0.5, 1)), ("predicted", (0.45, 0.27, 0.12, 1)))

PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4", "float": "<f4", "double": "<f8"}


class Refused(Exception):
    """What the program says where it gives no tooth."""


# ---- Files: Blender's own readers of PLY keep no attributes of vertices, and numbers are to stay what they are.


def write_ply(path, vertices, triangles):
    """vertices: n x 3 float32, triangles: m x 3 int32."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    path.write_bytes(header.encode() + np.asarray(vertices, dtype="<f4").tobytes() + faces.tobytes())


def read_ply(path):
    """A tooth as the program writes it: vertices n x 3, triangles m x 3, and attributes of vertices by name."""
    content = path.read_bytes()
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
    faces = np.frombuffer(
        content, np.dtype([("count", "u1"), ("corners", "<i4", 3)]), count["face"], end + count["vertex"] * of_vertex.itemsize
    )
    vertices = np.column_stack([table[axis] for axis in "xyz"])
    return vertices, faces["corners"], {name: table[name] for name in table.dtype.names if name not in "xyz"}


# ---- The program


def find_program(stated=""):
    """Path of the program: as stated in the preferences, else $RHIZODONT, else on the PATH. Raises Refused."""
    for candidate in (bpy.path.abspath(stated) if stated else "", os.environ.get("RHIZODONT", ""), shutil.which("rhizodont") or ""):
        if candidate and os.access(candidate, os.X_OK) and os.path.isfile(candidate):
            return candidate
    raise Refused("The program rhizodont was not found: install it, or name its file in the add-on's preferences.")


def complete_command(program, crown, tooth, report, settings):
    """The command line for what is set of a crown; only what differs from the program's own defaults is said."""
    command = [program, "complete", str(crown), "-o", str(tooth), "--report", str(report), "--quiet", "--e", f"{settings.e:g}"]
    if settings.fdi:
        command += ["--fdi", str(settings.fdi)]
    if settings.root_length:
        command += ["--root-length", f"{settings.root_length:g}"]
    for option in ("tip", "torque", "bend"):
        if getattr(settings, option):
            command += [f"--root-{option}", f"{getattr(settings, option):g}"]
    if settings.skirt != "keep":
        command += ["--skirt", settings.skirt]
    if settings.repair:
        command.append("--repair")
    return command


def complete(program, vertices, triangles, settings):
    """(vertices, triangles, attributes, report) of a tooth. Raises Refused with the program's own sentence."""
    with tempfile.TemporaryDirectory() as folder:
        crown, tooth, report = (pathlib.Path(folder) / name for name in ("crown.ply", "tooth.ply", "tooth.json"))
        write_ply(crown, vertices, triangles)
        done = subprocess.run(complete_command(program, crown, tooth, report, settings), capture_output=True, text=True)
        if done.returncode:
            sentence = done.stderr.strip().removeprefix("rhizodont: ") or f"The program ended with {done.returncode}."
            raise Refused(sentence.replace(str(crown), "The crown").replace(folder + os.sep, ""))
        return (*read_ply(tooth), json.loads(report.read_text()))


# ---- Meshes


def mesh_arrays(mesh):
    """vertices n x 3 float32, triangles m x 3 int32, as they stand in the object's own frame. Polygons are cut by Blender."""
    vertices = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", vertices)
    mesh.calc_loop_triangles()
    triangles = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    return vertices.reshape(-1, 3), triangles.reshape(-1, 3)


def source_materials():
    """A material for each source; made once."""
    materials = []
    for name, colour in SOURCES:
        material = bpy.data.materials.get("Rhizodont " + name)
        if material is None:
            material = bpy.data.materials.new("Rhizodont " + name)
            material.diffuse_color = colour
            material.use_nodes = True
            material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
        materials.append(material)
    return materials


def make_mesh(name, vertices, triangles, attributes):
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(vertices, dtype=np.float32).ravel())
    mesh.loops.add(3 * len(triangles))
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(triangles, dtype=np.int32).ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(triangles), 3, dtype=np.int32))
    if bpy.app.version < (4, 0, 0):
        mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, dtype=np.int32))
    source = attributes["source"].astype(np.int32)
    for attribute, kind, values in (("source", "INT", source), ("uncertainty", "FLOAT", attributes["uncertainty"].astype(np.float32))):
        mesh.attributes.new(attribute, kind, "POINT").data.foreach_set("value", values)
    for material in source_materials():
        mesh.materials.append(material)
    # A triangle is the crown's if all its corners are; else it is what its least seen corner is.
    mesh.polygons.foreach_set("material_index", source[triangles].max(axis=1).astype(np.int32))
    mesh.update(calc_edges=True)
    return mesh


def put_tooth(context, crown, tooth, settings):
    """A mesh object for the tooth, in the crown's place; the one that this crown has already is given the new mesh."""
    vertices, triangles, attributes, report = tooth
    fdi = report["fdi"]["number"]
    mesh = make_mesh(f"Tooth {fdi}", vertices, triangles, attributes)
    target = next((o for o in context.scene.objects if o.rhizodont.crown == crown), None)
    if target is None:
        target = bpy.data.objects.new(mesh.name, mesh)
        for collection in crown.users_collection:
            collection.objects.link(target)
    else:
        old = target.data
        target.data = mesh
        if not old.users:
            bpy.data.meshes.remove(old)
    target.parent = crown.parent
    target.matrix_parent_inverse = crown.matrix_parent_inverse.copy()
    target.matrix_basis = crown.matrix_basis.copy()
    target.rhizodont.crown = crown
    for name in SETTINGS:
        setattr(target.rhizodont, name, getattr(settings, name))
    root = report["root"]
    target["fdi"], target["root_length_mm"] = fdi, root["length_mm"]
    for name in ("length_low_mm", "length_high_mm"):
        if root["interval"]:
            target["root_" + name] = root["interval"][name]
        elif "root_" + name in target:
            del target["root_" + name]
    target["notice"] = NOTICE
    target["warnings"] = "\n".join(report["warnings"])
    return target


# ---- What Blender shows

SETTINGS = ("fdi", "root_length", "tip", "torque", "bend", "e", "skirt", "repair")


class RhizodontSettings(bpy.types.PropertyGroup):
    """Of a crown or a tooth."""

    crown: PointerProperty(type=bpy.types.Object, name="Crown", description="The crown that this tooth was made from")
    fdi: IntProperty(name="FDI number", min=0, max=48, description="11 to 48; 0: guessed from the shape")
    root_length: FloatProperty(name="Root length", min=0, max=30, precision=1, description="mm, such as measured on an X-ray; 0: as predicted")
    tip: FloatProperty(name="Tip", min=-30, max=30, description="Degrees; positive: apex towards distal")
    torque: FloatProperty(name="Torque", min=-30, max=30, description="Degrees; positive: apex towards tongue or palate")
    bend: FloatProperty(name="Bend", min=-45, max=45, description="Degrees, of the lower half; positive: apex towards distal")
    e: FloatProperty(name="Mesh width e", min=0.2, max=2, default=0.5, description="mm; new edges are about half of it")
    skirt: EnumProperty(
        name="Gum", items=[("keep", "Keep", "Drop nothing"), ("auto", "Drop", "Drop gum and webs around the crown")], default="keep"
    )
    repair: BoolProperty(name="Repair", description="Mend a defective crown first")


class RhizodontPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: StringProperty(name="Program", subtype="FILE_PATH", description="The file rhizodont, if it is not on the PATH")

    def draw(self, context):
        self.layout.prop(self, "program")


def stated_program(context):
    addon = context.preferences.addons.get(__name__)
    return addon.preferences.program if addon else ""


class RHIZODONT_OT_import(bpy.types.Operator, ImportHelper):
    """Read a scanned crown; its number is taken from the file's name where that has one"""

    bl_idname = "rhizodont.import_crown"
    bl_label = "Import crown"
    bl_options = {"REGISTER", "UNDO"}
    filter_glob: StringProperty(default="*.stl;*.ply;*.obj", options={"HIDDEN"})

    def execute(self, context):
        ending = os.path.splitext(self.filepath)[1].lower()
        before = set(bpy.data.objects)
        new = bpy.app.version >= (4, 1, 0)
        as_they_are = {"forward_axis": "Y", "up_axis": "Z"}
        if ending == ".stl":
            bpy.ops.wm.stl_import(filepath=self.filepath, **as_they_are) if new else bpy.ops.import_mesh.stl(filepath=self.filepath)
        elif ending == ".ply":
            bpy.ops.wm.ply_import(filepath=self.filepath, **as_they_are) if new else bpy.ops.import_mesh.ply(filepath=self.filepath)
        elif ending == ".obj":
            bpy.ops.wm.obj_import(filepath=self.filepath, **as_they_are)
        else:
            self.report({"ERROR"}, "Blender reads crowns from .stl, .ply and .obj.")
            return {"CANCELLED"}
        crowns = [o for o in bpy.data.objects if o not in before and o.type == "MESH"]
        for crown in crowns:
            crown.rhizodont.fdi = fdi_in_name(self.filepath)
        return {"FINISHED"} if crowns else {"CANCELLED"}


def fdi_in_name(path):
    """The one permanent tooth's number in a file's name; 0 if there is none, or more than one."""
    digits = "".join(c if c.isdigit() else " " for c in os.path.basename(path)).split()
    numbers = {int(d) for d in digits if len(d) == 2 and d[0] in "1234" and d[1] in "12345678"}
    return numbers.pop() if len(numbers) == 1 else 0


class RHIZODONT_OT_complete(bpy.types.Operator):
    """Give the crown its root; of a tooth: make its root anew"""

    bl_idname = "rhizodont.complete"
    bl_label = "Complete"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "MESH" and context.mode == "OBJECT"

    def execute(self, context):
        chosen = context.object
        crown = chosen.rhizodont.crown or chosen
        try:
            program = find_program(stated_program(context))
            made = complete(program, *mesh_arrays(crown.data), chosen.rhizodont)
        except Refused as refusal:
            self.report({"ERROR"}, str(refusal))
            return {"CANCELLED"}
        tooth = put_tooth(context, crown, made, chosen.rhizodont)
        crown.hide_set(True)
        for other in context.selected_objects:
            other.select_set(False)
        tooth.select_set(True)
        context.view_layer.objects.active = tooth
        for warning in tooth["warnings"].splitlines():
            self.report({"WARNING"}, warning)
        return {"FINISHED"}


class RHIZODONT_PT_panel(bpy.types.Panel):
    bl_label = "Rhizodont"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Rhizodont"

    def draw(self, context):
        layout = self.layout
        layout.operator(RHIZODONT_OT_import.bl_idname)
        chosen = context.object
        if chosen is None or chosen.type != "MESH":
            return
        for name in SETTINGS:
            layout.prop(chosen.rhizodont, name)
        layout.operator(RHIZODONT_OT_complete.bl_idname, text="Make root anew" if chosen.rhizodont.crown else "Complete")
        if "root_length_mm" in chosen:
            words = f"Root {chosen['root_length_mm']:.1f} mm"
            if "root_length_low_mm" in chosen:
                words += f", {chosen['root_length_low_mm']:.1f} to {chosen['root_length_high_mm']:.1f} with 80 %"
            layout.label(text=words)
            layout.label(text=NOTICE, icon="INFO")


CLASSES = (RhizodontSettings, RhizodontPreferences, RHIZODONT_OT_import, RHIZODONT_OT_complete, RHIZODONT_PT_panel)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.rhizodont = PointerProperty(type=RhizodontSettings)


def unregister():
    del bpy.types.Object.rhizodont
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)


if __name__ == "__main__":
    register()
