// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/arch_model.hpp"

#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace rhizodont {
namespace {

std::vector<int> teeth_of_model() {
  std::vector<int> teeth;
  for (const int quadrant : {1, 2, 3, 4})
    for (int place = 1; place <= 7; ++place) teeth.push_back(10 * quadrant + place);
  return teeth;
}

std::vector<double> numbers_of(const TensorFile& file, const std::string& name, std::vector<std::int64_t> shape) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end()) throw InputError("The model of the arch lacks the tensor " + name + ".");
  if (found->second.type == TensorType::int32 || found->second.shape != shape)
    throw InputError("The tensor " + name + " in the model of the arch has another shape than it should.");
  std::vector<double> numbers;
  for (const float value : load_floats(found->second)) {
    if (!std::isfinite(value)) throw InputError("The model of the arch holds a value that is not a number.");
    numbers.push_back(static_cast<double>(value));
  }
  return numbers;
}

Eigen::Vector3d row(const std::vector<double>& numbers, std::size_t i) {
  return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

void append(std::vector<float>& numbers, const Eigen::Vector3d& v) {
  for (const double x : v) numbers.push_back(static_cast<float>(x));
}

}  // namespace

void add_third_molars(ArchModel& model) {
  // Third molars are about a tenth smaller than second ones (Wheeler), so they stand nearer than first and second do.
  constexpr double step = 0.95;
  for (const int quadrant : {1, 2, 3, 4}) {
    const auto first = model.teeth.find(10 * quadrant + 6), second = model.teeth.find(10 * quadrant + 7);
    if (first == model.teeth.end() || second == model.teeth.end())
      throw UsageError(fmt::format("The model of the arch lacks molars in quadrant {}.", quadrant));
    ArchTooth third = second->second;
    third.place += step * (second->second.place - first->second.place);
    model.teeth.emplace(10 * quadrant + 8, third);
  }
}

ArchModel load_arch_model(const std::filesystem::path& path) {
  const TensorFile file = read_safetensors(path);
  const std::vector<int> teeth = teeth_of_model();
  const auto n = static_cast<std::int64_t>(teeth.size());
  const std::vector<double> places = numbers_of(file, "places", {n, 3}),
                            occlusal = numbers_of(file, "occlusal", {n, 3}),
                            buccal = numbers_of(file, "buccal", {n, 3}),
                            covariances = numbers_of(file, "turn_covariances", {n, 3, 3});
  ArchModel model;
  for (std::size_t i = 0; i < teeth.size(); ++i) {
    ArchTooth tooth{row(places, i), {row(occlusal, i), row(buccal, i)}, {}};
    for (const Eigen::Vector3d* direction : {&tooth.directions.occlusal, &tooth.directions.buccal})
      if (std::abs(direction->norm() - 1) > 1e-3)
        throw InputError("A direction in the model of the arch is not of unit length.");
    for (Eigen::Index r = 0; r < 3; ++r)
      for (Eigen::Index c = 0; c < 3; ++c)
        tooth.turn_covariance(r, c) = covariances[9 * i + static_cast<std::size_t>(3 * r + c)];
    model.teeth.emplace(teeth[i], tooth);
  }
  add_third_molars(model);
  return model;
}

void save_arch_model(const ArchModel& model, const std::filesystem::path& path) {
  std::vector<float> places, occlusal, buccal, covariances;
  const std::vector<int> teeth = teeth_of_model();
  for (const int fdi : teeth) {
    const auto found = model.teeth.find(fdi);
    if (found == model.teeth.end()) throw UsageError(fmt::format("The model of the arch lacks tooth {}.", fdi));
    append(places, found->second.place);
    append(occlusal, found->second.directions.occlusal);
    append(buccal, found->second.directions.buccal);
    for (Eigen::Index r = 0; r < 3; ++r) append(covariances, found->second.turn_covariance.row(r).transpose());
  }
  const auto n = static_cast<std::int64_t>(teeth.size());
  TensorFile file;
  file.tensors["places"] = store_floats(places, {n, 3});
  file.tensors["occlusal"] = store_floats(occlusal, {n, 3});
  file.tensors["buccal"] = store_floats(buccal, {n, 3});
  file.tensors["turn_covariances"] = store_floats(covariances, {n, 3, 3});
  file.metadata["content"] =
      "Mean arches: places and directions of the crowns 11-17, 21-27, 31-37, 41-47, mm, x left, y up, z to the front";
  file.metadata["attribution"] =
      "derived from the statistical crown models of Chen Y. et al., \"Automatic 3D Teeth Reconstruction from Five "
      "Intra-oral Photos Using Parametric Teeth Model\", 2023 (MIT)";
  write_safetensors(path, file);
}

}  // namespace rhizodont
