// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/likeness.hpp"
#include "learning/safetensors.hpp"
#include "rhizodont/error.hpp"

#include <array>
#include <string>
#include <vector>

namespace rhizodont {
namespace {

StoredTensor tensor_of(const Eigen::MatrixXd& matrix) {
  std::vector<float> values;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) values.push_back(static_cast<float>(matrix(r, c)));
  return store_floats(values, {matrix.rows(), matrix.cols()});
}

Eigen::MatrixXd matrix_of(const TensorFile& file, const std::string& name) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end() || found->second.type == TensorType::int32 || found->second.shape.size() != 2)
    throw InputError("The statistics of crowns lack the matrix " + name + ".");
  const std::vector<float> values = load_floats(found->second);
  Eigen::MatrixXd matrix(found->second.shape[0], found->second.shape[1]);
  std::size_t i = 0;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) matrix(r, c) = static_cast<double>(values[i++]);
  if (!matrix.allFinite()) throw InputError("The statistics of crowns hold a value that is not a number.");
  return matrix;
}

std::array<double*, 6> bounds_of(LikenessModel& model) {
  return {&model.type_weight, &model.side_weight,   &model.type_bound,
          &model.side_bound,  &model.strange_bound, &model.refused_bound};
}

}  // namespace

LikenessModel load_likeness(const std::filesystem::path& path) {
  const TensorFile file = read_safetensors(path);
  LikenessModel model;
  model.metadata = file.metadata;
  const Eigen::MatrixXd bounds = matrix_of(file, "bounds");
  const auto members = bounds_of(model);
  if (bounds.size() != static_cast<Eigen::Index>(members.size()))
    throw InputError("The statistics of crowns have other bounds than this program knows.");
  for (std::size_t i = 0; i < members.size(); ++i) *members[i] = bounds(static_cast<Eigen::Index>(i));
  for (std::size_t t = 0; t < model.types.size(); ++t) {
    TypeStatistics& type = model.types[t];
    const std::string suffix = "_" + std::to_string(t);
    type.mean_offsets = matrix_of(file, "mean_offsets" + suffix);
    type.modes = matrix_of(file, "modes" + suffix);
    type.own = {matrix_of(file, "own_mean" + suffix), matrix_of(file, "own_root" + suffix)};
    type.side = matrix_of(file, "side" + suffix);
    type.others = {matrix_of(file, "others_mean" + suffix), matrix_of(file, "others_root" + suffix)};
    const auto places = static_cast<Eigen::Index>(CrownTraits::place_count);
    const auto dimensions = static_cast<Eigen::Index>(CrownTraits::agreement_count) + type.modes.cols() + 1;
    bool fits = type.mean_offsets.size() == places && type.modes.rows() == places && type.side.size() == dimensions;
    for (const CrownDistribution* d : {&type.own, &type.others})
      fits = fits && d->mean.size() == dimensions && d->root.rows() == dimensions && d->root.cols() == dimensions &&
             (d->root.diagonal().array() > 0).all();
    if (!fits) throw InputError("The statistics of crowns are damaged for tooth type " + std::to_string(t) + ".");
  }
  return model;
}

void save_likeness(const LikenessModel& model, const std::filesystem::path& path) {
  TensorFile file;
  file.metadata = model.metadata;
  LikenessModel copy = model;
  Eigen::VectorXd bounds(6);
  Eigen::Index place = 0;
  for (const double* bound : bounds_of(copy)) bounds[place++] = *bound;
  file.tensors["bounds"] = tensor_of(bounds);
  for (std::size_t t = 0; t < model.types.size(); ++t) {
    const TypeStatistics& type = model.types[t];
    const std::string suffix = "_" + std::to_string(t);
    file.tensors["mean_offsets" + suffix] = tensor_of(type.mean_offsets);
    file.tensors["modes" + suffix] = tensor_of(type.modes);
    file.tensors["own_mean" + suffix] = tensor_of(type.own.mean);
    file.tensors["own_root" + suffix] = tensor_of(type.own.root);
    file.tensors["others_mean" + suffix] = tensor_of(type.others.mean);
    file.tensors["side" + suffix] = tensor_of(type.side);
    file.tensors["others_root" + suffix] = tensor_of(type.others.root);
  }
  write_safetensors(path, file);
}

}  // namespace rhizodont
