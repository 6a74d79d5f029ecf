// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// On the template teeth; skipped where these are missing.
#include "base/random_stream.hpp"
#include "completion/registration.hpp"
#include "families/crown_crop.hpp"
#include "families/mean_teeth.hpp"
#include "families/person.hpp"
#include "families/statistics.hpp"
#include "families/template_families.hpp"
#include "families/tooth_family.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

namespace rhizodont {
namespace {

using test::correlation, test::shared_data;

class Families : public test::TemplateFamilies {};

void expect_roots_of_type(const ToothFamilies& families) {
  const std::array<std::size_t, tooth_type_count> roots{1, 1, 1, 2, 1, 3, 3, 3, 1, 1, 1, 1, 1, 2, 2, 2};
  for (std::size_t type = 0; type < roots.size(); ++type) {
    const FamilyTemplate& tooth = families.templates[type];
    EXPECT_EQ(tooth.roots.size(), roots[type]) << "type " << type;
    EXPECT_TRUE(diagnose(tooth.mesh).is_closed_solid()) << "type " << type;
    for (const TemplateRoot& root : tooth.roots) {
      const double tip = tooth.mesh.vertices[root.apex].z();
      EXPECT_LT(tip, root.branch_z - 1.0);
      EXPECT_LT(tip, -7.0);
    }
    if (roots[type] > 1) {
      EXPECT_LT(tooth.furcation_z, -2.0);
      EXPECT_GT(tooth.furcation_z, -8.0);
    }
    // The junction is level on the whole: z is the axis.
    double sum = 0;
    for (int i = 0; i < 360; ++i) {
      const double a = i * std::acos(-1.0) / 180;
      sum += tooth.junction(99 * std::cos(a), 99 * std::sin(a)) / 360;
    }
    EXPECT_NEAR(sum, 0, 0.4) << "type " << type;
  }
}

TEST_F(Families, teethOfOnePersonGoTogether) {
  const ToothFamilies& families = all_families();
  ToothVariation plain;  // nothing that shortens roots at random
  plain.open_apex_share = plain.resorption_share = plain.deciduous_share = plain.blunt_share = 0;
  constexpr std::size_t people = 60;
  std::vector<double> of_21(people), of_11(people), of_31(people), width_21(people), width_11(people);
  tbb::parallel_for(std::size_t{0}, people, [&](std::size_t i) {
    const PersonDraw person = draw_person(i);
    const auto width = [](const SyntheticTooth& t) { return bounding_box(t.mesh.vertices).sizes().x(); };
    const SyntheticTooth left = generate_tooth_of_person(families, 21, person, plain),
                         right = generate_tooth_of_person(families, 11, person, plain);
    of_21[i] = left.root_length, of_11[i] = right.root_length;
    width_21[i] = width(left), width_11[i] = width(right);
    of_31[i] = generate_tooth_of_person(families, 31, person, plain).root_length;
  });
  EXPECT_GT(correlation(of_21, of_11), 0.75);
  EXPECT_LT(correlation(of_21, of_11), 0.97);
  EXPECT_GT(correlation(of_21, of_31), 0.1);
  EXPECT_LT(correlation(of_21, of_31), 0.7);
  EXPECT_GT(correlation(width_21, width_11), 0.8);
}

TEST_F(Families, sharesOfAPersonMustAddUp) {
  PersonVariation persons;
  persons.size = {0.7, 0.4};
  EXPECT_THROW(generate_tooth_of_person(all_families(), 21, draw_person(1), {}, persons), UsageError);
}

TEST_F(Families, sameSeedSameToothOnAnyThread) {
  const ToothFamilies& families = all_families();
  constexpr std::array<int, 8> types{0, 3, 4, 13, 0, 3, 4, 13};
  std::array<SyntheticTooth, 8> first, again;
  tbb::parallel_for(0, 8, [&](int i) {
    first[static_cast<std::size_t>(i)] =
        generate_tooth(families, types[static_cast<std::size_t>(i)], 77 + static_cast<std::uint64_t>(i));
  });
  for (int i = 7; i >= 0; --i)
    again[static_cast<std::size_t>(i)] =
        generate_tooth(families, types[static_cast<std::size_t>(i)], 77 + static_cast<std::uint64_t>(i));
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(first[i].mesh.vertices, again[i].mesh.vertices);
    EXPECT_EQ(first[i].mesh.triangles, again[i].mesh.triangles);
    EXPECT_EQ(first[i].crown_turn, again[i].crown_turn);
  }
  EXPECT_NE(generate_tooth(families, 0, 1).mesh.vertices, generate_tooth(families, 0, 2).mesh.vertices);
}

void expect_solids(const ToothFamilies& families) {
  tbb::parallel_for(0, tooth_type_count, [&](int type) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const Diagnosis diagnosis = diagnose(generate_tooth(families, type, seed).mesh);
      EXPECT_TRUE(diagnosis.is_closed_solid()) << "type " << type << " seed " << seed;
    }
  });
}

