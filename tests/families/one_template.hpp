// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/temporary_folder.hpp"
#include "families/tooth_family.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

namespace rhizodont::test {

inline constexpr int molar = 13;  // the type of tooth 36

inline MeshFile own_template() {
  return load_mesh(std::filesystem::path(RHIZODONT_SOURCE_DIR) / "tests/families/data/tooth_36.ply");
}

// Mean dimensions, all different so that a mistaken column shows.
inline constexpr double crown_height = 7.5, root_length = 14, mesiodistal = 11, buccolingual = 10.5;

/// A folder as `load_tooth_families` reads it: the template at all sixteen places of two arches, upper ones turned
/// over.
class OneTemplate : public ::testing::Test {
 protected:
  TemporaryFolder folder;

  void SetUp() override {
    std::filesystem::create_directory(folder.path() / "templates");
    for (int type = 0; type < tooth_type_count; ++type) write_template(type, own_template());
    write_dimensions(tooth_type_count);
  }

  void write_template(int type, MeshFile file) const {
    const double along = (type % 8 + 0.5) / 8 * std::numbers::pi / 2;  // from the front tooth to the last molar
    const Eigen::Vector3d out(std::sin(along), 0, std::cos(along));
    const Eigen::Vector3d up(0, type < 8 ? -1 : 1, 0);
    Eigen::Matrix3d axes;  // the template's own have +z to the crown and +y to the cheek
    axes << out.cross(up), out, up;
    for (Point& p : file.mesh.vertices)
      p = axes * p + Point(30 * out.x(), 0, 45 * out.z()) + (type < 8 ? 12 : -12) * up;
    save_mesh(path_of(type), file);
  }

  std::filesystem::path path_of(int type) const {
    return folder.path() / "templates" / ("tooth_" + std::to_string(fdi_of_type(type, false)) + ".ply");
  }

  void write_dimensions(int rows) const {
    std::ofstream table(folder.path() / "anatomy.csv");
    table << "tooth,fdi,overall_mm,crown_mm,root_mm,md_crown_mm,md_cervix_mm,bl_crown_mm,bl_cervix_mm\n";
    for (int type = 0; type < rows; ++type)
      table << "a tooth," << fdi_of_type(type, true) << '/' << fdi_of_type(type, false) << ",21.5," << crown_height
            << ",mesial 13 distal " << root_length << ',' << mesiodistal << ",9," << buccolingual << ",9\n";
  }

  ToothFamilies load(const std::filesystem::path& population = {}) const {
    FamilyLoadOptions options;
    options.population = population;
    options.types = {molar};
    options.vertices = 1200;
    return load_tooth_families(folder.path(), options);
  }

  std::string refusal() const {
    try {
      load();
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }
};

}  // namespace rhizodont::test
