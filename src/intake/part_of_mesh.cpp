// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "intake/part_of_mesh.hpp"

#include <cstddef>

namespace rhizodont {

std::vector<std::int64_t> ids_in_whole(const Error& error, const std::vector<int>& old_vertices,
                                       const std::vector<int>& old_triangles) {
  if (error.kind() == ElementKind::other) return {};
  const bool of_vertices = error.kind() == ElementKind::vertices || error.kind() == ElementKind::vertex_pairs;
  const bool in_pairs = error.kind() == ElementKind::vertex_pairs || error.kind() == ElementKind::triangle_pairs;
  const std::vector<int>& old = of_vertices ? old_vertices : old_triangles;
  const std::vector<std::int64_t>& ids = error.elements();
  const std::size_t together = in_pairs ? 2 : 1;
  std::vector<std::int64_t> whole;
  for (std::size_t k = 0; k + together <= ids.size(); k += together) {
    const std::size_t before = whole.size();
    for (std::size_t i = k; i < k + together; ++i)
      if (ids[i] >= 0 && static_cast<std::size_t>(ids[i]) < old.size())
        whole.push_back(old[static_cast<std::size_t>(ids[i])]);
    if (whole.size() < before + together) whole.resize(before);
  }
  return whole;
}

}  // namespace rhizodont
