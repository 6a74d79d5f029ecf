// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/segment.hpp"

#include "base/option_range.hpp"
#include "base/with_threads.hpp"
#include "networks/scan_network.hpp"
#include "rhizodont/error.hpp"
#include "segment/arch_model.hpp"
#include "segment/label_scan.hpp"
#include "segment/teeth_reading.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>

namespace rhizodont {

struct SegmentModels::Content {
  ScanNetwork network;
  ArchModel arch;
};

namespace {

void require_in_range(const SegmentOptions& options) {
  require_ranges("the search for teeth", {{"millimetres_per_unit", options.millimetres_per_unit, OptionRange::above(0)},
                                          {"threads", options.threads, OptionRange::at_least(0)}});
  for (const auto& [fdi, place] : options.teeth)
    if (!is_permanent_tooth(fdi) || !place.allFinite())
      throw UsageError(is_permanent_tooth(fdi) ? fmt::format("The place of tooth {} is no place.", fdi)
                                               : fmt::format("{} is no permanent tooth.", fdi));
  for (const int fdi : options.missing)
    if (!is_permanent_tooth(fdi)) throw UsageError(fmt::format("{} is no permanent tooth.", fdi));
}

/// Triangles that the search can work with, in millimetres.
TriangleMesh usable(const TriangleMesh& scan, double millimetres_per_unit) {
  TriangleMesh mesh;
  mesh.vertices = scan.vertices;
  const auto n = static_cast<std::int32_t>(scan.vertices.size());
  for (Point& p : mesh.vertices) {
    p *= millimetres_per_unit;
    if (!p.allFinite()) throw InputError("The scan has coordinates that are not finite numbers.");
  }
  for (const Triangle& t : scan.triangles) {
    if (std::any_of(t.begin(), t.end(), [&](std::int32_t v) { return v < 0 || v >= n; }))
      throw InputError("The scan has a triangle whose corner is not among its vertices.");
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
  }
  return mesh;
}

/// A scan of a jaw is some centimetres across.
void require_size(const TriangleMesh& scan) {
  constexpr double least_mm = 15, most_mm = 160;
  if (scan.triangles.empty()) throw InputError("The scan has no triangles.");
  Eigen::AlignedBox3d box;  // of what has a surface
  for (const Triangle& t : scan.triangles)
    for (const std::int32_t v : t) box.extend(scan.vertices[static_cast<std::size_t>(v)]);
  const double across = box.diagonal().norm();
  if (across < least_mm)
    throw InputError(
        fmt::format("This is {:.2f} mm across: too small for a jaw. A single crown goes to complete; if the scan is in "
                    "another unit, "
                    "say so (--unit).",
                    across));
  if (across > most_mm)
    throw InputError(fmt::format(
        "This is {:.0f} mm across: too large for a jaw. If the scan is in another unit, say so (--unit).", across));
}

}  // namespace

SegmentModels::SegmentModels(std::shared_ptr<const Content> content) : content_(std::move(content)) {}
SegmentModels::SegmentModels(SegmentModels&&) noexcept = default;
SegmentModels& SegmentModels::operator=(SegmentModels&&) noexcept = default;
SegmentModels::~SegmentModels() = default;

std::vector<std::filesystem::path> segment_model_files(const std::filesystem::path& folder) {
  return {folder / "segment.safetensors", folder / "arch.safetensors"};
}

bool SegmentModels::are_in(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::exists(segment_model_files(folder).front(), ignored);
}

SegmentModels SegmentModels::load(const std::filesystem::path& folder) {
  const std::vector<std::filesystem::path> files = segment_model_files(folder);
  return SegmentModels(
      std::make_shared<const Content>(Content{ScanNetwork::load(files[0]), load_arch_model(files[1])}));
}

SegmentedScan segment_scan(const TriangleMesh& scan, const SegmentModels& models, const SegmentOptions& options) {
  require_in_range(options);
  const TriangleMesh mesh = usable(scan, options.millimetres_per_unit);
  require_size(mesh);
  const SegmentModels::Content& content = models.content();
  return with_threads(options.threads,
                      [&] { return label_scan(mesh, read_teeth(mesh, content.network), content.arch, options); });
}

}  // namespace rhizodont
