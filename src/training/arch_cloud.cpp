// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/arch_cloud.hpp"

#include "mesh/geometry.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Geometry>

#include <string>

namespace rhizodont {
namespace {

std::vector<std::int64_t> of_size(std::size_t n, std::int64_t each) { return {static_cast<std::int64_t>(n), each}; }

void save(const LabelledCloud& scan, const std::filesystem::path& path) {
  const std::size_t n = scan.cloud.size();
  TensorFile file;
  file.tensors["positions"] = store_floats(scan.cloud.positions, of_size(n, 3));
  file.tensors["normals"] = store_floats(scan.cloud.normals, of_size(n, 3));
  file.tensors["curvatures"] = store_floats(scan.cloud.curvatures, of_size(n, scan_curvature_count));
  const std::vector<std::int32_t> teeth(scan.teeth.begin(), scan.teeth.end());
  file.tensors["teeth"] = store_integers(teeth, of_size(n, 1));
  file.metadata["jaw"] = scan.upper ? "upper" : "lower";
  write_safetensors(path, file);
}

LabelledCloud load(const std::filesystem::path& path) {
  const TensorFile file = read_safetensors(path);
  for (const char* name : {"positions", "normals", "curvatures", "teeth"})
    if (!file.tensors.contains(name)) throw InputError(path.string() + " holds no points of a scan.");
  LabelledCloud scan;
  scan.cloud = {load_floats(file.tensors.at("positions")), load_floats(file.tensors.at("normals")),
                load_floats(file.tensors.at("curvatures"))};
  for (const std::int32_t tooth : load_integers(file.tensors.at("teeth")))
    scan.teeth.push_back(static_cast<std::uint8_t>(tooth));
  const auto jaw = file.metadata.find("jaw");
  scan.upper = jaw != file.metadata.end() && jaw->second == "upper";
  if (scan.teeth.size() != scan.cloud.size()) throw InputError(path.string() + " is damaged.");
  return scan;
}

}  // namespace

ScanFrame true_frame(const GeneratedArch& arch) {
  const bool upper = arch.jaw == Jaw::upper;
  const Eigen::Vector3d occlusal(0, upper ? -1 : 1, 0), front(0, 0, 1);
  Eigen::Matrix3d in_arch;
  in_arch.row(0) = front.cross(occlusal);
  in_arch.row(1) = front;
  in_arch.row(2) = occlusal;
  return {in_arch * arch.rotation.transpose(), area_centroid(arch.scan)};
}

LabelledCloud make_arch_cloud(const ArchFamily& family, std::uint64_t seed, const ArchDrawOptions& options) {
  const GeneratedArch arch = sample_arch(family, seed, options);
  ScanPoints points = scan_points(arch.scan, true_frame(arch));
  LabelledCloud scan;
  scan.upper = arch.jaw == Jaw::upper;
  for (const int v : points.vertices)
    scan.teeth.push_back(static_cast<std::uint8_t>(arch.fdi[static_cast<std::size_t>(v)]));
  scan.cloud = std::move(points.cloud);
  return scan;
}

LabelledCloud kept_arch_cloud(const ArchFamily& family, std::uint64_t seed, const std::filesystem::path& folder,
                              const ArchDrawOptions& options) {
  const std::filesystem::path path = folder / ("arch_" + std::to_string(seed) + ".safetensors");
  if (std::filesystem::exists(path)) return load(path);
  LabelledCloud scan = make_arch_cloud(family, seed, options);
  std::filesystem::create_directories(folder);
  save(scan, path);
  return scan;
}

}  // namespace rhizodont
