# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes in, nodes out. A node is asked for no more than vtkMRMLModelNode and vtkMRMLSegmentationNode have; the scene, for AddNewNodeByClass."""

import json
import pathlib
import tempfile

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from . import polydata, program

NOTICE = "A predicted root is typical for such a crown, not the patient's anatomy: for research and visualisation only."

# Colours by where a vertex comes from, as in the program's pictures.
SOURCES = (("scan", (0.85, 0.82, 0.75)), ("transition", (0.1, 0.45, 0.5)), ("predicted", (0.45, 0.27, 0.12)))


def surface_of(node, segment_id=""):
    """The surface of a model node, or of a segment of a segmentation node, in the node's own coordinates (RAS)."""
    if segment_id:
        if not node.GetSegmentation().ContainsRepresentation("Closed surface"):
            node.CreateClosedSurfaceRepresentation()
        surface = vtk.vtkPolyData()
        node.GetClosedSurfaceRepresentation(segment_id, surface)
        return surface
    return node.GetPolyData()


class RhizodontLogic:
    """Calls the program on nodes.

    scene: adds nodes. environment: of the program's process; None: this one's. wait: called while the program works; returns False to cancel.
    """

    def __init__(self, scene, program_path="", environment=None, wait=lambda: True):
        self.scene = scene
        self.program_path = program_path
        self.environment = environment
        self.wait = wait

    def complete(self, node, settings=None, segment_id=""):
        """A model node with the whole tooth of a crown, in the crown's place. Raises program.Refused, program.Cancelled."""
        settings = settings or program.ToothSettings()
        with tempfile.TemporaryDirectory() as folder:
            crown, tooth, report = (pathlib.Path(folder) / name for name in ("crown.ply", "tooth.ply", "tooth.json"))
            self._write(crown, node, segment_id)
            command = [program.find_program(self.program_path), "complete", str(crown), "-o", str(tooth), "--report", str(report), "--quiet"]
            self._run([*command, *settings.arguments()], folder)
            return self._add_tooth(tooth, json.loads(report.read_text()), node)

    def complete_arch(self, node, settings=None, segment_id=""):
        """(model nodes of the teeth that have roots, a sentence for each that has none, a sentence on the arch each). Raises as `complete`."""
        settings = settings or program.ArchSettings()
        with tempfile.TemporaryDirectory() as folder:
            scan, out = pathlib.Path(folder) / "scan.ply", pathlib.Path(folder) / "arch"
            self._write(scan, node, segment_id)
            command = [program.find_program(self.program_path), "arch", str(scan), "-o", str(out), "--quiet"]
            self._run([*command, *settings.arguments()], folder, also_good=(6,))
            arch = json.loads((out / "arch.json").read_text())
            nodes, refusals = [], []
            for tooth in arch["teeth"]:
                file = out / f"tooth_{tooth['fdi']}.ply"
                if file.exists():
                    nodes.append(self._add_tooth(file, json.loads(file.with_suffix(".json").read_text()), node))
                else:
                    refusals.append(f"{tooth['fdi']}: {tooth.get('refusal') or 'no root'}")
            return nodes, refusals, arch.get("notes", [])

    def _write(self, path, node, segment_id):
        try:
            polydata.write_lps(path, surface_of(node, segment_id))
        except ValueError as nothing:
            raise program.Refused(str(nothing)) from None

    def _run(self, command, folder, also_good=()):
        program.run(command, environment=self.environment, wait=self.wait, also_good=also_good, hidden=folder)

    def _add_tooth(self, file, report, origin):
        fdi = report["fdi"]["number"]
        node = self.scene.AddNewNodeByClass("vtkMRMLModelNode", f"Tooth {fdi}")
        surface = polydata.read_lps(file)
        node.SetAndObservePolyData(surface)
        # Coordinates are the crown's own: what moves the crown moves the tooth.
        node.SetAndObserveTransformNodeID(origin.GetTransformNodeID())
        root = report["root"]
        said = {"FDI": fdi, "RootLengthMm": f"{root['length_mm']:.2f}", "Notice": NOTICE, "Warnings": "\n".join(report["warnings"])}
        if root["interval"]:
            said["RootLength80PercentMm"] = f"{root['interval']['length_low_mm']:.2f} {root['interval']['length_high_mm']:.2f}"
        for name, value in said.items():
            node.SetAttribute("Rhizodont." + name, str(value))
        self._show_sources(node)
        return node

    @staticmethod
    def _show_sources(node):
        node.CreateDefaultDisplayNodes()
        display = node.GetDisplayNode()
        if display is None:
            return
        of_points = node.GetPolyData().GetPointData()
        as_bytes = np.array([[round(255 * part) for part in colour] for _, colour in SOURCES], dtype=np.uint8)
        colours = numpy_to_vtk(as_bytes[vtk_to_numpy(of_points.GetArray("source"))], deep=True)
        colours.SetName("source colour")
        of_points.AddArray(colours)
        display.SetActiveScalarName("source colour")
        display.SetScalarVisibility(True)
        display.SetScalarRangeFlag(display.UseDirectMapping)
