# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What runs blocks, checks links and makes pages finds what is wrong."""

import os
import pathlib
import sys

import blocks
import pytest

SOURCE = pathlib.Path(os.environ["RHIZODONT_SOURCE"])
BUILD = pathlib.Path(os.environ["RHIZODONT_BUILD"])
sys.path[:0] = [str(SOURCE / "scripts"), str(SOURCE / "docs")]

import check_links  # noqa: E402
import generated_pages  # noqa: E402


def run(tmp_path, text):
    document = tmp_path / "a.md"
    document.write_text(text)
    (tmp_path / "folder").mkdir()
    blocks.Runner(SOURCE, BUILD, tmp_path / "folder").run(document)


def test_blocks_share_a_folder(tmp_path):
    run(tmp_path, "```bash\necho 12 teeth > x; cat x\n```\n\n```text\n14 teeth\n```\n\n```console\nexit 1\n```\n\n```bash\ntest -s x\n```\n")


@pytest.mark.parametrize(
    "text, said",
    [
        ("# A\n\n```bash\nfalse\ntrue\n```\n", "a.md:4 ended with 1"),
        ("```bash\nfalse | true\n```\n", "ended with 1"),
        ("```bash\necho 12 crowns\n```\n\n```text\n12 teeth\n```\n", "not said: 12 teeth"),
        ("```cpp\nint f() { return g(); }\n```\n", "g"),
        ("```cpp\nint main() { return 3; }\n```\n", "ended with 3"),
    ],
)
def test_what_a_block_does_wrong_is_said(tmp_path, text, said):
    with pytest.raises(AssertionError, match=said):
        run(tmp_path, text)


def test_dead_links_are_found(tmp_path, monkeypatch):
    monkeypatch.setattr(check_links, "ROOT", tmp_path)
    (tmp_path / "b.md").write_text("# One *thing*, two\n\n## Same\n\n## Same\n")
    (tmp_path / "a.md").write_text(
        "# A\n[good](b.md) [good](b.md#one-thing-two) [good](b.md#same-1) [good](#a) [outside](https://example.org/x)\n"
        "![picture](none.png) [no heading](b.md#three) [above](../x.md)\n\n```text\n[code](none.md)\n```\n"
    )
    (tmp_path.parent / "x.md").write_text("")
    found = list(check_links.dead_links(tmp_path / "a.md"))
    assert found == ["none.png: no such file", "b.md#three: no such heading", "../x.md: outside of the repository"]


def test_pages_hold_what_the_schemas_and_the_program_say():
    report = generated_pages.schema_page(SOURCE / "docs/report.schema.json")
    assert "| `root.length_mm` | number |" in report and "| `input.sha256` | string or null | of the file's bytes" in report
    assert "| `teeth[].refusal` |" in generated_pages.schema_page(SOURCE / "docs/arch_report.schema.json")
    commands = generated_pages.commands_page([BUILD / "apps/rhizodont/rhizodont"])
    assert "## `rhizodont batch status`" in commands and "--root-length" in commands
