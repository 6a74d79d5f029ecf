# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The blocks of tutorial, how-tos and other documents with code run as they stand, and come to what they say."""

import json
import os
import pathlib
import re
import subprocess

import blocks
import pytest

SOURCE = pathlib.Path(os.environ["RHIZODONT_SOURCE"])
BUILD = pathlib.Path(os.environ["RHIZODONT_BUILD"])
DOCS = SOURCE / "docs"
HOW_TOS = sorted((DOCS / "how_to").glob("*.md"))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A function that runs a document's blocks in an empty folder, once, and gives the folder."""
    folders = {}

    def run_document(document):
        if document not in folders:
            folders[document] = tmp_path_factory.mktemp(document.stem)
            try:
                blocks.Runner(SOURCE, BUILD, folders[document]).run(document)
            except blocks.NotBuilt as missing:
                pytest.skip(f"{document.name} needs {missing}")
        return folders[document]

    return run_document


@pytest.mark.parametrize(
    "document", [DOCS / "tutorial.md", *HOW_TOS, DOCS / "python.md", DOCS / "reference/cpp.md"], ids=lambda d: d.stem
)
def test_blocks_run(run, document):
    run(document)


def proved(crown, tooth):
    program = BUILD / "apps/rhizodont/rhizodont"
    return subprocess.run([program, "check", crown, tooth], capture_output=True).returncode == 0


# Three tasks that a reader who knows nothing of the project does with the blocks of one document alone.
def test_a_folder_is_completed(run):
    folder = run(DOCS / "how_to/folder.md")
    for crown in sorted((folder / "crowns").iterdir()):
        assert proved(crown, folder / "teeth" / f"{crown.stem}_tooth.ply"), crown


def test_a_length_is_pinned(run):
    folder = run(DOCS / "how_to/measured_lengths.md")
    report = json.loads((folder / "pinned_36.json").read_text())
    assert report["root"]["length_mm"] == pytest.approx(14.2, abs=0.3)
    assert proved(SOURCE / "samples/crown_36.stl", folder / "pinned_36.ply")


def test_a_network_is_trained(run):
    folder = run(DOCS / "how_to/train.md")
    header = (folder / "own/completion.safetensors").read_bytes()[:20000]
    assert b"validation.root_chamfer_l1_mm" in header
    assert (folder / "own/completion.safetensors").read_bytes() != (SOURCE / "models/completion.safetensors").read_bytes()
    assert proved(SOURCE / "samples/crown_36.stl", folder / "tooth_36.ply")


def test_errors_of_the_module_are_said(run):
    assert (run(DOCS / "python.md") / "tooth_36.ply").stat().st_size > 100_000


def rows_of(document, heading):
    """Cells of the first table below a heading."""
    part = document.read_text().split(heading, 1)[1]
    lines = re.search(r"(?:^\|.*\n)+", part, re.M)[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_exit_codes_are_those_of_the_library():
    header = (SOURCE / "include/rhizodont/error.hpp").read_text()
    values = set(re.findall(r"^  \w+ = (\d),", header, re.M))
    rows = rows_of(DOCS / "reference/exit_codes.md", "# Exit codes")
    assert {row[0] for row in rows} == values | {"0"}
    for name in (row[1].strip("`") for row in rows if row[1]):
        assert f"class RHIZODONT_EXPORT {name} : public Error" in header, name


def properties_of(file):
    head = file.read_bytes().split(b"end_header")[0].decode().split("element face")[0]
    return {name: kind for kind, name in re.findall(r"property (\w+) (\w+)", head)}


def test_attributes_are_as_documented(run):
    jaw = run(DOCS / "tutorial.md") / "jaw"
    documented = {
        name.strip("` "): kind
        for row in rows_of(DOCS / "reference/formats.md", "## Attributes of vertices")
        for name, kind in zip(row[0].split(","), row[1].split(", ") * 3)
    }
    for file in ("tooth_36.ply", "arch.ply", "crown_36.ply"):
        written = {name: kind for name, kind in properties_of(jaw / file).items() if name not in "xyz"}
        assert written and written.items() <= documented.items(), file


def commands_in(document):
    """(command, its options) of each line of code that calls the program, runnable or not."""
    text = document.read_text()
    code = [m[2] for m in blocks.FENCE.finditer(text) if m[1] in ("bash", "console")]
    code += re.findall(r"(?m)^ {4}(rhizodont.*)$", text)
    for line in "\n".join(code).replace("\\\n", " ").splitlines():
        for call in re.finditer(r"(?:^|[\s(&|;]|/)(rhizodont(?:-train)?) ((?:[a-z][a-z-]*) ?(?:status)?)([^#|&;]*)", line):
            yield call[1], call[2].split(), re.findall(r"(?<![\w-])--[a-z][a-z-]*", call[3])


def all_documents():
    listed = [SOURCE / "README.md", *DOCS.glob("**/*.md"), SOURCE / "scripts/slurm/README.md"]
    return [d for d in listed if any(True for _ in commands_in(d))]


@pytest.fixture(scope="module")
def help_of():
    texts = {}

    def ask(program, command):
        key = (program, *command)
        if key not in texts:
            built = BUILD / "apps" / program / program
            if not built.exists():
                pytest.skip(f"{program} was not built")
            texts[key] = subprocess.run([built, *command, "--help"], capture_output=True, text=True)
        return texts[key]

    return ask


@pytest.mark.parametrize("document", all_documents(), ids=lambda d: str(d.relative_to(SOURCE)))
def test_options_that_documents_name_exist(document, help_of):
    for program, command, options in commands_in(document):
        asked = help_of(program, command)
        assert asked.returncode == 0, f"{document.name}: there is no {program} {' '.join(command)}"
        known = set(re.findall(r"--[a-z][a-z-]*", asked.stdout))
        assert set(options) <= known, f"{document.name}: {program} {' '.join(command)} has not {set(options) - known}"
