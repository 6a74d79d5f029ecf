# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the module for 3D Slicer does, without its window: files and frames (polydata), the program (program), nodes (logic)."""
