# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The blocks of a document, run as they stand there, one after the other, in one folder.

    ```bash     a script; it must end with 0
    ```python   run in one interpreter, names carried over from block to block
    ```cpp      compiled against the public headers and the sources; linked and run where it has a main
    ```text     what the block before says: each line is looked for in its output, numbers left open
    ```console  shown alone: what waits, installs, or needs a cluster or hours (its options are looked up, though)
"""

import contextlib
import dataclasses
import io
import os
import pathlib
import re
import subprocess
import sys

FENCE = re.compile(r"^```(\w+)\n(.*?)^```", re.S | re.M)


@dataclasses.dataclass
class Block:
    language: str
    text: str
    line: int


class NotBuilt(Exception):
    """What a block needs was not built."""


def blocks_of(document):
    text = document.read_text()
    return [Block(m[1], m[2], text.count("\n", 0, m.start()) + 2) for m in FENCE.finditer(text)]


@dataclasses.dataclass
class Runner:
    """Runs blocks in `folder`, where the repository's `samples`, `tests`... are at hand."""

    source: pathlib.Path
    build: pathlib.Path
    folder: pathlib.Path

    def __post_init__(self):
        self.names = {"__name__": "document"}
        self.output = None
        for name in ("samples", "scripts", "tests", "docs", "models"):
            (self.folder / name).symlink_to(self.source / name)
        bin_folder = self.folder / ".bin"
        bin_folder.mkdir()
        for program in ("rhizodont", "rhizodont-train"):
            built = self.build / "apps" / program / program
            if built.exists():
                (bin_folder / program).symlink_to(built)
        self.environment = {
            **os.environ,
            "PATH": f"{bin_folder}:{os.environ['PATH']}",
            "RHIZODONT_MODELS": str(self.source / "models"),
            "PYTHONPATH": str(self.build / "python"),
        }

    def run(self, document):
        """Runs all blocks of a document. AssertionError names the document and the line of a block that fails."""
        for block in blocks_of(document):
            where = f"{document.name}:{block.line}"
            if block.language in ("bash", "python", "cpp"):
                self.output = getattr(self, "run_" + block.language)(block.text, where)
            elif block.language == "text" and self.output is not None:
                self.compare(block.text, where)

    def run_bash(self, text, where):
        if "rhizodont-train" in text and not (self.folder / ".bin" / "rhizodont-train").exists():
            raise NotBuilt("rhizodont-train (-DRHIZODONT_TRAINING=ON)")
        return self.process(["bash", "-euo", "pipefail", "-c", text], where)

    def run_python(self, text, where):
        if not (self.build / "python" / "rhizodont").is_dir():
            raise NotBuilt("the Python module (-DRHIZODONT_PYTHON=ON)")
        if str(self.build / "python") not in sys.path:
            sys.path.insert(0, str(self.build / "python"))
        os.environ["RHIZODONT_MODELS"] = self.environment["RHIZODONT_MODELS"]
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.chdir(self.folder):
            exec(compile(text, where, "exec"), self.names)
        return said.getvalue()

    def run_cpp(self, text, where):
        unit = self.folder / "block.cpp"
        unit.write_text(text)
        includes = [f"-I{self.source / 'include'}", f"-I{self.build / 'include'}", f"-I{self.source / 'src'}", "-isystem/usr/include/eigen3"]
        compiler = ["c++", "-std=c++20", "-Wall", "-Wextra", "-Werror", *includes, str(unit)]
        if "int main(" not in text:
            return self.process([*compiler, "-fsyntax-only", "-Wno-unused-function"], where)
        self.process([*compiler, "-o", "block", f"-L{self.build}", "-lrhizodont", f"-Wl,-rpath,{self.build}"], where)
        return self.process(["./block"], where)

    def process(self, command, where):
        done = subprocess.run(command, cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=900)
        said = done.stdout + done.stderr
        assert done.returncode == 0, f"{where} ended with {done.returncode}:\n{said}"
        return said

    def compare(self, text, where):
        said = {without_numbers(line) for line in self.output.splitlines()}
        for line in text.splitlines():
            assert without_numbers(line) in said, f"{where}: not said: {line}\nbut:\n{self.output}"


def without_numbers(line):
    return re.sub(r"\d+(\.\d+)?", "#", line.strip())
