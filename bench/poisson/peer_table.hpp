// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace rhizodont {

/// Prints time and accuracy of our, Open3D's and CGAL's Poisson reconstruction of the same 20,000 oriented points of
/// whole validation teeth, without and with noise, at the same depths, and what the figures amount to. All from the
/// call with the points to the triangles, two threads. Open3D is run by /usr/bin/python3.
void print_peer_table(const std::filesystem::path& data);

}  // namespace rhizodont
