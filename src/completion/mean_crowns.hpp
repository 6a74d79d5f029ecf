// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "teeth/fdi.hpp"

#include <array>
#include <filesystem>
#include <vector>

namespace rhizodont {

/// The mean crown of a tooth type and points of its mean whole tooth, both in canonical coordinates (unit 12 mm).
struct MeanCrown {
  OrientedPoints crown;        ///< about 512 points on the crown down to the cemento-enamel junction, normals outward
  std::vector<Point> anchors;  ///< about 512 points spread evenly over the whole mean tooth, crown and root
};

/// Mean crowns of all types, as read from models/atlas.safetensors.
struct Atlas {
  std::array<MeanCrown, tooth_type_count> types;
};

/// Reads mean crowns and anchors. Throws InputError if the file is missing, damaged or lacks a type.
Atlas load_atlas(const std::filesystem::path& file);
/// Writes them as float32 tensors crown_T (n x 3), crown_normals_T (n x 3), anchors_T (m x 3), T = 0..15.
void save_atlas(const Atlas& atlas, const std::filesystem::path& file);

}  // namespace rhizodont
