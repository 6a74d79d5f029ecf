// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", figure 1a-b and section 4.1: crowns
// from a segmented scan.
#include "segment/cut_crowns.hpp"

#include "rhizodont/error.hpp"

#include <fmt/format.h>

namespace rhizodont {
namespace {

void require_a_label_each(const TriangleMesh& scan, const std::vector<int>& labels) {
  if (labels.size() != scan.vertices.size())
    throw InputError(
        fmt::format("There are {} labels for {} vertices of the scan.", labels.size(), scan.vertices.size()));
}

/// The label of all corners; 0 if they differ.
int label_of(const Triangle& t, const std::vector<int>& labels) {
  const int first = labels[static_cast<std::size_t>(t[0])];
  for (const int v : t)
    if (labels[static_cast<std::size_t>(v)] != first) return 0;
  return first;
}

}  // namespace

std::map<int, Submesh> cut_crowns(const TriangleMesh& scan, const std::vector<int>& labels) {
  require_a_label_each(scan, labels);
  std::map<int, std::vector<bool>> part;
  for (std::size_t t = 0; t < scan.triangles.size(); ++t)
    if (const int label = label_of(scan.triangles[t], labels); label != 0)
      part.try_emplace(label, scan.triangles.size(), false).first->second[t] = true;
  std::map<int, Submesh> crowns;
  for (const auto& [label, triangles] : part) crowns.emplace(label, submesh(scan, triangles));
  return crowns;
}

TriangleMesh gum_of(const TriangleMesh& scan, const std::vector<int>& labels) {
  require_a_label_each(scan, labels);
  std::vector<bool> keep;
  for (const Triangle& t : scan.triangles) keep.push_back(label_of(t, labels) == 0);
  return submesh(scan, keep).mesh;
}

}  // namespace rhizodont
