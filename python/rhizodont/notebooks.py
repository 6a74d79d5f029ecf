# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How results show themselves in Jupyter."""

from __future__ import annotations

import html

HEIGHT = 560
"""Pixels."""


def in_frame(page: str) -> str:
    """A page as part of another: its scripts run in a frame of their own, which reaches neither the notebook nor the net."""
    return (
        f'<iframe srcdoc="{html.escape(page)}" sandbox="allow-scripts allow-downloads" '
        f'style="width: 100%; height: {HEIGHT}px; border: 0" title="Rhizodont"></iframe>'
    )
