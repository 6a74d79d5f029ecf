// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/tooth_family.hpp"
#include "networks/surface_sample.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/mesh.hpp"

#include <cstdint>
#include <vector>

namespace rhizodont {

/// How crowns with skirts are made.
struct SkirtSampleOptions {
  int type = -1;                   ///< tooth type 0..15, or -1: drawn anew for each sample
  double finest_edge_mm = 0.28;    ///< edges of the scan's triangles are drawn between these, 0.1..1
  double coarsest_edge_mm = 0.75;  ///< at least the finest
  double clean_share = 0.3;        ///< share of crowns that have no skirt, 0..1
  double hole_share = 0.2;         ///< share of crowns with a missing patch or two on the tooth, 0..1
  double largest_noise = 0.08;     ///< standard deviation of the noise along the normals over the edges' length, 0..0.3
};

/// A crown as it is cut from a scan, with what of it is tooth.
struct SkirtSample {
  TriangleMesh mesh;                   ///< one piece, every vertex in use; border ragged; millimetres, tooth's frame
  std::vector<std::uint8_t> is_tooth;  ///< per vertex: 1 tooth, 0 skirt
  int type = 0;                        ///< 0..15
  bool has_skirt = false;              ///< one was added (it may have been cut off again)
  bool mirrored = false;               ///< to the right side of the mouth; types are those of the left
};

/// Makes crown number `seed`: a tooth of the families, cut along its gum line, mirrored half of the time, with what a
/// segmented scan leaves around it: bands of gum that bulge outwards and fall off, webs towards the neighbours, flares
/// and spikes, ragged edges with holes and bridges; or clean, cut raggedly or with a rim that turns inwards as where a
/// cap was taken off. The label says what lies on the tooth's own surface, as the paper's labelling does (section 3.2).
/// Depends on seed and options alone. Throws UsageError for bad options, NoResultError if 20 draws came to nothing.
SkirtSample make_skirt_sample(const ToothFamilies& families, std::uint64_t seed,
                              const SkirtSampleOptions& options = {});

/// The same crown as the skirt network is trained on it: what it looks at (skirt_features), labelled.
/// `eigenvectors`: >= 1. Throws as make_skirt_sample and skirt_features.
SurfaceSample make_skirt_training_sample(const ToothFamilies& families, std::uint64_t seed,
                                         const SkirtSampleOptions& options, int eigenvectors);

/// The paper's labelling: a vertex of a crown is tooth if it lies within `tolerance_mm` (> 0) of the restored tooth's
/// surface, else skirt. Throws UsageError for another tolerance, InputError if the restored tooth has no area.
std::vector<std::uint8_t> label_by_restored(const TriangleMesh& crown, const TriangleMesh& restored,
                                            double tolerance_mm = 0.05);

/// A sample as a file; the vertex attribute `tooth` is its label.
MeshFile skirt_sample_file(const SkirtSample& sample);

/// A crown with the vertex attribute `tooth`, 1 tooth and 0 skirt; what its triangles carry is left out. `is_tooth`: a
/// number for each vertex, as of `label_by_restored`.
MeshFile labelled_crown_file(MeshFile crown, const std::vector<std::uint8_t>& is_tooth);

}  // namespace rhizodont
