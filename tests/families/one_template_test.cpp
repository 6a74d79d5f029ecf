// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The families on the one template that is kept beside this file, so that they are tested wherever the project is.
#include "families/one_template.hpp"
#include "base/random_stream.hpp"
#include "common/temporary_folder.hpp"
#include "families/crown_crop.hpp"
#include "families/tooth_family.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

namespace rhizodont {
namespace {

using test::crown_height, test::mesiodistal, test::buccolingual;
using test::molar, test::own_template, test::OneTemplate;

TEST_F(OneTemplate, IsFoundToHaveTwoRootsAndAnUprightAxis) {
  const ToothFamilies families = load();
  const FamilyTemplate& tooth = families.templates[molar];
  EXPECT_TRUE(diagnose(tooth.mesh).is_closed_solid());
  EXPECT_EQ(diagnose(tooth.mesh).euler_number, 2);
  EXPECT_NEAR(static_cast<double>(tooth.mesh.vertices.size()), 1200, 2);
  ASSERT_EQ(tooth.roots.size(), 2U);
  for (const TemplateRoot& root : tooth.roots) EXPECT_LT(tooth.mesh.vertices[root.apex].z(), root.branch_z - 1);
  EXPECT_LT(tooth.furcation_z, -2);
  EXPECT_GT(tooth.furcation_z, -8);
  // Where the arch has put it does not show: the frame is the tooth's own.
  const Eigen::AlignedBox3d before = bounding_box(own_template().mesh.vertices),
                            after = bounding_box(tooth.mesh.vertices);
  EXPECT_LT((before.sizes() - after.sizes()).cwiseAbs().maxCoeff(), 1.0);
  EXPECT_NEAR(tooth.crown_height, after.max().z(), 1e-9);
  EXPECT_NEAR(tooth.root_length, -after.min().z(), 1e-9);
  EXPECT_TRUE(families.crown_models.empty());
  EXPECT_TRUE(families.loans.empty()) << "no neighbour was loaded";
}

TEST_F(OneTemplate, CrownsAreOfTheTableAndRootsOfThePopulation) {
  const ToothFamilies families = load();
  for (std::size_t type = 0; type < families.dimensions.size(); ++type) {
    const ToothDimensions& d = families.dimensions[type];
    EXPECT_EQ(d.crown_height, crown_height);
    EXPECT_EQ(d.root_length, default_population().teeth[type].root_length_mm);
    EXPECT_EQ(d.crown_mesiodistal, mesiodistal);
    EXPECT_EQ(d.crown_buccolingual, buccolingual);
  }
}

TEST_F(OneTemplate, AnotherPopulationHasItsOwnRoots) {
  const std::filesystem::path table = folder.path() / "people.json";
  std::ofstream(table) << R"({"format": "rhizodont population 1", "name": "long roots",
                             "teeth": {"36": {"root_length_mm": 18.5}}})";
  const ToothFamilies families = load(table);
  EXPECT_EQ(families.population.name, "long roots");
  EXPECT_EQ(families.dimensions[molar].root_length, 18.5);
  EXPECT_EQ(families.dimensions[molar + 1].root_length, default_population().teeth[molar + 1].root_length_mm);
  EXPECT_NEAR(mean_tooth(families, molar).root_length, 18.5, 0.05 * 18.5);
}

TEST_F(OneTemplate, TheMeanToothHasTheMeanDimensions) {
  const SyntheticTooth tooth = mean_tooth(load(), molar);
  Eigen::AlignedBox3d enamel;
  for (std::size_t v = 0; v < tooth.crown.size(); ++v)
    if (tooth.crown[v] == 1) enamel.extend(tooth.mesh.vertices[v]);
  EXPECT_NEAR(tooth.crown_height, crown_height, 0.05 * crown_height);
  const double root_length = default_population().teeth[molar].root_length_mm;
  EXPECT_NEAR(tooth.root_length, root_length, 0.05 * root_length);
  EXPECT_NEAR(enamel.sizes().x(), mesiodistal, 0.05 * mesiodistal);
  EXPECT_NEAR(enamel.sizes().y(), buccolingual, 0.05 * buccolingual);
}

TEST_F(OneTemplate, GrowsSoundTeethThatDifferAndRepeat) {
  const ToothFamilies families = load();
  std::vector<std::vector<Point>> seen;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    const SyntheticTooth tooth = generate_tooth(families, molar, seed);
    EXPECT_TRUE(diagnose(tooth.mesh).is_closed_solid());
    EXPECT_EQ(diagnose(tooth.mesh).euler_number, 2);
    EXPECT_TRUE(self_intersecting_triangles(tooth.mesh).empty());
    EXPECT_EQ(tooth.apices.size(), 2U);
    EXPECT_DOUBLE_EQ(tooth.root_length, -bounding_box(tooth.mesh.vertices).min().z());
    EXPECT_EQ(generate_tooth(families, molar, seed).mesh.vertices, tooth.mesh.vertices);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), tooth.mesh.vertices), 0);
    seen.push_back(tooth.mesh.vertices);
    RandomStream random(seed);
    const Diagnosis crop = diagnose(draw_cropped_crown(tooth, 0.3, 0.5, random).mesh);
    EXPECT_TRUE(crop.is_oriented_manifold());
    EXPECT_EQ(crop.border_loop_count, 1);
    EXPECT_EQ(crop.euler_number, 1);
  }
}

TEST_F(OneTemplate, WhatWasNotLoadedOrIsNoTypeIsRefused) {
  const ToothFamilies families = load();
  EXPECT_THROW(generate_tooth(families, 12, 1), UsageError);
  EXPECT_THROW(generate_tooth(families, tooth_type_count, 1), UsageError);
  EXPECT_THROW(generate_tooth(families, -1, 1), UsageError);
}

TEST_F(OneTemplate, DamagedFoldersAreRefusedWithTheReason) {
  write_dimensions(tooth_type_count - 1);
  EXPECT_NE(refusal().find("one row for each of the 16 teeth"), std::string::npos) << refusal();
  write_dimensions(tooth_type_count);
  MeshFile open = own_template();
  open.mesh.triangles.resize(open.mesh.triangles.size() / 2);
  write_template(molar, open);
  EXPECT_NE(refusal(), "nothing was refused");
  std::filesystem::remove(path_of(molar));
  EXPECT_NE(refusal().find("tooth_36.ply"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace rhizodont
