// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/mean_crowns.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <cmath>
#include <string>

namespace rhizodont {
namespace {

StoredTensor tensor_of(const std::vector<Point>& points) {
  std::vector<float> values;
  for (const Point& p : points)
    for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(p[i]));
  return store_floats(values, {static_cast<std::int64_t>(points.size()), 3});
}

std::vector<Point> points_of(const TensorFile& file, const std::string& name) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end()) throw InputError("The atlas of mean crowns lacks the tensor " + name + ".");
  const StoredTensor& tensor = found->second;
  if (tensor.type == TensorType::int32 || tensor.shape.size() != 2 || tensor.shape[1] != 3)
    throw InputError("The tensor " + name + " in the atlas of mean crowns is not a list of points.");
  const std::vector<float> values = load_floats(tensor);
  std::vector<Point> points;
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    points.emplace_back(static_cast<double>(values[i]), static_cast<double>(values[i + 1]),
                        static_cast<double>(values[i + 2]));
    if (!points.back().allFinite()) throw InputError("The atlas of mean crowns holds a value that is not a number.");
  }
  return points;
}

}  // namespace

Atlas load_atlas(const std::filesystem::path& path) {
  const TensorFile file = read_safetensors(path);
  Atlas atlas;
  for (int type = 0; type < tooth_type_count; ++type) {
    MeanCrown& mean = atlas.types[static_cast<std::size_t>(type)];
    const std::string suffix = std::to_string(type);
    mean.crown.points = points_of(file, "crown_" + suffix);
    mean.crown.normals = points_of(file, "crown_normals_" + suffix);
    mean.anchors = points_of(file, "anchors_" + suffix);
    if (mean.crown.points.size() != mean.crown.normals.size() || mean.crown.points.empty() || mean.anchors.empty())
      throw InputError("The atlas of mean crowns is incomplete for tooth type " + suffix + ".");
    for (Eigen::Vector3d& n : mean.crown.normals) {
      if (!(n.norm() > 0.5)) throw InputError("The atlas of mean crowns holds a normal without length.");
      n.normalize();
    }
  }
  return atlas;
}

void save_atlas(const Atlas& atlas, const std::filesystem::path& path) {
  TensorFile file;
  for (int type = 0; type < tooth_type_count; ++type) {
    const MeanCrown& mean = atlas.types[static_cast<std::size_t>(type)];
    const std::string suffix = std::to_string(type);
    file.tensors["crown_" + suffix] = tensor_of(mean.crown.points);
    file.tensors["crown_normals_" + suffix] = tensor_of(mean.crown.normals);
    file.tensors["anchors_" + suffix] = tensor_of(mean.anchors);
  }
  file.metadata["content"] =
      "Mean crowns (oriented points) and mean whole teeth (points) of the 16 permanent tooth types, canonical pose, "
      "unit 12 mm";
  file.metadata["attribution"] =
      "derived from \"Permanent Teeth\", University of Dundee School of Dentistry (E. McDougall, A. Mason, "
      "M. Roughley), CC BY 4.0";
  write_safetensors(path, file);
}

}  // namespace rhizodont
