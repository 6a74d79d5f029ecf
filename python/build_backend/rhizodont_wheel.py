# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The build backend of `pip install .` (PEP 517): has CMake build the module and packs it, with library and models, into a
wheel (PEP 427) that needs no other file of this tree. Only the standard library is used.

Settings (pip's --config-settings): build-folder=FOLDER takes or makes that build folder in place of one in a temporary
place; cmake=OPTIONS are more options for CMake, such as -DRHIZODONT_WEB=OFF."""

import base64
import hashlib
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import tomllib
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
# The date that all entries of a wheel bear, so that one build gives the same wheel again: the earliest of a zip file.
EARLIEST = (1980, 1, 1, 0, 0, 0)


def get_requires_for_build_wheel(config_settings=None):
    return []


def get_requires_for_build_sdist(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    with tempfile.TemporaryDirectory(prefix="rhizodont-wheel-") as temporary:
        build = pathlib.Path(settings.get("build-folder") or pathlib.Path(temporary) / "build").resolve()
        installed = pathlib.Path(temporary) / "installed"
        _build(build, installed, shlex.split(settings.get("cmake") or ""))
        files = _files_of_package(installed)
        name = f"rhizodont-{_version()}-{_tag()}.whl"
        _write_wheel(pathlib.Path(wheel_directory) / name, files)
        return name


def build_sdist(sdist_directory, config_settings=None):
    top = f"rhizodont-{_version()}"
    name = f"{top}.tar.gz"
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=SOURCE, capture_output=True, text=True)
    if listed.returncode != 0:
        raise SystemExit("A source distribution is made of what git has: this is no clone.")
    with tarfile.open(pathlib.Path(sdist_directory) / name, "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for file in filter(None, listed.stdout.split("\0")):
            if (SOURCE / file).exists():
                archive.add(SOURCE / file, f"{top}/{file}")
        with tempfile.TemporaryDirectory() as folder:
            metadata = pathlib.Path(folder) / "PKG-INFO"
            metadata.write_text(_metadata(), encoding="utf-8")
            archive.add(metadata, f"{top}/PKG-INFO")
    return name


def _build(build, installed, options):
    """Configures a new build folder; one that is there is used as it is, if it has the module."""
    cache = build / "CMakeCache.txt"
    if not cache.exists():
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []
        _run("cmake", "-S", SOURCE, "-B", build, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DRHIZODONT_PYTHON=ON",
             "-DRHIZODONT_TESTS=OFF", "-DRHIZODONT_BENCH=OFF", f"-DPython3_EXECUTABLE={_base_python()}", *options)
    elif "RHIZODONT_PYTHON:BOOL=ON" not in cache.read_text():
        raise SystemExit(f"{build} was configured without the Python module: cmake -DRHIZODONT_PYTHON=ON {build}")
    _run("cmake", "--build", build, "--target", "rhizodont_python", "--parallel", str(os.cpu_count() or 1))
    for component in ("python", "library", "models"):
        _run("cmake", "--install", build, "--prefix", installed, "--component", component, "--strip")


def _base_python():
    """The interpreter itself, not that of pip's environment, which has no headers."""
    return getattr(sys, "_base_executable", None) or sys.executable


def _run(*command):
    # pip shows what goes to standard output where it fails; the names of results are not read from there.
    subprocess.run([str(word) for word in command], check=True, stdout=sys.stderr)


def _files_of_package(installed):
    """{name in the wheel: file}. The package is a prefix of its own: the library looks for share/rhizodont/models beside the
    folder that it is in, and the module for the library in lib/ beside it (python/CMakeLists.txt)."""
    files = {}
    module = next(installed.rglob("rhizodont/__init__.py")).parent
    for file in sorted(module.rglob("*")):
        if file.is_file() and "__pycache__" not in file.parts:
            files[f"rhizodont/{file.relative_to(module).as_posix()}"] = file
    library = [file for file in sorted(installed.rglob("librhizodont.so.*")) if file.is_symlink()]
    if len(library) != 1:
        raise SystemExit("The library was not installed as one file with one short name.")
    files[f"rhizodont/lib/{library[0].name}"] = library[0].resolve()  # a wheel has no links
    models = installed / "share/rhizodont/models"
    for file in sorted(models.iterdir()):
        files[f"rhizodont/share/rhizodont/models/{file.name}"] = file
    return files


def _version():
    text = (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(Rhizodont VERSION ([\d.]+)", text).group(1)


def _tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _metadata():
    project = tomllib.loads((SOURCE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {_version()}",
             f"Summary: {project['description']}", f"Author: {project['authors'][0]['name']}",
             f"License: {project['license']['text']}", f"Keywords: {','.join(project['keywords'])}"]
    lines += [f"Classifier: {classifier}" for classifier in project["classifiers"]]
    lines += [f"Requires-Dist: {dependency}" for dependency in project["dependencies"]]
    lines += [f"Requires-Python: {project['requires-python']}", "Description-Content-Type: text/markdown", "",
              (SOURCE / project["readme"]).read_text(encoding="utf-8")]
    return "\n".join(lines)


def _write_wheel(path, files):
    information = f"rhizodont-{_version()}.dist-info"
    contents = {name: file.read_bytes() for name, file in files.items()}
    contents[f"{information}/METADATA"] = _metadata().encode()
    contents[f"{information}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: rhizodont_wheel\nRoot-Is-Purelib: false\nTag: {_tag()}\n").encode()
    contents[f"{information}/LICENSE"] = (SOURCE / "LICENSE").read_bytes()
    record = f"{information}/RECORD"
    lines = []
    for name, content in contents.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        lines.append(f"{name},sha256={digest},{len(content)}\n")
    contents[record] = ("".join(lines) + f"{record},,\n").encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, content in contents.items():
            entry = zipfile.ZipInfo(name, EARLIEST)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if ".so" in name else 0o644) << 16
            wheel.writestr(entry, content)
