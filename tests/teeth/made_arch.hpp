// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/tooth_labels.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/mesh.hpp"
#include "teeth/label_numbers.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace rhizodont::test {

/// A sheet of gum with a dome for each tooth, and the teeth's FDI numbers per vertex.
struct MadeArch {
  TriangleMesh mesh;
  std::vector<int> fdi;

  int nearest_vertex(double x, double y) const {
    const auto distance = [&](const Point& p) { return std::hypot(p.x() - x, p.y() - y); };
    return static_cast<int>(
        std::min_element(mesh.vertices.begin(), mesh.vertices.end(),
                         [&](const Point& a, const Point& b) { return distance(a) < distance(b); }) -
        mesh.vertices.begin());
  }
};

/// Where the tooth at a place of 16 (from the patient's right) stands: z occlusal, front at -y, the patient's left at
/// +x in a lower jaw and at -x in an upper one.
inline Point place_in_arch(int place, Jaw jaw) {
  const double along = (place - 8.5) / 7.5;
  return {(jaw == Jaw::lower ? 30 : -30) * along, 40 * along * along - 20, 0};
}

/// Precondition: FDI numbers of permanent teeth.
inline MadeArch made_arch(const std::vector<int>& teeth, Jaw jaw = Jaw::lower) {
  constexpr int nx = 110, ny = 90;
  constexpr double step = 0.7, radius = 2;
  std::vector<std::pair<int, Point>> stand;
  for (int place = 1; place <= 16; ++place) {
    const int fdi = fdi_of_arch_place(place, 16, jaw);
    if (std::find(teeth.begin(), teeth.end(), fdi) != teeth.end()) stand.emplace_back(fdi, place_in_arch(place, jaw));
  }
  MadeArch arch;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      Point p((i - nx / 2) * step, (j - ny / 2) * step, 0);
      int number = 0;
      for (const auto& [fdi, at] : stand) {
        const double d = std::hypot(p.x() - at.x(), p.y() - at.y());
        if (d >= radius) continue;
        number = fdi;
        p.z() = 6 * (1 - d * d / (radius * radius));
      }
      arch.mesh.vertices.push_back(p);
      arch.fdi.push_back(number);
    }
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      const int v = j * nx + i;
      arch.mesh.triangles.push_back({v, v + 1, v + nx + 1});
      arch.mesh.triangles.push_back({v, v + nx + 1, v + nx});
    }
  return arch;
}

inline std::vector<int> teeth_of(Jaw jaw, int last = 7) {
  std::vector<int> teeth;
  for (const int quadrant : jaw == Jaw::upper ? std::vector{1, 2} : std::vector{3, 4})
    for (int k = 1; k <= last; ++k) teeth.push_back(10 * quadrant + k);
  return teeth;
}

/// Any turn and shift, the same for the same seed.
inline void pose(TriangleMesh& mesh, int seed) {
  const Eigen::Quaterniond turn(std::cos(1.3 * seed), std::sin(2.1 * seed), std::cos(0.7 * seed + 1),
                                std::sin(0.4 * seed + 2));
  for (Point& p : mesh.vertices) p = turn.normalized() * p + Point(30.0 * seed, -7, 11);
}

/// The numbers put in other's place.
inline std::vector<int> renumbered(std::vector<int> labels, const std::function<int(int)>& number) {
  for (int& label : labels) label = number(label);
  return labels;
}

/// Expects an InputError whose sentence holds `words`.
inline void expect_input_error(const std::function<void()>& call, const std::string& words) {
  try {
    call();
    FAIL() << "accepted, expected: " << words;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what() << "\nshould hold: " << words;
  }
}

}  // namespace rhizodont::test
