#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`pip install` of this tree into a new environment, from a finished build: wheel.py SOURCE BUILD. The module must then
work by itself: its own library, its own models, the bytes that the program writes."""

import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile
import zipfile

SOURCE, BUILD = (pathlib.Path(word).resolve() for word in sys.argv[1:])

USE = """
import pathlib, sys
import rhizodont
package = pathlib.Path(rhizodont.__file__).parent
assert package.is_relative_to(sys.prefix), package
models = rhizodont.Models()
assert pathlib.Path(models.folder).is_relative_to(package), models.folder
maps = pathlib.Path("/proc/self/maps").read_text()
loaded = {line.split()[-1] for line in maps.splitlines() if "librhizodont" in line}
assert loaded == {str(package / "lib" / "librhizodont.so.0")}, loaded
tooth = rhizodont.complete(sys.argv[1], models, fdi=11, e=1)
tooth.save(sys.argv[2])
print(rhizodont.__version__)
"""


def run(*words, **more):
    return subprocess.run([str(word) for word in words], check=True, text=True, **more)


def main():
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "RHIZODONT_MODELS")}
    with tempfile.TemporaryDirectory(prefix="rhizodont-wheel-test-") as name:
        folder = pathlib.Path(name)
        wheels = folder / "wheels"
        # Isolated as pip does it by default: nothing is fetched, for nothing is required.
        pip = ["-m", "pip", "--disable-pip-version-check", "--no-cache-dir"]
        run(sys.executable, *pip, "wheel", "--no-index", "--no-deps", "--config-settings", f"build-folder={BUILD}", "-w", wheels, SOURCE,
            env=environment)
        wheel, = wheels.iterdir()
        with zipfile.ZipFile(wheel) as archive:
            names = archive.namelist()
            assert archive.testzip() is None
        for needed in ("rhizodont/__init__.py", "rhizodont/py.typed", "rhizodont/lib/librhizodont.so.0",
                       "rhizodont/share/rhizodont/models/completion.safetensors"):
            assert needed in names, needed
        assert not [n for n in names if n.startswith("/") or ".." in n], names

        # numpy is Debian's
        run(sys.executable, "-m", "venv", "--system-site-packages", folder / "venv", env=environment)
        python = folder / "venv/bin/python"
        run(python, *pip, "install", "--no-index", "--no-build-isolation", "--config-settings", f"build-folder={BUILD}", SOURCE, env=environment)
        crown = SOURCE / "samples/crown_11.stl"
        used = run(python, "-c", USE, crown, folder / "module.ply", env=environment, cwd=folder, capture_output=True)
        program = BUILD / "apps/rhizodont/rhizodont"
        run(program, "complete", crown, "--fdi", "11", "--e", "1", "-o", folder / "program.ply", "--quiet")
        assert (folder / "module.ply").read_bytes() == (folder / "program.ply").read_bytes()
        again = folder / "again"
        run(sys.executable, *pip, "wheel", "--no-index", "--no-deps", "--no-build-isolation", "--config-settings", f"build-folder={BUILD}",
            "-w", again, SOURCE, env=environment)
        hashes = {hashlib.sha256(file.read_bytes()).hexdigest() for file in (wheel, again / wheel.name)}
        assert len(hashes) == 1, "two wheels of one build differ"
        run(python, *pip, "uninstall", "-y", "rhizodont", env=environment)
        left = list((folder / "venv").rglob("rhizodont*"))
        assert not left, left
        print(f"{wheel.name}, {wheel.stat().st_size / 1e6:.1f} MB: rhizodont {used.stdout.strip()} works by itself")


if __name__ == "__main__":
    main()
