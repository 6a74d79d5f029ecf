# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on in Blender without a window, where Blender is installed."""

import os
import pathlib
import shutil
import subprocess

import pytest


def test_the_addon_in_blender(tmp_path):
    blender = shutil.which("blender")
    if blender is None:
        pytest.skip("Blender is not installed (scripts/install_dependencies.sh integrations)")
    source = pathlib.Path(os.environ["RHIZODONT_SOURCE"])
    script = source / "tests/integrations/in_blender.py"
    command = [blender, "--background", "--factory-startup", "--python-exit-code", "1", "--python", script, "--", source, tmp_path]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "The add-on does what it says." in done.stdout
