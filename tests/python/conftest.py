# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What all tests of the module share."""

import os
import pathlib

import pytest

import rhizodont


@pytest.fixture(scope="session")
def models():
    return rhizodont.Models(pathlib.Path(os.environ["RHIZODONT_SOURCE"]) / "models")