void expect_no_self_intersections(const ToothFamilies& families) {
  tbb::parallel_for(0, tooth_type_count, [&](int type) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const SyntheticTooth tooth = generate_tooth(families, type, 500 + seed);
      EXPECT_TRUE(self_intersecting_triangles(tooth.mesh).empty()) << "type " << type << " seed " << seed;
    }
  });
}

TEST_F(Families, dimensionsSpreadAroundThePopulationsMeans) {
  const ToothFamilies& families = all_families();
  for (const int type : {0, 5, 11, 13}) {
    const ToothDimensions& mean = families.dimensions[static_cast<std::size_t>(type)];
    constexpr int count = 100;
    std::vector<double> root(count), width(count);
    tbb::parallel_for(0, count, [&](int i) {
      const SyntheticTooth tooth = generate_tooth(families, type, 1000 + static_cast<std::uint64_t>(i));
      Eigen::AlignedBox3d enamel;
      for (std::size_t v = 0; v < tooth.crown.size(); ++v)
        if (tooth.crown[v] == 1) enamel.extend(tooth.mesh.vertices[v]);
      root[static_cast<std::size_t>(i)] = tooth.root_length;
      width[static_cast<std::size_t>(i)] = enamel.sizes().x();
    });
    const auto mean_and_deviation = [](const std::vector<double>& values) {
      const double m = std::accumulate(values.begin(), values.end(), 0.0) / count;
      double s = 0;
      for (double v : values) s += (v - m) * (v - m);
      return std::pair(m, std::sqrt(s / count));
    };
    const auto [root_mean, root_deviation] = mean_and_deviation(root);
    const auto [width_mean, width_deviation] = mean_and_deviation(width);
    EXPECT_NEAR(root_mean, mean.root_length, 1.0) << "type " << type;
    EXPECT_GT(root_deviation, 1.1) << "type " << type;
    EXPECT_LT(root_deviation, 2.1) << "type " << type;
    EXPECT_NEAR(width_mean, mean.crown_mesiodistal, 0.06 * mean.crown_mesiodistal) << "type " << type;
    EXPECT_GT(width_deviation, 0.05 * width_mean) << "type " << type;
    EXPECT_LT(width_deviation, 0.12 * width_mean) << "type " << type;
  }
}

TEST_F(Families, whatIsKnownAboutAToothHolds) {
  const ToothFamilies& families = all_families();
  for (const int type : {2, 6, 14}) {
    const SyntheticTooth tooth = generate_tooth(families, type, 9);
    const Eigen::AlignedBox3d box = bounding_box(tooth.mesh.vertices);
    EXPECT_DOUBLE_EQ(tooth.root_length, -box.min().z());
    EXPECT_DOUBLE_EQ(tooth.crown_height, box.max().z());
    double lowest = 0;
    for (const Point& apex : tooth.apices) lowest = std::min(lowest, apex.z());
    EXPECT_DOUBLE_EQ(lowest, box.min().z());
    for (const Point& apex : tooth.apices) EXPECT_LT(apex.z(), tooth.furcation_z);
    // Enamel lies over the junction, cementum under it, but for the simplified border and the waves.
    int wrong = 0;
    for (std::size_t v = 0; v < tooth.crown.size(); ++v) {
      const Point& p = tooth.mesh.vertices[v];
      const double over = p.z() - tooth.junction(p.x(), p.y());
      if (tooth.crown[v] == 1 ? over < -1.0 : over > 1.0) ++wrong;
    }
    EXPECT_LT(wrong, static_cast<int>(tooth.crown.size()) / 100);
  }
}

