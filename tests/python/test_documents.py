# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python blocks of docs/python.md run, one after the other, as they stand there."""

import os
import pathlib
import re

SOURCE = pathlib.Path(os.environ["RHIZODONT_SOURCE"])


def test_blocks_of_the_document_run(tmp_path, monkeypatch, capsys):
    (tmp_path / "samples").symlink_to(SOURCE / "samples")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```", (SOURCE / "docs" / "python.md").read_text(), re.S | re.M)
    assert len(blocks) == 5
    names = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    assert (tmp_path / "tooth_36.ply").stat().st_size > 100_000
    assert "e = 9 mm is out of its range, 0.2 to 2 mm." in capsys.readouterr().out
