# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sphinx's settings. `scripts/documents.sh` copies the repository's Markdown to a folder of its own, so that links between docs/,
models/ and the rest lead where they lead in the repository, and names that folder, the program and the Python module here."""

import os
import pathlib
import re
import sys

from docutils.nodes import SkipNode
from docutils.utils.math.latex2mathml import tex2mathml

SOURCE = pathlib.Path(os.environ["RHIZODONT_SOURCE"])
sys.path[:0] = [str(SOURCE / "docs"), str(SOURCE / "python")]

project = "Rhizodont"
author = "Rhizodont contributors"
copyright = "Rhizodont contributors, GPL-3.0-or-later"
version = release = re.search(r"project\(Rhizodont VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]

root_doc = "docs/index"
extensions = ["myst_parser", "sphinx.ext.autodoc", "breathe"]
exclude_patterns = ["docs/reference/generated"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 4
highlight_language = "text"
# Formulas as MathML, which browsers draw themselves: pages need no network.
html_math_renderer = "mathml"

html_theme = "furo"
html_title = f"Rhizodont {release}"
html_copy_source = False
html_show_sphinx = False

breathe_projects = {"rhizodont": os.environ["RHIZODONT_DOXYGEN"]}
breathe_default_project = "rhizodont"
breathe_default_members = ("members",)

# The module's Python is read without its compiled part, so that pages are built where that is not.
autodoc_mock_imports = ["rhizodont._core"]
autodoc_member_order = "bysource"
autodoc_typehints = "signature"


def without_page(app, env, node, content):
    """A link to a folder or a source file of the repository stays as text: it has no page here."""
    target = (node.get("reftarget") or "").partition("#")[0]
    place = SOURCE / pathlib.Path(node.get("refdoc", env.docname)).parent
    return content if "/" in target and (place / target).exists() else None


def write_formula(writer, node):
    inline = node.tagname == "math"
    formula = tex2mathml(node.astext(), inline=inline)
    writer.body.append(formula if inline else f'<div class="math">{formula}</div>')
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (write_formula, None), (write_formula, None))
    app.connect("missing-reference", without_page)
