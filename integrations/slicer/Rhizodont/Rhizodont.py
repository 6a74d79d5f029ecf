# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The module's window in 3D Slicer; what it does is in RhizodontLib."""

import ctk
import qt
import slicer
from slicer.ScriptedLoadableModule import (
    ScriptedLoadableModule,
    ScriptedLoadableModuleTest,
    ScriptedLoadableModuleWidget,
)

from RhizodontLib.logic import NOTICE, RhizodontLogic
from RhizodontLib.program import ArchSettings, Cancelled, Refused, ToothSettings, find_program

PROGRAM_SETTING = "Rhizodont/Program"


class Rhizodont(ScriptedLoadableModule):
    def __init__(self, parent):
        ScriptedLoadableModule.__init__(self, parent)
        parent.title = "Rhizodont"
        parent.categories = ["Dental"]
        parent.dependencies = []
        parent.contributors = ["Rhizodont contributors"]
        parent.helpText = f"Whole teeth with roots from scanned crowns, the crown kept to the bit. {NOTICE}"
        parent.acknowledgementText = "Weights derive from sources under CC BY 4.0 and MIT; see the program's model cards."


def measured_lengths(text):
    """'36=14.2 11=13' as FDI numbers to mm. Raises Refused for anything else."""
    lengths = {}
    for word in text.replace(",", " ").split():
        number, _, length = word.partition("=")
        try:
            lengths[int(number)] = float(length)
        except ValueError:
            raise Refused(f"'{word}' is no measured length: write 36=14.2.") from None
    return lengths


