// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Data: Chen Y. et al., "Automatic 3D Teeth Reconstruction from Five Intra-oral Photos Using Parametric Teeth Model",
// 2023: crown models, covariances, crowns of two people.
#include "families/arch_source.hpp"

#include "base/parallel_tasks.hpp"
#include "families/crown_model.hpp"
#include "families/model_crowns.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>

#include <cstdint>
#include <sstream>
#include <string>
#include <utility>

namespace rhizodont {
namespace {

constexpr std::size_t teeth_of_side = 7;

int fdi_of_row(std::size_t row, bool right) {
  const bool upper = row < teeth_of_side;
  const int quadrant = upper ? (right ? 1 : 2) : (right ? 4 : 3);
  return 10 * quadrant + static_cast<int>(row % teeth_of_side) + 1;
}

Point mean_of(const std::vector<Point>& points) {
  Point sum = Point::Zero();
  for (const Point& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// The mesh about its middle, which is returned.
Point centred(TriangleMesh& mesh) {
  const Point middle = mean_of(mesh.vertices);
  for (Point& p : mesh.vertices) p -= middle;
  return middle;
}

ArchCrownForm load_form(const std::filesystem::path& folder, std::size_t row, bool right) {
  constexpr std::size_t all_modes = 40;
  const CrownShapeModel model = load_crown_shape_model(
      folder / "ssm" / fmt::format("crown_ssm_{}.safetensors", fdi_of_row(row, right)), all_modes, right);
  ArchCrownForm form;
  form.mean = closed_surface(model.mean);
  form.place = centred(form.mean);
  for (const Eigen::MatrixX3d& mode : model.modes) form.modes.emplace_back(mode.cast<float>());
  form.deviations = model.deviations;
  return form;
}

RealCrown load_real(const std::filesystem::path& folder, std::size_t row, bool right) {
  RealCrown crown;
  crown.mesh = load_mesh(folder / fmt::format("crown_{}.ply", fdi_of_row(row, right))).mesh;
  if (right) {
    for (Point& p : crown.mesh.vertices) p.x() = -p.x();
    for (Triangle& t : crown.mesh.triangles) std::swap(t[1], t[2]);
  }
  crown.place = centred(crown.mesh);
  return crown;
}

/// Fills in how the crown lies on a model's mean.
void lay_on_model(const ArchCrownForm& form, RealCrown& crown) {
  constexpr std::size_t around = 70;  // vertices, about 2 mm
  const Eigen::AlignedBox3d from = bounding_box(crown.mesh.vertices), to = bounding_box(form.mean.vertices);
  const Eigen::Vector3d scale = to.sizes().cwiseQuotient(from.sizes());
  for (const Point& p : crown.mesh.vertices)
    crown.as_mean.emplace_back((p - from.center()).cwiseProduct(scale) + to.center());
  const NearestVertexIndex model(form.mean.vertices), own(crown.as_mean);
  std::vector<Eigen::Vector3d> off;
  for (const Point& p : crown.as_mean) {
    const std::vector<NearVertex> near = model.nearest(p, 3);
    std::array<std::pair<int, float>, 3> carriers;
    double total = 0;
    Point middle = Point::Zero();
    for (const NearVertex& one : near) total += 1 / (0.05 + one.squared_distance);
    for (std::size_t k = 0; k < 3; ++k) {
      const double share = 1 / (0.05 + near[k].squared_distance) / total;
      carriers[k] = {near[k].index, static_cast<float>(share)};
      middle += share * form.mean.vertices[static_cast<std::size_t>(near[k].index)];
    }
    crown.carriers.push_back(carriers);
    off.emplace_back(middle - p);
  }
  for (const Point& p : crown.as_mean) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const std::vector<NearVertex> near = own.nearest(p, around);
    for (const NearVertex& one : near) sum += off[static_cast<std::size_t>(one.index)] / static_cast<double>(around);
    crown.to_mean.push_back(sum);
  }
}

template <int Size>
Eigen::Matrix<double, Size, Size> square_root(const Eigen::Matrix<double, Size, Size>& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Size, Size>> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

void read_covariances(const std::filesystem::path& path, ArchSource& source) {
  const TensorFile file = read_safetensors(path);
  const auto pose = file.tensors.find("pose"), scale = file.tensors.find("scale");
  const auto names = file.metadata.find("fdi");
  const InputError damaged("The covariances of the arch are not those of 28 teeth.");
  if (pose == file.tensors.end() || scale == file.tensors.end() || names == file.metadata.end()) throw damaged;
  if (pose->second.shape != std::vector<std::int64_t>{28, 6, 6} ||
      scale->second.shape != std::vector<std::int64_t>{28, 28})
    throw damaged;
  const std::vector<float> poses = load_floats(pose->second), scales = load_floats(scale->second);
  std::array<std::size_t, 2 * arch_rows> place{};  // in the file, of each row
  std::array<bool, 2 * arch_rows> found{};
  std::istringstream words(names->second);
  std::string word;
  for (std::size_t i = 0; i < 28 && words >> word; ++i) {
    const int fdi = read_fdi(word).value_or(0);
    if (!is_permanent_tooth(fdi) || fdi % 10 == 8) throw damaged;
    const std::size_t row = arch_row(fdi) + (is_right_side(fdi) ? arch_rows : 0);
    place[row] = i;
    found[row] = true;
  }
  for (const bool one : found)
    if (!one) throw damaged;
  Eigen::Matrix<double, 28, 28> sizes;
  for (std::size_t r = 0; r < 28; ++r)
    for (std::size_t c = 0; c < 28; ++c)
      sizes(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = scales[28 * place[r] + place[c]];
  const Eigen::Matrix<double, 28, 28> both_ways = 0.5 * (sizes + sizes.transpose());
  source.size_root = square_root<28>(both_ways);
  // Left and right are made alike; x changes its sign in a mirror, as turns about y and z do.
  const Eigen::DiagonalMatrix<double, 3> place_sense(-1, 1, 1), turn_sense(1, -1, -1);
  for (std::size_t row = 0; row < arch_rows; ++row) {
    const auto block = [&](std::size_t at, std::size_t from) {
      Eigen::Matrix3d m;
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c)
          m(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
              static_cast<double>(poses[36 * place[at] + 6 * (r + from) + c + from]);
      return m;
    };
    const Eigen::Matrix3d places = 0.5 * (block(row, 0) + place_sense * block(row + arch_rows, 0) * place_sense);
    const Eigen::Matrix3d turns = 0.5 * (block(row, 3) + turn_sense * block(row + arch_rows, 3) * turn_sense);
    source.place_root[row] = square_root<3>(places);
    source.turn_root[row] = square_root<3>(turns);
  }
}

}  // namespace

std::size_t arch_row(int fdi) { return static_cast<std::size_t>(fdi % 10 - 1) + (fdi / 10 <= 2 ? 0 : teeth_of_side); }

ArchSource load_arch_source(const std::filesystem::path& crowns) {
  ArchSource source;
  read_covariances(crowns / "arch_covariances.safetensors", source);
  parallel_tasks(2 * arch_rows,
                 [&](std::size_t i) { source.forms[i / 2][i % 2] = load_form(crowns, i / 2, i % 2 == 1); });
  for (const char* name : {"patient0", "patient1"}) {
    if (!std::filesystem::is_directory(crowns / name)) continue;
    source.people.emplace_back();
    parallel_tasks(2 * arch_rows, [&](std::size_t i) {
      RealCrown& crown = source.people.back()[i / 2][i % 2];
      crown = load_real(crowns / name, i / 2, i % 2 == 1);
      lay_on_model(source.forms[i / 2][i % 2], crown);
    });
  }
  return source;
}

}  // namespace rhizodont
