// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/root_length_correction.hpp"

#include "completion/type_table.hpp"
#include "mesh/geometry.hpp"
#include "teeth/fdi.hpp"

#include <algorithm>

namespace rhizodont {
namespace {

constexpr const char* key = "root_length.correction_mm";
constexpr double shortest = 0.8, longest = 1.25;  // a short root cut high is not to be halved by a type's mean

}  // namespace

double root_length_correction(const std::map<std::string, std::string>& metadata, int fdi) {
  const auto found = metadata.find(key);
  if (found == metadata.end() || !is_permanent_tooth(fdi)) return 0;
  const TypeTable table = read_type_table(found->second, 1, key);
  const auto entry = table.find(fdi_of_type(tooth_type_of_fdi(fdi), false));
  return entry == table.end() ? 0 : entry->second.front();
}

void note_root_length_corrections(const std::map<int, double>& by_tooth, std::map<std::string, std::string>& metadata) {
  metadata.erase(key);
  if (by_tooth.empty()) return;
  TypeTable table;
  for (const auto& [fdi, mm] : by_tooth) table[fdi] = {mm};
  metadata[key] = type_table_text(table);
}

void lengthen_root(OrientedPoints& points, const Eigen::Vector3d& axis, double level, double mm) {
  if (mm == 0 || points.points.empty()) return;
  const double length = level - extent_along(points.points, axis).first;
  if (!(length > 0)) return;
  const double factor = std::clamp(1 + mm / length, shortest, longest);
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const double below = points.points[i].dot(axis) - level;
    if (below >= 0) continue;
    points.points[i] += (factor - 1) * below * axis;
    Eigen::Vector3d& normal = points.normals[i];
    normal = (normal + (1 / factor - 1) * normal.dot(axis) * axis).normalized();
  }
}

double length_before_correction(double length, double mm) {
  // Where the bounds did not hold it back, the length before lies between them; where one did, it lies there.
  return std::clamp(length - mm, length / longest, length / shortest);
}

}  // namespace rhizodont
