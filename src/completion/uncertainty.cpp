// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// H. Papadopoulos, K. Proedrou, V. Vovk, A. Gammerman, "Inductive confidence machines for regression", 2002: intervals
// whose widths follow a predicted error and whose scale is a quantile on held-out samples.
#include "completion/uncertainty.hpp"

#include "completion/type_table.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/nearest_vertex.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/root_steering.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace rhizodont {
namespace {

constexpr std::array<std::pair<const char*, double UncertaintyScales::*>, 4> fields{{
    {"uncertainty.length_low", &UncertaintyScales::length_low},
    {"uncertainty.length_high", &UncertaintyScales::length_high},
    {"uncertainty.apex", &UncertaintyScales::apex},
    {"uncertainty.surface", &UncertaintyScales::surface},
}};

constexpr const char* types_key = "uncertainty.types";

}  // namespace

std::optional<UncertaintyScales> uncertainty_scales(const std::map<std::string, std::string>& metadata, int fdi) {
  UncertaintyScales scales;
  for (const auto& [name, member] : fields) {
    const auto found = metadata.find(name);
    if (found == metadata.end()) return std::nullopt;
    try {
      scales.*member = std::stod(found->second);
    } catch (const std::logic_error&) {
      throw InputError(fmt::format("The weight file's {} is not a number.", name));
    }
  }
  const auto types = metadata.find(types_key);
  if (types == metadata.end() || !is_permanent_tooth(fdi)) return scales;
  const TypeTable table = read_type_table(types->second, 3, types_key);
  const auto entry = table.find(fdi_of_type(tooth_type_of_fdi(fdi), false));
  if (entry == table.end()) return scales;
  return UncertaintyScales{entry->second[0], entry->second[1], entry->second[2], scales.surface};
}

void note_uncertainty_scales(const UncertaintyScales& scales, std::map<std::string, std::string>& metadata,
                             const std::map<int, UncertaintyScales>& by_tooth) {
  for (const auto& [name, member] : fields) metadata[name] = fmt::format("{:.4f}", scales.*member);
  metadata.erase(types_key);
  if (by_tooth.empty()) return;
  TypeTable table;
  for (const auto& [fdi, of_type] : by_tooth) table[fdi] = {of_type.length_low, of_type.length_high, of_type.apex};
  metadata[types_key] = type_table_text(table);
}

double expected_distance_at_apex(const PredictedTooth& predicted, const Eigen::Vector3d& growth_axis) {
  constexpr std::size_t deepest = 16;
  const std::vector<Point>& points = predicted.cloud.points;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto last = order.begin() + deepest;
  std::partial_sort(order.begin(), last, order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].dot(growth_axis) < points[b].dot(growth_axis);
  });
  return std::accumulate(order.begin(), last, 0.0,
                         [&](double sum, std::size_t i) { return sum + predicted.expected_distance[i]; }) /
         static_cast<double>(deepest);
}

std::pair<double, double> length_interval(double length, double expected_at_apex, const UncertaintyScales& scales) {
  const auto possible = [](double x) { return std::clamp(x, shortest_root_mm, longest_root_mm); };
  return {std::min(length, possible(length + scales.length_low * expected_at_apex)),
          std::max(length, possible(length + scales.length_high * expected_at_apex))};
}

std::vector<double> expected_distances(const TriangleMesh& tooth, const PreparedCrown& crown,
                                       const PredictedTooth& predicted, double reach) {
  constexpr std::size_t neighbours = 6;
  const NearestVertexIndex points(predicted.cloud.points);
  std::vector<double> result(tooth.vertices.size(), 0.0);
  tbb::parallel_for(crown.mesh.vertices.size(), tooth.vertices.size(), [&](std::size_t v) {
    double sum = 0;
    for (const NearVertex& near : points.nearest(tooth.vertices[v], neighbours))
      sum += predicted.expected_distance[static_cast<std::size_t>(near.index)];
    const double away = crown.surface.closest(tooth.vertices[v]).distance / reach;
    result[v] = sum / neighbours * (1 - std::exp(-away * away));
  });
  return result;
}

}  // namespace rhizodont
