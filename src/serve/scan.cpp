// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/scan.hpp"

#include "io/scan_labels.hpp"
#include "rhizodont/hash.hpp"
#include "rhizodont/tooth_file.hpp"
#include "serve/answers.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <mutex>

namespace rhizodont::serve {
namespace {

constexpr double largest_tooth_mm = 25;

}  // namespace

Scan read_sent_scan(std::string_view bytes, const std::string& name, const ServeLimits& limits) {
  static std::mutex one_at_a_time;  // bounds memory, no state
  const std::scoped_lock lock(one_at_a_time);
  Scan scan;
  scan.sha256 = sha256_of_bytes(bytes);
  scan.file = read_mesh(bytes, name);
  const std::size_t triangles = scan.file.mesh.triangles.size();
  if (triangles > limits.triangles)
    throw Refusal(
        413, fmt::format("The scan has {} triangles; this service takes {} at most.", triangles, limits.triangles));
  scan.fdi_in_name = fdi_in_name(name);
  scan.has_label_array = has_label_array(scan.file);
  Eigen::AlignedBox3d box;
  for (const Point& p : scan.file.mesh.vertices) box.extend(p);
  scan.looks_like_arch = !box.isEmpty() && box.diagonal().norm() > largest_tooth_mm;
  return scan;
}

}  // namespace rhizodont::serve