TEST_F(Families, aTypeThatWasNotLoadedIsRefused) {
  FamilyLoadOptions options;
  options.vertices = 800;
  options.types = {8};
  options.crown_modes = 0;
  const ToothFamilies families = load_tooth_families(shared_data, options);
  EXPECT_TRUE(families.crown_models.empty());
  EXPECT_NO_THROW(generate_tooth(families, 8, 1));
  EXPECT_THROW(generate_tooth(families, 12, 1), UsageError);
}

void expect_models_on_templates(const ToothFamilies& families) {
  // Of both sides: 16 types, 11 loans between types that have models, and those of second molars lent to third ones.
  ASSERT_EQ(families.crown_models.size(),
            std::filesystem::exists(shared_data / "crowns" / "ssm") ? 2U * (16 + 11 + 2) : 0U);
  for (const FamilyCrownModel& model : families.crown_models) {
    const FamilyTemplate& tooth = families.templates[static_cast<std::size_t>(model.from)];
    const auto rows = static_cast<Eigen::Index>(3 * tooth.mesh.vertices.size());
    ASSERT_EQ(model.modes.mean_shift.size(), rows);
    ASSERT_EQ(model.modes.modes.rows(), rows);
    ASSERT_EQ(model.modes.modes.cols(), static_cast<Eigen::Index>(model.modes.deviations.size()));
    EXPECT_LT(model.modes.residual_mm, 0.06) << model.type << " from " << model.from;
    // The crowns of people differ by some tenths of a millimetre; the lower half of the root stays where it is.
    double crown = 0, crown_count = 0;
    for (std::size_t v = 0; v < tooth.crown.size(); ++v) {
      const Point& p = tooth.mesh.vertices[v];
      double square = 0;
      for (std::size_t k = 0; k < model.modes.deviations.size(); ++k)
        square += std::pow(model.modes.deviations[k], 2) *
                  static_cast<double>(model.modes.modes.col(static_cast<Eigen::Index>(k))
                                          .segment<3>(static_cast<Eigen::Index>(3 * v))
                                          .squaredNorm());
      if (p.z() < tooth.junction(p.x(), p.y()) - 9) {
        EXPECT_EQ(square, 0);
      } else if (tooth.crown[v] == 1) {
        crown += std::sqrt(square), crown_count += 1;
      }
    }
    EXPECT_GT(crown / crown_count, 0.2) << model.type << " from " << model.from;
    EXPECT_LT(crown / crown_count, 0.9) << model.type << " from " << model.from;
  }
}

// Pieces of the surface under a height that reach more than 1 mm further down.
int roots_below(const SyntheticTooth& tooth, double height) {
  std::vector<int> parent(tooth.mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int v) {
    while (parent[static_cast<std::size_t>(v)] != v) v = parent[static_cast<std::size_t>(v)];
    return v;
  };
  const auto z = [&](int v) { return tooth.mesh.vertices[static_cast<std::size_t>(v)].z(); };
  for (const Triangle& t : tooth.mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      if (z(a) < height && z(b) < height) parent[static_cast<std::size_t>(find(a))] = find(b);
    }
  std::set<int> deep;
  for (std::size_t v = 0; v < parent.size(); ++v)
    if (tooth.mesh.vertices[v].z() < height - 1) deep.insert(find(static_cast<int>(v)));
  return static_cast<int>(deep.size());
}

TEST_F(Families, furcationsPartTheRoots) {
  const ToothFamilies& families = all_families();
  for (const int type : {5, 6, 13, 14, 15}) {
    for (std::uint64_t seed = 60; seed < 66; ++seed) {
      const SyntheticTooth tooth = generate_tooth(families, type, seed);
      EXPECT_EQ(roots_below(tooth, tooth.furcation_z + 1.5), 1) << "type " << type << " seed " << seed;
      // Waves of the surface move the parting by 0.27 mm, and of third molars by a quarter more (deviations).
      const double below = type % 8 == 7 ? 1.0 : 0.7;
      EXPECT_GE(roots_below(tooth, tooth.furcation_z - below), 2) << "type " << type << " seed " << seed;
    }
  }
}

