// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Runs on what the project ships: the crowns in samples/ and models/atlas.safetensors.
#include "completion/registration.hpp"
#include "completion/mean_crowns.hpp"
#include "completion/product_atlas.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"
#include "teeth/frame.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

namespace rhizodont {
namespace {

using test::atlas;
using test::source_folder;

struct Sample {
  int fdi;
  const char* file;
};
constexpr Sample samples[] = {
    {11, "crown_11.stl"}, {23, "crown_23.ply"}, {34, "crown_34.ply"}, {36, "crown_36.stl"}, {16, "crown_16.ply"}};

TriangleMesh sample_crown(const Sample& sample) { return load_mesh(source_folder / "samples" / sample.file).mesh; }

const MeanCrown& mean_of(int fdi) { return atlas().types[static_cast<std::size_t>(tooth_type_of_fdi(fdi))]; }

TriangleMesh turned(TriangleMesh mesh, const Eigen::Matrix3d& turn, const Point& shift) {
  for (Point& p : mesh.vertices) p = turn * p + shift;
  return mesh;
}

TriangleMesh mirrored(TriangleMesh mesh) {
  for (Point& p : mesh.vertices) p.x() = -p.x();
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

// Angle about z between two poses of the same crown.
double angle_between(const CanonicalFrame& a, const TriangleMesh& mesh_a, const CanonicalFrame& b,
                     const TriangleMesh& mesh_b) {
  double sine = 0, cosine = 0;
  for (std::size_t v = 0; v < mesh_a.vertices.size(); ++v) {
    const Point p = a.to_canonical(mesh_a.vertices[v]), q = b.to_canonical(mesh_b.vertices[v]);
    sine += p.x() * q.y() - p.y() * q.x(), cosine += p.x() * q.x() + p.y() * q.y();
  }
  return std::atan2(sine, cosine);
}

TEST(CanonicalFrameOfCrowns, axisAndCentreAreTheCrownsOwn) {
  for (const Sample& sample : samples) {
    const TriangleMesh crown = sample_crown(sample);
    const CrownFrame found = canonical_frame(prepare_crown(crown), sample.fdi, mean_of(sample.fdi));
    EXPECT_LT((found.frame.direction_to_canonical(growth_axis(crown)) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
    EXPECT_LT((found.frame.centre - area_centroid(crown)).norm(), 1e-12);
    EXPECT_EQ(found.frame.mirrored, is_right_side(sample.fdi));
    EXPECT_NEAR(found.frame.rotation.determinant(), 1, 1e-12);
    EXPECT_LT(found.residual_mm, 1.2) << sample.fdi;
  }
}

TEST(CanonicalFrameOfCrowns, poseInTheScanDoesNotMatter) {
  for (const Sample& sample : samples) {
    const TriangleMesh crown = sample_crown(sample);
    const CanonicalFrame first = canonical_frame(prepare_crown(crown), sample.fdi, mean_of(sample.fdi)).frame;
    for (int k = 1; k <= 4; ++k) {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(1.5 * k, Eigen::Vector3d(std::sin(k), std::cos(2 * k), 0.3).normalized())
              .toRotationMatrix();
      const TriangleMesh moved = turned(crown, turn, Point(40 * k, -20, 11));
      const CanonicalFrame second = canonical_frame(prepare_crown(moved), sample.fdi, mean_of(sample.fdi)).frame;
      EXPECT_LT(std::abs(angle_between(first, crown, second, moved)), 0.06) << sample.fdi << " turn " << k;
    }
  }
}

TEST(CanonicalFrameOfCrowns, mirrorImageIsTheOtherSidesTooth) {
  for (const Sample& sample : samples) {
    const TriangleMesh crown = sample_crown(sample), image = mirrored(crown);
    const int other = fdi_of_type(tooth_type_of_fdi(sample.fdi), !is_right_side(sample.fdi));
    const CanonicalFrame first = canonical_frame(prepare_crown(crown), sample.fdi, mean_of(sample.fdi)).frame;
    const CanonicalFrame second = canonical_frame(prepare_crown(image), other, mean_of(other)).frame;
    EXPECT_LT(std::abs(angle_between(first, crown, second, image)), 0.06) << sample.fdi;
  }
}

/// The triangles above a plane `depth` below the top that rises by `radians` to where `frame` has +x or +y.
TriangleMesh cut(const TriangleMesh& crown, const CanonicalFrame& frame, double depth_mm, int axis, double radians) {
  const auto height = [&](const Point& p) {
    const Point q = frame.scale * frame.to_canonical(p);
    return q.z() - std::tan(radians) * q[axis];
  };
  double top = -1e9;
  for (const Point& p : crown.vertices) top = std::max(top, height(p));
  TriangleMesh result = crown;
  std::erase_if(result.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(),
                       [&](int v) { return height(crown.vertices[static_cast<std::size_t>(v)]) < top - depth_mm; });
  });
  return result;
}

TEST(CanonicalFrameOfCrowns, axisOfTheFormStaysWhereTheBorderLeans) {
  const auto axis = [](const CrownFrame& found) { return found.frame.direction_to_world(found.form_direction()); };
  double form = 0, border = 0, image = 0;  // sums over crowns and cuts
  for (const Sample& sample : samples) {
    const TriangleMesh crown = sample_crown(sample);
    const CrownFrame whole = canonical_frame(prepare_crown(crown), sample.fdi, mean_of(sample.fdi));
    const int other = fdi_of_type(tooth_type_of_fdi(sample.fdi), !is_right_side(sample.fdi));
    for (const int along : {0, 1}) {
      for (const double lean : {-0.2, 0.2}) {
        const TriangleMesh part = cut(crown, whole.frame, 5.2, along, lean);
        const CrownFrame found = canonical_frame(prepare_crown(part), sample.fdi, mean_of(sample.fdi));
        form += std::acos(axis(found).dot(axis(whole)));
        border += std::acos(growth_axis(part).dot(growth_axis(crown)));
        image +=
            (canonical_frame(prepare_crown(mirrored(part)), other, mean_of(other)).form_axis - found.form_axis).norm();
        // A cut that rises to one side turns the border's axis away from there, so the form's axis is on that side.
        EXPECT_GT(lean * (found.form_axis - whole.form_axis)[along], 0) << sample.fdi << " along " << along;
      }
    }
  }
  EXPECT_GT(border / 20, 0.17) << "radians";
  EXPECT_LT(form, 0.5 * border);
  EXPECT_LT(image / 20, 0.05);
}

TEST(CanonicalFrameOfCrowns, anArchsDirectionsLeaveHalfOfTheFormsLean) {
  for (const Sample& sample : samples) {
    const TriangleMesh crown = sample_crown(sample);
    const CanonicalFrame whole = canonical_frame(prepare_crown(crown), sample.fdi, mean_of(sample.fdi)).frame;
    const PreparedCrown part = prepare_crown(cut(crown, whole, 5.2, 1, 0.2));
    const CrownFrame alone = canonical_frame(part, sample.fdi, mean_of(sample.fdi));
    // The arch tells what the crown was laid by before, so that nothing else changes.
    const ToothDirections directions{part.growth_axis, alone.frame.direction_to_world(Eigen::Vector3d::UnitY())};
    const CrownFrame told = canonical_frame(part, sample.fdi, mean_of(sample.fdi), {}, directions);
    ASSERT_GT(alone.form_axis.norm(), 0.02) << sample.fdi;
    EXPECT_LT((told.form_axis - alone.form_axis / 2).norm(), 0.1 * alone.form_axis.norm()) << sample.fdi;
  }
}

TEST(CanonicalFrameOfCrowns, aPoseThatWasSeenTellsTurnAndLean) {
  for (const Sample& sample : samples) {
    const PreparedCrown crown = prepare_crown(sample_crown(sample));
    const CrownFrame laid = canonical_frame(crown, sample.fdi, mean_of(sample.fdi));
    const auto to_world = [&](double x, double y, double z) {
      return laid.frame.direction_to_world(Eigen::Vector3d(x, y, z).normalized());
    };
    const CrownPose seen{to_world(0.3, 1, 0), to_world(0.2, -0.1, 1)};
    const CrownFrame found = canonical_frame(crown, sample.fdi, mean_of(sample.fdi), {}, {}, seen);
    EXPECT_LT((found.frame.direction_to_world(Eigen::Vector3d::UnitY()) - seen.buccal).norm(), 1e-9) << sample.fdi;
    EXPECT_LT((found.frame.direction_to_world(found.form_direction()) - seen.form_axis).norm(), 1e-9) << sample.fdi;
    EXPECT_LT((found.frame.direction_to_world(Eigen::Vector3d::UnitZ()) - crown.growth_axis).norm(), 1e-9);
    EXPECT_NEAR(found.residual_mm, laid.residual_mm, 0.1 * laid.residual_mm) << "that of the crown laid there";
    // In an arch the neighbours tell the turn, and half of the lean is taken.
    const ToothDirections directions{crown.growth_axis, laid.frame.direction_to_world(Eigen::Vector3d::UnitY())};
    const CrownFrame told = canonical_frame(crown, sample.fdi, mean_of(sample.fdi), {}, directions, seen);
    EXPECT_LT((told.frame.rotation - laid.frame.rotation).norm(), 0.05) << sample.fdi;
    const Eigen::Vector3d leans = told.frame.direction_to_canonical(seen.form_axis);
    EXPECT_LT((told.form_axis - leans.head<2>() / 2).norm(), 1e-9) << sample.fdi;
    const CrownPose upside_down{seen.buccal, -seen.form_axis};
    EXPECT_EQ(canonical_frame(crown, sample.fdi, mean_of(sample.fdi), {}, {}, upside_down).form_axis.norm(), 0);
  }
}

TEST(CanonicalFrameOfCrowns, isTheSameForAnyNumberOfThreads) {
  const TriangleMesh crown = sample_crown(samples[3]);
  const TypeGuess many = guess_fdi_type(prepare_crown(crown), atlas());
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const TypeGuess single = guess_fdi_type(prepare_crown(crown), atlas());
  EXPECT_EQ(many.fdi, single.fdi);
  EXPECT_EQ(many.residuals_mm, single.residuals_mm);
  EXPECT_EQ(many.frame.frame.rotation, single.frame.frame.rotation);
}

TEST(GuessedType, findsJawAndClassOfTheSamples) {
  for (const Sample& sample : samples) {
    const TypeGuess guess = guess_fdi_type(prepare_crown(sample_crown(sample)), atlas());
    // Neighbours of one class are alike; a molar is not taken for an incisor, nor an upper tooth for a lower one.
    const auto group = [](int fdi) { return fdi % 10 <= 2 ? 0 : fdi % 10 == 3 ? 1 : fdi % 10 <= 5 ? 2 : 3; };
    EXPECT_EQ(group(guess.fdi), group(sample.fdi)) << sample.fdi << " taken for " << guess.fdi;
    EXPECT_EQ(guess.fdi / 30, sample.fdi / 30) << sample.fdi << " taken for " << guess.fdi;
    EXPECT_EQ(guess.frame.frame.mirrored, is_right_side(guess.fdi));
  }
}

TEST(MeanCrownFit, findsAxisAndSizeOfAKnownPose) {
  const MeanCrown& mean = mean_of(36);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.4, Eigen::Vector3d(0.2, 1, -0.4).normalized()).toRotationMatrix();
  const double size = 1.08;
  OrientedPoints points;
  for (const Point& p : mean.crown.points) points.points.push_back(turn * (12 * size * p) + Point(10, 20, 30));
  for (const Eigen::Vector3d& n : mean.crown.normals) points.normals.push_back(turn * n);
  const RigidFit fit = fit_mean_crown(points, mean, false, true);
  EXPECT_LT((fit.frame.direction_to_world(Eigen::Vector3d::UnitZ()) - turn.col(2)).norm(), 0.02);
  EXPECT_LT((fit.frame.direction_to_world(Eigen::Vector3d::UnitX()) - turn.col(0)).norm(), 0.02);
  EXPECT_NEAR(fit.scale_ratio, size, 0.02);
  EXPECT_LT((fit.frame.centre - Point(10, 20, 30)).norm(), 0.2);
  EXPECT_LT(fit.residual_mm, 0.1);
}

TEST(Registration, refusesWhatItCannotUse) {
  const TriangleMesh crown = sample_crown(samples[0]);
  EXPECT_THROW(canonical_frame(prepare_crown(crown), 19, mean_of(11)), UsageError);
  EXPECT_THROW(canonical_frame(prepare_crown(TriangleMesh{}), 11, mean_of(11)), InputError);
  EXPECT_THROW(canonical_frame(prepare_crown(crown), 11, MeanCrown{}), UsageError);
  EXPECT_THROW(guess_fdi_type(prepare_crown(crown), Atlas{}), UsageError);
  RegistrationOptions options;
  options.trim = 0.1;
  EXPECT_THROW(canonical_frame(prepare_crown(crown), 11, mean_of(11), options), UsageError);
  EXPECT_THROW(fit_mean_crown({}, mean_of(11), false, true), InputError);
  const SurfaceSamples surface = sample_surface(crown, 100, 3);
  EXPECT_THROW(fit_mean_crown({surface.points, surface.normals}, mean_of(11), false, false, Eigen::Vector3d(0, 0, 2)),
               UsageError);
}

}  // namespace
}  // namespace rhizodont
