# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results that show themselves in Jupyter: what a cell puts into a page, and that a browser draws it."""

import html
import os
import pathlib
import re
import struct
import subprocess
import zlib

import numpy as np
import pytest

import rhizodont

SOURCE = pathlib.Path(os.environ["RHIZODONT_SOURCE"])
CHROMIUM = os.environ.get("RHIZODONT_CHROMIUM", "")
CROWN = SOURCE / "samples" / "crown_36.stl"

pytestmark = pytest.mark.skipif(
    not rhizodont._core.has_report_pages(), reason="the library was built without its pages"
)


@pytest.fixture(scope="module")
def tooth(models):
    return rhizodont.complete(CROWN, models, fdi=36, e=1.5)


@pytest.fixture(scope="module")
def arch(tooth, models):
    crown = tooth.crown
    apart = np.array([13.0, 0, 0])
    scan = rhizodont.Mesh(
        np.vstack([crown.vertices, crown.vertices + apart]),
        np.vstack([crown.triangles, crown.triangles + len(crown.vertices)]).astype(np.int32),
    )
    labels = [36] * len(crown.vertices) + [37] * len(crown.vertices)
    return rhizodont.complete_arch(scan, models, labels, e=1.5)


def page_in(shown):
    frame = re.fullmatch(r'<iframe srcdoc="([^"]*)" sandbox="([^"]*)" style="[^"]*" title="Rhizodont"></iframe>', shown)
    assert frame and "allow-same-origin" not in frame.group(2)
    return html.unescape(frame.group(1))


def test_a_frame_holds_the_whole_page(tooth, arch):
    for result in (tooth, arch):
        page = page_in(result._repr_html_())
        assert page == result.page()
        assert not re.search(r'(?:src|href)="(?:https?:)?//', page)
        assert '"views": {"' in page
    assert '"tooth-37": "' in arch.page()


def test_a_tooth_outlives_its_arch(models, arch):
    crown = arch[36].crown
    tooth = rhizodont.complete_arch(crown, models, [36] * len(crown.vertices), e=2)[36].tooth
    assert tooth.check(tooth.crown)["holds"]
    assert tooth.page().startswith("<!doctype html>") or tooth.page().startswith("<!DOCTYPE html>")


def pixels(png):
    """Rows x columns x 3 of a PNG of 8 bits without interlacing (ISO 15948)."""
    data, at, packed = png.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8 : at + 18])
            assert depth == 8 and colour in (2, 6)
        if kind == b"IDAT":
            packed += data[at + 8 : at + 8 + size]
        at += size + 12
    channels = 3 if colour == 2 else 4
    raw = np.frombuffer(zlib.decompress(packed), dtype=np.uint8).reshape(height, 1 + width * channels)
    image = np.zeros((height, width * channels), dtype=np.uint8)
    for row in range(height):
        kind, line = raw[row, 0], raw[row, 1:].astype(np.int32)
        above = image[row - 1].astype(np.int32) if row else np.zeros_like(line)
        for x in range(len(line)) if kind in (1, 3, 4) else ():
            left = line[x - channels] if x >= channels else 0
            corner = above[x - channels] if x >= channels else 0
            if kind == 1:
                line[x] = (line[x] + left) & 255
            elif kind == 3:
                line[x] = (line[x] + (left + above[x]) // 2) & 255
            else:
                guess = left + above[x] - corner
                near = min((abs(guess - left), 0, left), (abs(guess - above[x]), 1, above[x]), (abs(guess - corner), 2, corner))
                line[x] = (line[x] + near[2]) & 255
        image[row] = ((line + above) & 255) if kind == 2 else line
    return image.reshape(height, width, channels)[:, :, :3]


@pytest.mark.skipif(not CHROMIUM, reason="there is no Chromium")
@pytest.mark.parametrize("name", ["tooth", "arch"])
def test_a_browser_draws_it(name, request, tmp_path):
    result = request.getfixturevalue(name)
    notebook = tmp_path / "notebook.html"
    notebook.write_text(f"<!doctype html><meta charset=utf-8><body style='margin:0'>{result._repr_html_()}", encoding="utf-8")
    pictures = pathlib.Path(os.environ.get("RHIZODONT_PICTURES", tmp_path))
    picture = pictures / f"notebook_{name}.png"
    subprocess.run(
        [CHROMIUM, "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--disable-dev-shm-usage", f"--user-data-dir={tmp_path / 'profile'}", "--window-size=1100,640", "--hide-scrollbars",
         "--virtual-time-budget=20000", f"--screenshot={picture}", notebook.as_uri()],
        check=True, capture_output=True, timeout=300,
    )
    image = pixels(picture)
    assert image.shape[1] == 1100
    # shaded surfaces have many colours; the crown is of a yellowish white, the root blue (web/src/colours.ts)
    view = image[170:520, :770].reshape(-1, 3).astype(int)
    assert len(np.unique(view, axis=0)) > 1000
    red, green, blue = view.T
    assert np.count_nonzero((red > green) & (green > blue + 20)) > 2000
    assert np.count_nonzero((blue > green + 20) & (green > red + 20)) > 4000
