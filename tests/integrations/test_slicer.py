# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the module for 3D Slicer does without Slicer: surfaces, frames, the program; nodes and window are small stand-ins."""

import os
import pathlib
import re
import subprocess
import sys
import types
from unittest import mock

import pytest

np = pytest.importorskip("numpy")
vtk = pytest.importorskip("vtk", reason="python3-vtk9 is not installed (scripts/install_dependencies.sh integrations)")

SOURCE = pathlib.Path(os.environ["RHIZODONT_SOURCE"])
PROGRAM = os.environ["RHIZODONT"]
MODULE = SOURCE / "integrations/slicer/Rhizodont"
sys.path.insert(0, str(MODULE))

from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy  # noqa: E402

from RhizodontLib import polydata, program  # noqa: E402
from RhizodontLib.logic import NOTICE, RhizodontLogic, surface_of  # noqa: E402


class Display:
    UseDirectMapping = 3

    def __init__(self):
        self.said = {}

    def __getattr__(self, name):
        return lambda value: self.said.__setitem__(name, value)


class Node:
    """The part of vtkMRMLModelNode that is used."""

    def __init__(self, surface=None, transform=None):
        self.surface, self.transform, self.attributes, self.display = surface, transform, {}, None

    def GetPolyData(self):
        return self.surface

    def SetAndObservePolyData(self, surface):
        self.surface = surface

    def GetTransformNodeID(self):
        return self.transform

    def SetAndObserveTransformNodeID(self, transform):
        self.transform = transform

    def SetAttribute(self, name, value):
        assert isinstance(value, str)
        self.attributes[name] = value

    def GetAttribute(self, name):
        return self.attributes.get(name)

    def CreateDefaultDisplayNodes(self):
        self.display = Display()

    def GetDisplayNode(self):
        return self.display

    def IsA(self, name):
        return name == "vtkMRMLModelNode"


class Segmentation(Node):
    """The part of vtkMRMLSegmentationNode that is used: its surface is there once it was asked for."""

    made = False

    def GetSegmentation(self):
        return self

    def ContainsRepresentation(self, name):
        assert name == "Closed surface"
        return self.made

    def CreateClosedSurfaceRepresentation(self):
        self.made = True

    def GetClosedSurfaceRepresentation(self, segment_id, surface):
        assert self.made and segment_id == "Segment_1"
        surface.DeepCopy(self.surface)


class Scene:
    def __init__(self):
        self.nodes = {}

    def AddNewNodeByClass(self, kind, name):
        assert kind == "vtkMRMLModelNode"
        self.nodes[name] = Node()
        return self.nodes[name]


def surface_from(points, polygons):
    surface = vtk.vtkPolyData()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    surface.SetPoints(places)
    cells = vtk.vtkCellArray()
    for polygon in polygons:
        cells.InsertNextCell(len(polygon), polygon)
    surface.SetPolys(cells)
    return surface


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData())


def corners_of(surface):
    return vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def volume(surface):
    a, b, c = (points_of(surface)[corner] for corner in corners_of(surface).T)
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def named(surface, **arrays):
    for name, values in arrays.items():
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        surface.GetPointData().AddArray(array)
    return surface


CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=np.float32) * 7 + np.float32([0.1, 0.2, 0.3])
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


@pytest.fixture(scope="module")
def crown():
    return polydata.read_lps(SOURCE / "samples/crown_34.ply")


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_files_are_lps_and_no_digit_changes(tmp_path, kind):
    points = CUBE.astype(kind) / 3
    surface = surface_from(points, QUADS)
    polydata.write_lps(tmp_path / "cube.ply", surface)
    content = (tmp_path / "cube.ply").read_bytes()
    assert b"comment SPACE=LPS\n" in content
    first = np.frombuffer(content, kind, 3, content.index(b"end_header\n") + 11)
    assert np.array_equal(first, points[0] * [-1, -1, 1])

    back = polydata.read_lps(tmp_path / "cube.ply")
    assert points_of(back).dtype == kind and np.array_equal(points_of(back), points)
    assert back.GetNumberOfPolys() == 12 and volume(back) > 0
    assert volume(back) == pytest.approx((7 / 3) ** 3)


def test_strips_and_lines_are_taken_for_what_they_are(tmp_path):
    surface = surface_from(CUBE[:4], [])
    strip = vtk.vtkCellArray()
    strip.InsertNextCell(4, [0, 1, 2, 3])
    surface.SetStrips(strip)
    lines = vtk.vtkCellArray()
    lines.InsertNextCell(2, [0, 3])
    surface.SetLines(lines)
    polydata.write_lps(tmp_path / "strip.ply", surface)
    assert polydata.read_lps(tmp_path / "strip.ply").GetNumberOfPolys() == 2


def test_a_node_without_surface_is_refused():
    for nothing in (vtk.vtkPolyData(), surface_from(CUBE, [])):
        with pytest.raises(program.Refused, match="no surface"):
            RhizodontLogic(Scene(), PROGRAM).complete(Node(nothing))