TEST_F(Families, noVariationGivesTheMeanTooth) {
  const ToothFamilies& families = all_families();
  for (const int type : {0, 8, 13}) {
    const SyntheticTooth tooth = mean_tooth(families, type);
    const ToothDimensions& mean = families.dimensions[static_cast<std::size_t>(type)];
    EXPECT_TRUE(tooth.own_template);
    EXPECT_NEAR(tooth.crown_turn, 0, 0.02);
    // Where one ends and the other begins is a matter of definition; a tooth's length is not.
    EXPECT_NEAR(tooth.root_length, mean.root_length, 0.1 * mean.root_length) << type;
    EXPECT_NEAR(tooth.crown_height, mean.crown_height, 0.1 * mean.crown_height) << type;
    const double length = mean.root_length + mean.crown_height;
    EXPECT_NEAR(tooth.root_length + tooth.crown_height, length, 0.03 * length) << type;
    Eigen::AlignedBox3d enamel;
    for (std::size_t v = 0; v < tooth.crown.size(); ++v)
      if (tooth.crown[v] == 1) enamel.extend(tooth.mesh.vertices[v]);
    EXPECT_NEAR(enamel.sizes().x(), mean.crown_mesiodistal, 0.05 * mean.crown_mesiodistal) << type;
    EXPECT_NEAR(enamel.sizes().y(), mean.crown_buccolingual, 0.05 * mean.crown_buccolingual) << type;
  }
}

void expect_crops_are_discs(const ToothFamilies& families) {
  tbb::parallel_for(0, tooth_type_count, [&](int type) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const SyntheticTooth tooth = generate_tooth(families, type, 40 + seed);
      RandomStream random(seed);
      const TriangleMesh crown = draw_cropped_crown(tooth, 0.3, 0.5, random).mesh;
      const Diagnosis diagnosis = diagnose(crown);
      EXPECT_TRUE(diagnosis.is_oriented_manifold()) << "type " << type << " seed " << seed;
      EXPECT_EQ(diagnosis.border_loop_count, 1);
      EXPECT_EQ(diagnosis.euler_number, 1);
      EXPECT_GT(growth_axis(crown).z(), 0.7)
          << "gum lines lean by up to 35 degrees, and more with a side that stands high";
    }
  });
}

void expect_registration(const ToothFamilies& families) {
  const Atlas atlas = make_atlas(families);
  constexpr int seeds = 3;
  std::array<int, tooth_type_count> good{};
  tbb::parallel_for(0, tooth_type_count, [&](int type) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const SyntheticTooth tooth = generate_tooth(families, type, 7000 + seed);
      RandomStream random(seed, 5);
      TriangleMesh crown = draw_cropped_crown(tooth, 0, 0.3, random).mesh;
      const CanonicalFrame truth = frame_of_crop(crown, -tooth.crown_turn);
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(random.uniform(0, 6), Eigen::Vector3d(1, random.normal(), 1).normalized())
              .toRotationMatrix();
      for (Point& p : crown.vertices) p = turn * p + Point(20, -5, 7);
      const CrownFrame found =
          canonical_frame(prepare_crown(crown), fdi_of_type(type, false), atlas.types[static_cast<std::size_t>(type)]);
      const Eigen::Vector3d a = found.frame.direction_to_canonical(turn * Eigen::Vector3d::UnitX());
      const Eigen::Vector3d b = truth.direction_to_canonical(Eigen::Vector3d::UnitX());
      const double error = std::atan2(b.x() * a.y() - b.y() * a.x(), b.x() * a.x() + b.y() * a.y());
      if (std::abs(error) < 0.15) ++good[static_cast<std::size_t>(type)];  // worn and chipped crowns among them
    }
  });
  int all = 0;
  for (std::size_t type = 0; type < good.size(); ++type) {
    all += good[type];
    ::testing::Test::RecordProperty("type_" + std::to_string(type), good[type]);
  }
  EXPECT_GE(all, tooth_type_count * seeds * 9 / 10);
}

TEST_F(Families, everyTypeIsSound) {
  const ToothFamilies& families = all_families();
  expect_roots_of_type(families);
  expect_models_on_templates(families);
  expect_solids(families);
  expect_no_self_intersections(families);
  expect_crops_are_discs(families);
  expect_registration(families);
}

TEST(FamilyFiles, missingFilesAreNamed) {
  try {
    load_tooth_families("/no/such/folder");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("anatomy.csv"), std::string::npos);
  }
  FamilyLoadOptions options;
  options.vertices = 3;
  EXPECT_THROW(load_tooth_families(shared_data, options), UsageError);
}

}  // namespace
}  // namespace rhizodont
