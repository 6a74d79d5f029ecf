// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/io.hpp"
#include "rhizodont/models.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace rhizodont {

/// What a tooth keeps of a crown: open at its base. Throws as `take_crown`.
TriangleMesh open_crown(const TriangleMesh& crown, int fdi, const CompletionModels& models);

/// The crown's samples and the corrected prediction, oriented, as the product's own indicator function gets them.
OrientedPoints guiding_samples(const TriangleMesh& crown, int fdi, const CompletionModels& models);

/// A generated tooth with one of life's marks, and its crown as a scanner has it, both mm.
struct MarkedTooth {
  TriangleMesh crown, tooth;
};
/// @param mark  none, worn, bracket (or attachment), worn-bracket or decayed
/// Depends on the arguments alone. Throws UsageError for another mark, and as `generate_tooth` and `trim_clean`.
MarkedTooth marked_tooth(const std::filesystem::path& data, int fdi, std::uint64_t seed, const std::string& mark);

/// The crown with `deviation_mm` per vertex, its distance from a surface, at most `most_mm`. Two last vertices,
/// which no triangle has, carry 0 and `most_mm`, so that pictures of several crowns share one scale.
MeshFile with_deviation(const TriangleMesh& crown, const TriangleMesh& surface, double most_mm);

/// The mesh with `quality` per vertex, that of its worst triangle, on a scale from 0 to 1 as above.
MeshFile with_quality(const TriangleMesh& mesh);

/// Of a completed tooth what lies within `reach_mm` of the transition of another completion of the same crown, with
/// `source`. Throws InputError for meshes without it and without a transition.
MeshFile near_transition(const MeshFile& tooth, const MeshFile& smoothed, double reach_mm);

}  // namespace rhizodont