def test_labels_go_along_and_what_is_none_does_not(tmp_path):
    surface = named(surface_from(CUBE, QUADS), Universal_ID=np.arange(8), curvature=np.linspace(0, 1, 8), Normals=np.zeros((8, 3)))
    assert list(polydata.labels_of(surface)) == ["Universal_ID"]
    polydata.write_lps(tmp_path / "cube.ply", surface)
    labels = polydata.read_lps(tmp_path / "cube.ply").GetPointData().GetArray("Universal_ID")
    assert np.array_equal(vtk_to_numpy(labels), np.arange(8))


def test_a_crown_becomes_a_tooth_in_its_place(crown, tmp_path):
    scene = Scene()
    logic = RhizodontLogic(scene, PROGRAM)
    tooth = logic.complete(Node(crown, "vtkMRMLTransformNode7"), program.ToothSettings(fdi=34, e=1))
    assert list(scene.nodes.values()) == [tooth] and tooth.transform == "vtkMRMLTransformNode7"
    given, made = points_of(crown), points_of(tooth.surface)
    assert np.array_equal(made[: len(given)].view(np.uint32), given.view(np.uint32))
    assert tooth.attributes["Rhizodont.FDI"] == "34" and tooth.attributes["Rhizodont.Notice"] == NOTICE
    low, high = map(float, tooth.attributes["Rhizodont.RootLength80PercentMm"].split())
    assert low < float(tooth.attributes["Rhizodont.RootLengthMm"]) < high

    source = vtk_to_numpy(tooth.surface.GetPointData().GetArray("source"))
    colours = vtk_to_numpy(tooth.surface.GetPointData().GetArray("source colour"))
    assert set(source) == {0, 1, 2} and len(np.unique(colours, axis=0)) == 3
    assert tooth.display.said["SetActiveScalarName"] == "source colour"
    assert vtk_to_numpy(tooth.surface.GetPointData().GetArray("uncertainty"))[: len(given)].max() == 0

    # The same by the program's own proof.
    for name, surface in (("crown", crown), ("tooth", tooth.surface)):
        polydata.write_lps(tmp_path / f"{name}.ply", surface)
    assert subprocess.run([PROGRAM, "check", tmp_path / "crown.ply", tmp_path / "tooth.ply"]).returncode == 0


def test_a_segment_is_a_crown_too(crown):
    node = Segmentation(crown)
    assert np.array_equal(points_of(surface_of(node, "Segment_1")), points_of(crown))
    tooth = RhizodontLogic(Scene(), PROGRAM).complete(node, program.ToothSettings(fdi=34, e=1, root_length=12.5), "Segment_1")
    assert float(tooth.attributes["Rhizodont.RootLengthMm"]) == pytest.approx(12.5, abs=0.3)
    assert "Rhizodont.RootLength80PercentMm" not in tooth.attributes


def test_every_tooth_of_a_labelled_scan(crown):
    count = crown.GetNumberOfPoints()
    points = np.vstack([points_of(crown), points_of(crown) + np.float32([9, 0, 0])])
    corners = np.vstack([corners_of(crown), corners_of(crown) + count])
    # A milk molar beside a premolar: it has no root, and that stops nothing.
    scan = named(surface_from(points, corners.tolist()), fdi=np.repeat([34, 75], count))
    scene = Scene()
    teeth, refusals, _ = RhizodontLogic(scene, PROGRAM).complete_arch(Node(scan), program.ArchSettings(e=1, root_lengths={34: 13}))
    assert list(scene.nodes) == ["Tooth 34"] and len(teeth) == 1
    assert float(teeth[0].attributes["Rhizodont.RootLengthMm"]) == pytest.approx(13, abs=0.3)
    assert len(refusals) == 1 and refusals[0].startswith("75: ") and len(refusals[0]) > 20
    # In the scan's frame: the kept crown's points are the scan's.
    kept = vtk_to_numpy(teeth[0].surface.GetPointData().GetArray("source")) == 0
    of_scan = {tuple(p) for p in points[:count].tolist()}
    assert all(tuple(p) in of_scan for p in points_of(teeth[0].surface)[kept].tolist())


def test_refusals_are_the_programs_sentences_without_paths():
    scene = Scene()
    with pytest.raises(program.Refused) as refusal:
        RhizodontLogic(scene, PROGRAM).complete(Node(surface_from(CUBE, QUADS)))
    assert len(str(refusal.value)) > 20 and "/tmp" not in str(refusal.value)
    assert not scene.nodes


def test_only_the_hidden_folder_is_taken_out_of_a_sentence():
    for hidden, expected in (("", "/data/in/a.ply: no mesh"), ("/data/in", "a.ply: no mesh"), ("/other", "/data/in/a.ply: no mesh")):
        with pytest.raises(program.Refused) as refusal:
            program.run(["/bin/sh", "-c", "echo 'rhizodont: /data/in/a.ply: no mesh' >&2; exit 3"], hidden=hidden)
        assert str(refusal.value) == expected


