// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// How crowns stand in the arch: Chen Y. et al., "Automatic 3D Teeth Reconstruction from Five Intra-oral Photos Using
// Parametric Teeth Model", 2023, whose mean crowns stand in place. Whole teeth's axes, where published: H. Tong et al.,
// "Mesiodistal angulation and faciolingual inclination of each whole tooth in 3-dimensional space in patients with
// near-normal occlusion", Am J Orthod Dentofacial Orthop 141, 2012 (76 people, cone-beam computed tomography).
#include "families/mean_arch.hpp"

#include "completion/registration.hpp"
#include "families/crown_model.hpp"
#include "mesh/geometry.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

/// The 3 x 3 part of turns of each tooth's covariance.
std::map<int, Eigen::Matrix3d> turn_covariances(const std::filesystem::path& path) {
  const TensorFile file = read_safetensors(path);
  const auto pose = file.tensors.find("pose");
  const auto names = file.metadata.find("fdi");
  const std::vector<std::int64_t> shape{28, 6, 6};
  if (pose == file.tensors.end() || pose->second.shape != shape || names == file.metadata.end())
    throw InputError("The covariances of the arch are not those of 28 teeth.");
  const std::vector<float> numbers = load_floats(pose->second);
  std::istringstream words(names->second);
  std::map<int, Eigen::Matrix3d> covariances;
  std::string word;
  for (std::size_t i = 0; i < 28 && words >> word; ++i) {
    Eigen::Matrix3d& turns = covariances[read_fdi(word).value_or(0)];
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        turns(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
            static_cast<double>(numbers[36 * i + 6 * (r + 3) + c + 3]);
  }
  if (covariances.size() != 28 || covariances.contains(0))
    throw InputError("The covariances of the arch are not those of 28 teeth.");
  return covariances;
}

/// Of a tooth of the left side: what a tooth of the right side is to its model mirrored.
ArchTooth tooth_of_left(const std::filesystem::path& folder, const Atlas& atlas, int fdi) {
  const int type = tooth_type_of_fdi(fdi);
  const CrownShapeModel model =
      load_crown_shape_model(folder / "ssm" / fmt::format("crown_ssm_{}.safetensors", fdi), 0, is_right_side(fdi));
  const Eigen::Vector3d up(0, fdi / 10 <= 2 ? -1 : 1, 0);
  OrientedPoints points{model.mean, {}};
  Point middle = Point::Zero();
  for (const Point& p : model.mean) middle += p / static_cast<double>(model.mean.size());
  for (std::size_t i = 0; i < model.mean.size(); ++i) {
    const Eigen::Vector3d& n = model.normals[i];
    points.normals.push_back(n.dot(model.mean[i] - middle) < 0 ? Eigen::Vector3d(-n) : n);
  }
  const RigidFit fit = fit_mean_crown(points, atlas.types[static_cast<std::size_t>(type)], false, false, up);
  return {
      middle,
      {fit.frame.direction_to_world(Eigen::Vector3d::UnitZ()), fit.frame.direction_to_world(Eigen::Vector3d::UnitY())},
      Eigen::Matrix3d::Zero()};
}

/// Degrees against the occlusal direction: of the crown towards mesial, and towards the cheek. What is not published
/// is as the mean crown stands.
struct PublishedLean {
  double angulation = 0;
  std::optional<double> inclination;
};

/// Of teeth 1 to 7 of each jaw. Published are, of the angulations, upper 1, 3, 6, 7 and lower 1 and 7, of the
/// inclinations 1 and 5; between them they rise and fall steadily, and so they do here.
PublishedLean published_lean(int fdi) {
  constexpr std::array<double, 7> upper_angulation{6, 8.5, 11, 7.5, 4, 0.5, -6},
      lower_angulation{0, 0, 3.5, 7, 10.5, 14, 17.5};
  constexpr std::array<double, 5> upper_inclination{33.5, 25, 17, 8.5, 0}, lower_inclination{26.5, 20, 13, 6.5, 0};
  const bool upper = fdi / 10 <= 2;
  const auto place = static_cast<std::size_t>(fdi % 10 - 1);
  PublishedLean lean{(upper ? upper_angulation : lower_angulation)[place], {}};
  if (place < upper_inclination.size()) lean.inclination = (upper ? upper_inclination : lower_inclination)[place];
  return lean;
}

/// A tooth of the left side leaned as published, against the line between its neighbours in the arch.
void lean_as_published(ArchTooth& tooth, int fdi, const Eigen::Vector3d& along) {
  const Eigen::Vector3d up(0, fdi / 10 <= 2 ? -1 : 1, 0);
  const Eigen::Vector3d mesial = -Eigen::Vector3d(along.x(), 0, along.z()).normalized();
  const Eigen::Vector3d cheek(mesial.z(), 0, -mesial.x());
  const auto tangent = [&](const Eigen::Vector3d& side, const std::optional<double>& published) {
    if (published) return std::tan(*published * std::numbers::pi / 180);
    return tooth.directions.occlusal.dot(side) / tooth.directions.occlusal.dot(up);
  };
  const PublishedLean lean = published_lean(fdi);
  const Eigen::Vector3d occlusal =
      (up + tangent(mesial, lean.angulation) * mesial + tangent(cheek, lean.inclination) * cheek).normalized();
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(tooth.directions.occlusal, occlusal);
  tooth.directions = {occlusal, turn * tooth.directions.buccal};
}

Eigen::Vector3d mirror(const Eigen::Vector3d& v) { return {-v.x(), v.y(), v.z()}; }

}  // namespace

ArchModel make_arch_model(const Atlas& atlas, const std::filesystem::path& folder) {
  const std::map<int, Eigen::Matrix3d> covariances = turn_covariances(folder / "arch_covariances.safetensors");
  // Turns about y and z change their sense in a mirror.
  const Eigen::DiagonalMatrix<double, 3> sense(1, -1, -1);
  std::map<int, ArchTooth> left_side;
  for (const int left_quadrant : {2, 3}) {
    const int right_quadrant = left_quadrant == 2 ? 1 : 4;
    for (int place = 1; place <= 7; ++place) {
      const int left = 10 * left_quadrant + place, right = 10 * right_quadrant + place;
      const ArchTooth a = tooth_of_left(folder, atlas, left), b = tooth_of_left(folder, atlas, right);
      ArchTooth both;
      both.place = 0.5 * (a.place + b.place);
      both.directions.occlusal = (a.directions.occlusal + b.directions.occlusal).normalized();
      const Eigen::Vector3d buccal = a.directions.buccal + b.directions.buccal;
      both.directions.buccal = (buccal - both.directions.occlusal.dot(buccal) * both.directions.occlusal).normalized();
      both.turn_covariance = 0.5 * (covariances.at(left) + sense * covariances.at(right) * sense);
      left_side.emplace(left, both);
    }
  }
  ArchModel model;
  for (auto [left, tooth] : left_side) {
    const Point before = left % 10 == 1 ? mirror(tooth.place) : left_side.at(left - 1).place;
    const Point after = left % 10 == 7 ? tooth.place : left_side.at(left + 1).place;
    lean_as_published(tooth, left, after - before);
    const int right = left / 10 == 2 ? left - 10 : left + 10;
    model.teeth.emplace(left, tooth);
    model.teeth.emplace(right, ArchTooth{mirror(tooth.place),
                                         {mirror(tooth.directions.occlusal), mirror(tooth.directions.buccal)},
                                         sense * tooth.turn_covariance * sense});
  }
  return model;
}

}  // namespace rhizodont
