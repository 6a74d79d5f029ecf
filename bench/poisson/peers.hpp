// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "rhizodont/mesh.hpp"

namespace rhizodont {

struct PeerResult {
  TriangleMesh mesh;
  double seconds = 0;
};

/// Rows of six doubles, point and normal; `read_samples` throws InputError for a file that cannot be read.
void write_samples(const std::filesystem::path& file, const OrientedPoints& samples);
OrientedPoints read_samples(const std::filesystem::path& file);

/// Open3D's Poisson reconstruction by bench/poisson/open3d_poisson.py, two threads, the fastest of `runs`.
/// Throws NoResultError if the script fails. Files go to `scratch`.
PeerResult open3d_poisson(const OrientedPoints& samples, int depth, int runs, const std::filesystem::path& scratch);

/// CGAL's Poisson reconstruction on a Delaunay mesh with its own defaults; `spacing`: mean distance of samples (mm).
PeerResult cgal_poisson(const OrientedPoints& samples, double spacing);

}  // namespace rhizodont