def test_without_the_program_that_is_said(monkeypatch, tmp_path):
    monkeypatch.setenv("RHIZODONT", "")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(program.Refused, match="not found"):
        program.find_program(str(tmp_path / "nowhere"))


def test_the_user_may_cancel(tmp_path):
    sleeper = tmp_path / "sleeper"
    sleeper.write_text("#!/bin/sh\nexec sleep 60\n")
    sleeper.chmod(0o755)
    answers = iter([True, True, False])
    with pytest.raises(program.Cancelled):
        program.run([str(sleeper)], wait=lambda: next(answers))


def test_what_a_program_says_at_length_does_not_stop_it(tmp_path):
    with pytest.raises(program.Refused) as refusal:
        program.run(["/bin/sh", "-c", "head -c 300000 /dev/zero | tr '\\0' x >&2; exit 3"])
    assert len(str(refusal.value)) == 300000


def test_settings_say_what_differs():
    assert program.ToothSettings().arguments() == ["--e", "0.5"]
    settings = program.ToothSettings(fdi=11, root_length=13.5, tip=-4, bend=2, skirt="auto", repair=True)
    assert " ".join(settings.arguments()) == "--e 0.5 --fdi 11 --root-length 13.5 --root-tip -4 --root-bend 2 --skirt auto --repair"
    arch = program.ArchSettings(label_array="Universal_ID", jaw="upper", resolve_collisions=True, root_lengths={11: 13, 16: 12.5})
    assert (
        " ".join(arch.arguments()) == "--e 0.5 --label-array Universal_ID --jaw upper --root-length 11=13 16=12.5 --resolve-collisions"
    )


@pytest.fixture
def window(monkeypatch):
    """The window, with stand-ins for Slicer's and Qt's classes."""
    base = types.ModuleType("slicer.ScriptedLoadableModule")
    for name in ("ScriptedLoadableModule", "ScriptedLoadableModuleTest", "ScriptedLoadableModuleWidget"):
        setattr(base, name, type(name, (), {"__init__": lambda self, parent=None: None, "setup": lambda self: None}))
    slicer = mock.MagicMock()
    slicer.mrmlScene, slicer.util.startupEnvironment = Scene(), lambda: dict(os.environ)
    stand_ins = {"slicer": slicer, "slicer.ScriptedLoadableModule": base, "qt": mock.MagicMock(), "ctk": mock.MagicMock()}
    for name in ("QLabel", "QPushButton", "QComboBox", "QCheckBox", "QLineEdit", "QSpinBox", "QDoubleSpinBox", "QPlainTextEdit"):
        setattr(stand_ins["qt"], name, lambda *_: mock.MagicMock())
    for name, stand_in in stand_ins.items():
        monkeypatch.setitem(sys.modules, name, stand_in)
    monkeypatch.delitem(sys.modules, "Rhizodont", raising=False)
    import Rhizodont

    widget = Rhizodont.RhizodontWidget()
    widget.layout = mock.MagicMock()
    widget.setup()
    widget.program.currentPath = PROGRAM
    widget.e.value, widget.fdi.value, widget.root_length.value = 1, 34, 12
    widget.tip.value = widget.torque.value = widget.bend.value = 0
    widget.skirt.checked = widget.repair.checked = widget.resolve.checked = False
    return Rhizodont, widget, slicer


def test_the_window_shows_what_came_out(window, crown):
    _, widget, slicer = window
    widget.node.currentNode = lambda: Node(crown)
    widget.complete()
    assert re.match(r"Tooth 34: root 1[12]\.\d+ mm\n", widget.said.plainText) and widget.said.plainText.endswith(NOTICE)
    assert list(slicer.mrmlScene.nodes) == ["Tooth 34"] and widget.cancel_button.enabled is False


def test_the_window_shows_why_nothing_came_out(window):
    module, widget, slicer = window
    widget.node.currentNode = lambda: None
    widget.complete()
    assert "Choose" in widget.said.plainText
    widget.node.currentNode = lambda: Node(vtk.vtkPolyData())
    widget.complete()
    assert widget.said.plainText == "The node has no surface."
    widget.lengths.text, widget.label_array.text = "36:14", ""
    widget.complete_arch()
    assert "36=14.2" in widget.said.plainText and not slicer.mrmlScene.nodes
    assert module.measured_lengths("36=14.2, 11=13") == {36: 14.2, 11: 13.0}


def test_the_extension_names_its_files():
    text = (MODULE / "CMakeLists.txt").read_text()
    named_files = set(re.findall(r"RhizodontLib/\w+\.py|Resources/\w+/\$\{MODULE_NAME\}\.png", text))
    assert named_files == {f"RhizodontLib/{f.name}" for f in (MODULE / "RhizodontLib").glob("*.py")} | {"Resources/Icons/${MODULE_NAME}.png"}
    assert (MODULE / "Resources/Icons/Rhizodont.png").exists()
