// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Equivariance by weights that are shared around the axis: T. S. Cohen, M. Welling, "Group equivariant convolutional
// networks", 2016. Panoramas: B. Shi et al., "DeepPano", 2015.
#include "completion/pose_network.hpp"

#include "base/parallel_tasks.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "teeth/frame.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace rhizodont {
namespace {

constexpr const char* pose_weights = "The weights that tell how crowns stand";
constexpr Eigen::Index said_of_type = 3;  // how likely the cheek is there, lean towards the place, lean along columns
constexpr auto all_columns = static_cast<Eigen::Index>(CrownPanorama::columns);

double column_azimuth(Eigen::Index column) {
  return (static_cast<double>(column) + 0.5) * 2 * std::numbers::pi / static_cast<double>(all_columns);
}

/// Column c of the result is column c + `by` of the panorama.
CrownPanorama turned(const CrownPanorama& panorama, Eigen::Index by) {
  CrownPanorama result = panorama;
  for (auto row = result.values.begin(); row != result.values.end(); row += all_columns)
    std::rotate(row, row + by, row + all_columns);
  return result;
}

/// The middle of the likelihoods around the most likely azimuth.
double middle_of_peak(const std::vector<double>& likelihood) {
  constexpr Eigen::Index half_width = 6;  // columns: 34 degrees, over which one place's likelihood spreads
  const auto at = [&](Eigen::Index c) {
    return likelihood[static_cast<std::size_t>((c + 2 * all_columns) % all_columns)];
  };
  double most = -1, middle = 0;
  for (Eigen::Index peak = 0; peak < all_columns; ++peak) {
    double sum = 0, moment = 0;
    for (Eigen::Index k = -half_width; k <= half_width; ++k)
      sum += at(peak + k), moment += static_cast<double>(k) * at(peak + k);
    if (sum > most) most = sum, middle = column_azimuth(peak) + (column_azimuth(1) - column_azimuth(0)) * moment / sum;
  }
  return middle;
}

}  // namespace

PoseNetwork::PoseNetwork(const TensorFile& file)
    : features_(file, pose_weights),
      around_(panorama_layer(file, "pose.0", 3, pose_weights)),
      said_(panorama_layer(file, "pose.1", 2, pose_weights)) {
  if (around_.kernel_columns % 2 == 0 || around_.kernel_columns > all_columns / PanoramaFeatures::columns_per_place ||
      around_.inputs != features_.channels() || said_.inputs != around_.weight.rows() ||
      said_.weight.rows() != said_of_type * tooth_type_count)
    throw InputError(std::string(pose_weights) + " do not fit each other.");
}

PanoramaPose PoseNetwork::operator()(const CrownPanorama& panorama, int type, Columns looked_at) const {
  constexpr Eigen::Index step = PanoramaFeatures::columns_per_place;
  // Strides leave three of four columns without a place: what the network says of the panorama turned by so many fills
  // them, and its leans are averaged.
  const Eigen::Index turns = looked_at == Columns::all ? step : 1;
  std::vector<Eigen::MatrixXd> said(static_cast<std::size_t>(turns));
  parallel_tasks(said.size(), [&](std::size_t by) {
    const Eigen::MatrixXf around =
        convolved_around(features_(turned(panorama, static_cast<Eigen::Index>(by))), around_);
    said[by] = ((said_.weight.middleRows(said_of_type * type, said_of_type) * around).colwise() +
                said_.bias.segment(said_of_type * type, said_of_type))
                   .cast<double>();
  });
  for (const Eigen::MatrixXd& here : said)
    if (!here.allFinite()) throw InputError(std::string(pose_weights) + " are damaged: what they say is no number.");
  std::vector<double> likelihood(static_cast<std::size_t>(all_columns));
  PanoramaPose pose;
  for (Eigen::Index by = 0; by < turns; ++by) {
    const Eigen::MatrixXd& here = said[static_cast<std::size_t>(by)];
    const Eigen::ArrayXd shares = (here.row(0).array() - here.row(0).maxCoeff()).exp().transpose();
    for (Eigen::Index place = 0; place < here.cols(); ++place) {
      const Eigen::Index column = (step * place + by) % all_columns;
      likelihood[static_cast<std::size_t>(column)] = shares[place] / shares.sum();
      const Eigen::Rotation2Dd turn(column_azimuth(column));
      pose.form_axis += turn * here.col(place).tail<2>() / static_cast<double>(turns);
    }
  }
  pose.azimuth = middle_of_peak(likelihood);
  return pose;
}

CrownPose PoseNetwork::seen_along(const TriangleMesh& open_crown, const Eigen::Vector3d& axis, int fdi,
                                  Columns looked_at) const {
  const CrownPanorama panorama = crown_panorama(open_crown, axis, panorama_centre(open_crown, axis));
  const bool right_side = is_right_side(fdi);
  PanoramaPose pose = (*this)(right_side ? mirrored(panorama) : panorama, tooth_type_of_fdi(fdi), looked_at);
  if (right_side) pose.azimuth = -pose.azimuth, pose.form_axis.y() = -pose.form_axis.y();
  const Eigen::Matrix3d to_world = panorama_view(axis).transpose();
  constexpr double longest = 0.9;
  pose.form_axis *= longest / std::max(longest, pose.form_axis.norm());
  const double up = std::sqrt(1 - pose.form_axis.squaredNorm());
  return {to_world * Eigen::Vector3d(std::cos(pose.azimuth), std::sin(pose.azimuth), 0),
          to_world * Eigen::Vector3d(pose.form_axis.x(), pose.form_axis.y(), up)};
}

CrownPose PoseNetwork::pose_of(const TriangleMesh& open_crown, int fdi) const {
  const Eigen::Vector3d border_axis = growth_axis(open_crown);
  // Borders lean: what is seen along the form's own axis, once that is roughly known, is more alike.
  const Eigen::Vector3d axis = seen_along(open_crown, border_axis, fdi, Columns::every_fourth).form_axis;
  CrownPose pose = seen_along(open_crown, axis, fdi, Columns::all);
  // The cheek's direction is that across the border's axis which is seen there.
  pose.buccal = (axis.dot(border_axis) * pose.buccal - pose.buccal.dot(border_axis) * axis).normalized();
  return pose;
}

}  // namespace rhizodont
