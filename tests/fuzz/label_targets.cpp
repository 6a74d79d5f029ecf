// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Files beside a scan: labels of Teeth3DS, palettes, root lengths.
#include "fuzz/targets.hpp"
#include "io/scan_labels.hpp"
#include "report/scan_input.hpp"

#include <algorithm>
#include <cmath>

namespace rhizodont::test {
namespace {

/// Two triangles; the file has a fifth vertex, merged with the first.
MeshFile small_scan() {
  MeshFile scan;
  scan.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  scan.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scan.file_vertices = {0, 1, 2, 3};
  scan.mesh_vertices = {0, 1, 2, 3, 0};
  return scan;
}

}  // namespace

bool fuzz_labels(std::string_view bytes) {
  static const MeshFile scan = small_scan();
  RawLabels labels;
  if (!is_taken([&] { labels = labels_from_teeth3ds(bytes, scan); })) return false;
  require_rule(labels.per_vertex.size() == scan.mesh.vertices.size(), "labels of other vertices");
  require_rule(std::all_of(labels.per_vertex.begin(), labels.per_vertex.end(), [](int label) { return label >= 0; }),
               "a label below 0");
  return true;
}

bool fuzz_palette(std::string_view bytes) {
  std::vector<PaletteEntry> palette;
  if (!is_taken([&] { palette = read_palette(bytes); })) return false;
  require_rule(!palette.empty(), "a palette without entries");
  return true;
}

bool fuzz_root_lengths(std::string_view bytes) {
  std::map<int, double> lengths;
  if (!is_taken([&] { lengths = read_root_lengths(bytes); })) return false;
  for (const auto& [fdi, mm] : lengths) require_rule(fdi > 0 && std::isfinite(mm), "a length that is none");
  return true;
}

}  // namespace rhizodont::test
