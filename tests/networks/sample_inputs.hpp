// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/completion_network.hpp"
#include "networks/surface_sample.hpp"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <random>

namespace rhizodont::testing {

inline std::filesystem::path model_file(const char* name) {
  return std::filesystem::path(RHIZODONT_SOURCE_DIR) / "models" / name;
}

/// Points of a bumpy cap, of a tooth's size; the number gives form, type and axis.
inline CrownPoints cap_points(unsigned number, int count) {
  std::mt19937 random(number);
  std::uniform_real_distribution<float> uniform(-1, 1);
  CrownPoints crown;
  crown.type = static_cast<int>(number % 17);
  crown.form_axis = 0.1F * Eigen::Vector2f(uniform(random), uniform(random));
  const float width = 0.35F + 0.05F * uniform(random);
  for (int i = 0; i < count; ++i) {
    const float angle = std::numbers::pi_v<float> * uniform(random), height = 0.5F * (1 + uniform(random));
    const float radius = width * std::sqrt(1 - 0.8F * height * height) * (1 + 0.1F * std::cos(4 * angle));
    crown.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.5F * height - 0.25F);
  }
  return crown;
}

/// A surface of n vertices with made-up operators: what matters is that all of it takes part.
inline SurfaceSample made_surface(int vertices, int eigenvectors) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  SurfaceSample s;
  s.vertices = vertices;
  s.eigenvectors = eigenvectors;
  for (int i = 0; i < vertices * surface_feature_count; ++i) s.features.push_back(uniform(random));
  for (int v = 0; v < vertices; ++v) s.mass.push_back((1.5F + uniform(random)) / static_cast<float>(vertices));
  for (int k = 0; k < eigenvectors; ++k) s.eigenvalues.push_back(static_cast<float>(k));
  for (int i = 0; i < vertices * eigenvectors; ++i) s.basis.push_back(uniform(random));
  s.first.push_back(0);
  for (int v = 0; v < vertices; ++v) {
    for (int e = 0; e < 7; ++e) {
      s.neighbours.push_back((v + e * e * 11) % vertices);
      s.gradient_x.push_back(uniform(random));
      s.gradient_y.push_back(uniform(random));
    }
    s.first.push_back(static_cast<std::int32_t>(s.neighbours.size()));
  }
  return s;
}

}  // namespace rhizodont::testing
