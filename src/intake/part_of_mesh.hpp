// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/error.hpp"

#include <cstdint>
#include <vector>

namespace rhizodont {

/// The ids of an error on a part of a mesh as the whole numbers them: `old_vertices` and `old_triangles` hold the
/// number in the whole of each of the part's. What the whole has not (of something built on the part, or of neither
/// kind) is left out, of pairs both.
std::vector<std::int64_t> ids_in_whole(const Error& error, const std::vector<int>& old_vertices,
                                       const std::vector<int>& old_triangles);

/// What `work` on a part of a mesh gives; if it throws InputError or NoResultError, their ids are those of the whole.
template <class Work>
auto on_part(const std::vector<int>& old_vertices, const std::vector<int>& old_triangles, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(error.what(), ids_in_whole(error, old_vertices, old_triangles), error.kind());
  } catch (const NoResultError& error) {
    throw NoResultError(error.what(), ids_in_whole(error, old_vertices, old_triangles), error.kind());
  }
}

}  // namespace rhizodont