class RhizodontWidget(ScriptedLoadableModuleWidget):
    def setup(self):
        ScriptedLoadableModuleWidget.setup(self)
        notice = qt.QLabel(NOTICE)
        notice.wordWrap = True
        self.layout.addWidget(notice)
        self.layout.addWidget(self.input_section())
        self.layout.addWidget(self.tooth_section())
        self.layout.addWidget(self.arch_section())
        self.cancel_button = qt.QPushButton("Cancel")
        self.cancel_button.enabled = False
        self.cancel_button.connect("clicked()", self.cancel)
        self.layout.addWidget(self.cancel_button)
        self.said = qt.QPlainTextEdit()
        self.said.readOnly = True
        self.layout.addWidget(self.said)
        self.cancelled = False

    def section(self, title):
        box = ctk.ctkCollapsibleButton()
        box.text = title
        return box, qt.QFormLayout(box)

    def input_section(self):
        box, form = self.section("Crown or scan")
        self.node = slicer.qMRMLNodeComboBox()
        self.node.nodeTypes = ["vtkMRMLModelNode", "vtkMRMLSegmentationNode"]
        self.node.addEnabled = self.node.removeEnabled = False
        self.node.setMRMLScene(slicer.mrmlScene)
        self.node.connect("currentNodeChanged(vtkMRMLNode*)", self.show_segments)
        form.addRow("Model or segmentation:", self.node)
        self.segment = qt.QComboBox()
        form.addRow("Segment:", self.segment)
        self.e = self.number(0.2, 2, 0.5, "mm")
        form.addRow("Mesh width e:", self.e)
        self.program = ctk.ctkPathLineEdit()
        self.program.currentPath = qt.QSettings().value(PROGRAM_SETTING, "") or ""
        self.program.connect("currentPathChanged(QString)", lambda path: qt.QSettings().setValue(PROGRAM_SETTING, path))
        form.addRow("Program, if not on the PATH:", self.program)
        return box

    def tooth_section(self):
        box, form = self.section("A crown")
        self.fdi = qt.QSpinBox()
        self.fdi.maximum = 48
        self.fdi.specialValueText = "guessed"
        form.addRow("FDI number:", self.fdi)
        self.root_length = self.number(0, 30, 0, "mm")
        self.root_length.specialValueText = "as predicted"
        form.addRow("Root length:", self.root_length)
        self.tip, self.torque, self.bend = (self.number(-most, most, 0, "degrees") for most in (30, 30, 45))
        form.addRow("Tip, apex to distal:", self.tip)
        form.addRow("Torque, apex to tongue or palate:", self.torque)
        form.addRow("Bend, apex to distal:", self.bend)
        self.skirt, self.repair = qt.QCheckBox("Drop gum and webs"), qt.QCheckBox("Mend defects")
        form.addRow(self.skirt)
        form.addRow(self.repair)
        form.addRow(self.button("Complete the crown", self.complete))
        return box

    def arch_section(self):
        box, form = self.section("A scan of a jaw")
        self.label_array = qt.QLineEdit()
        self.label_array.placeholderText = "one with a usual name, else teeth are searched for"
        form.addRow("Array of labels:", self.label_array)
        self.jaw = qt.QComboBox()
        self.jaw.addItems(["found", "upper", "lower"])
        form.addRow("Jaw:", self.jaw)
        self.lengths = qt.QLineEdit()
        self.lengths.placeholderText = "36=14.2 11=13.0"
        form.addRow("Measured root lengths, mm:", self.lengths)
        self.resolve = qt.QCheckBox("Bring roots apart that come too near")
        form.addRow(self.resolve)
        form.addRow(self.button("Complete every tooth", self.complete_arch))
        return box

    @staticmethod
    def number(least, most, value, unit):
        box = qt.QDoubleSpinBox()
        box.minimum, box.maximum, box.value = least, most, value
        box.singleStep, box.decimals, box.suffix = 0.1, 1, " " + unit
        return box

    @staticmethod
    def button(text, action):
        button = qt.QPushButton(text)
        button.connect("clicked()", action)
        return button

    def show_segments(self, node):
        self.segment.clear()
        if node is not None and node.IsA("vtkMRMLSegmentationNode"):
            segmentation = node.GetSegmentation()
            for i in range(segmentation.GetNumberOfSegments()):
                segment_id = segmentation.GetNthSegmentID(i)
                self.segment.addItem(segmentation.GetSegment(segment_id).GetName(), segment_id)

    def cancel(self):
        self.cancelled = True

    def wait(self):
        slicer.app.processEvents()
        return not self.cancelled

    def logic_of_settings(self):
        # Slicer's own environment names its libraries, which are not the program's.
        return RhizodontLogic(slicer.mrmlScene, self.program.currentPath, slicer.util.startupEnvironment(), self.wait)

    def run(self, work):
        """Shows what `work` returns, a sentence a line, or why it came to nothing."""
        node = self.node.currentNode()
        if node is None:
            self.said.plainText = "Choose a model or a segmentation first."
            return
        self.cancelled, self.cancel_button.enabled = False, True
        self.said.plainText = "Working ..."
        try:
            segment = self.segment.currentData if node.IsA("vtkMRMLSegmentationNode") else ""
            self.said.plainText = "\n".join(work(node, segment or ""))
        except (Refused, Cancelled) as reason:
            self.said.plainText = str(reason)
        finally:
            self.cancel_button.enabled = False

    def complete(self):
        def work(node, segment):
            settings = ToothSettings(
                self.fdi.value, self.e.value, self.root_length.value, self.tip.value, self.torque.value, self.bend.value,
                "auto" if self.skirt.checked else "keep", self.repair.checked,
            )
            tooth = self.logic_of_settings().complete(node, settings, segment)
            return [*said_of(tooth), NOTICE]

        self.run(work)

    def complete_arch(self):
        def work(node, segment):
            settings = ArchSettings(
                self.e.value, self.label_array.text.strip(), "" if self.jaw.currentIndex == 0 else self.jaw.currentText,
                self.resolve.checked, measured_lengths(self.lengths.text),
            )
            teeth, refusals, notes = self.logic_of_settings().complete_arch(node, settings, segment)
            return [line for tooth in teeth for line in said_of(tooth)] + refusals + notes + [NOTICE]

        self.run(work)


def said_of(tooth):
    words = f"Tooth {tooth.GetAttribute('Rhizodont.FDI')}: root {tooth.GetAttribute('Rhizodont.RootLengthMm')} mm"
    interval = tooth.GetAttribute("Rhizodont.RootLength80PercentMm")
    if interval:
        words += ", {} to {} with 80 % probability".format(*interval.split())
    return [words, *(tooth.GetAttribute("Rhizodont.Warnings") or "").splitlines()]


class RhizodontTest(ScriptedLoadableModuleTest):
    """In Slicer: a crown that is the file $RHIZODONT_TEST_CROWN; without that, or without the program, nothing is tested."""

    def runTest(self):
        import os

        crown = os.environ.get("RHIZODONT_TEST_CROWN")
        try:
            find_program()
        except Refused:
            crown = None
        if not crown:
            self.delayDisplay("Nothing tested: $RHIZODONT_TEST_CROWN and the program are needed.")
            return
        node = slicer.util.loadModel(crown)
        tooth = RhizodontLogic(slicer.mrmlScene, environment=slicer.util.startupEnvironment()).complete(node, ToothSettings(e=1))
        given, made = (slicer.util.arrayFromModelPoints(n) for n in (node, tooth))
        self.assertGreater(len(made), len(given))
        self.assertTrue((made[: len(given)] == given).all())
        self.delayDisplay("Test passed")
