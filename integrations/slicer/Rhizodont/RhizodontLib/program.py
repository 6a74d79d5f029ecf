# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The program rhizodont: found, asked, waited for."""

import dataclasses
import os
import shutil
import subprocess
import tempfile
import time
from typing import Callable, Mapping, Optional


class Refused(Exception):
    """What the program says where it gives no result; a sentence for the user."""


class Cancelled(Exception):
    """The user has had enough."""


def find_program(stated: str = "") -> str:
    """Path of the program: as stated, else $RHIZODONT, else on the PATH. Raises Refused."""
    for candidate in (stated, os.environ.get("RHIZODONT", ""), shutil.which("rhizodont") or ""):
        if candidate and os.path.isfile(candidate) and os.access(candidate, os.X_OK):
            return candidate
    raise Refused("The program rhizodont was not found: install it, or name its file in the module's settings.")


@dataclasses.dataclass
class ToothSettings:
    """Of a single crown; what is None or 0 is left to the program."""

    fdi: int = 0
    e: float = 0.5  # mm, 0.2 to 2
    root_length: float = 0  # mm
    tip: float = 0  # degrees
    torque: float = 0
    bend: float = 0
    skirt: str = "keep"
    repair: bool = False

    def arguments(self):
        words = ["--e", f"{self.e:g}"]
        if self.fdi:
            words += ["--fdi", str(self.fdi)]
        for option in ("root_length", "tip", "torque", "bend"):
            value = getattr(self, option)
            if value:
                words += ["--root-length" if option == "root_length" else f"--root-{option}", f"{value:g}"]
        if self.skirt != "keep":
            words += ["--skirt", self.skirt]
        return words + (["--repair"] if self.repair else [])


@dataclasses.dataclass
class ArchSettings:
    """Of a scan of a jaw."""

    e: float = 0.5
    label_array: str = ""  # of points; empty: one with a usual name, else teeth are searched for
    jaw: str = ""  # upper, lower; empty: found
    resolve_collisions: bool = False
    root_lengths: Mapping[int, float] = dataclasses.field(default_factory=dict)  # FDI number to mm

    def arguments(self):
        words = ["--e", f"{self.e:g}"]
        if self.label_array:
            words += ["--label-array", self.label_array]
        if self.jaw:
            words += ["--jaw", self.jaw]
        if self.root_lengths:
            words += ["--root-length", *(f"{fdi}={mm:g}" for fdi, mm in sorted(self.root_lengths.items()))]
        return words + (["--resolve-collisions"] if self.resolve_collisions else [])


def run(
    command,
    *,
    environment: Optional[Mapping[str, str]] = None,
    wait: Callable[[], bool] = lambda: True,
    also_good=(),
    hidden: str = "",
) -> int:
    """Runs a command to its end; returns its exit code, 0 or one of `also_good`. `wait` is called some times a second and returns False to
    cancel. `environment`: Slicer's own holds libraries that are not the program's. `hidden`: a folder that is not to be shown. Raises Refused
    with the program's sentence, Cancelled."""
    # A file takes what is said: a pipe that nobody empties would stop the program once it is full.
    with tempfile.TemporaryFile("w+") as said:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=said, env=environment)
        while process.poll() is None:
            if not wait():
                process.terminate()
                process.wait()
                raise Cancelled("Cancelled.")
            time.sleep(0.05)
        if process.returncode and process.returncode not in also_good:
            said.seek(0)
            sentence = said.read().strip().removeprefix("rhizodont: ")
            if hidden:
                sentence = sentence.replace(hidden + os.sep, "")
            raise Refused(sentence or f"The program ended with {process.returncode}.")
        return process.returncode
