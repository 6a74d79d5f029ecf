// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random_stream.hpp"
#include "completion/crown_panorama.hpp"
#include "completion/likeness.hpp"
#include "families/model_crowns.hpp"
#include "families/tooth_family.hpp"
#include "rhizodont/mesh.hpp"
#include "training/labelled_panoramas.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace rhizodont {

/// A crown as scans give it: mostly cut near the junction, some with notches at the contacts, in a third of them up to
/// near the top, or with remains of gum.
TriangleMesh draw_scanned_crown(const SyntheticTooth& tooth, RandomStream& random);

/// A crown half erupted, or deep in gum: up to more than half of its height is missing. Throws NoResultError where ten
/// gum lines left no disc.
TriangleMesh draw_low_crown(const SyntheticTooth& tooth, RandomStream& random);

/// A crown of a left type (0..15) drawn from its statistical models, left or right; nothing where there are none.
std::optional<SyntheticTooth> draw_model_crown_of_type(const std::vector<ModelCrown>& models, int type,
                                                       RandomStream& random);

/// What to learn from which tooth a crown is.
struct LikenessSample {
  CrownPanorama panorama;
  std::size_t label = 0;  ///< 2 * type (left side), or tooth_count: no crown or little of one
};

/// Of tooth number `seed` of a type: two crowns as scans give them, a low one, and two things that are none
/// (unlike_crown), each seen from a little beside where it should be; then the same, with one thing that is none, of a
/// crown drawn from the statistical models alone, where they have the type. Fewer where a draw came to nothing. Depends
/// on type and seed alone. Throws as generate_tooth.
std::vector<LikenessSample> make_likeness_samples(const ToothFamilies& families, const std::vector<ModelCrown>& models,
                                                  int type, std::uint64_t seed);

/// What the network learns from: `make_likeness_samples` of the first `per_type` teeth of every type, >= 1.
LabelledPanoramas make_likeness_panoramas(const ToothFamilies& families, const std::vector<ModelCrown>& models,
                                          int per_type);

/// Bounds by `per_type` crowns of each type that had no part in the training, every third of them low, and by as many
/// things that are no crown. Throws as likeness_bounds.
LikenessBounds draw_likeness_bounds(const ToothFamilies& families, const ToothClassifier& classifier, int per_type);

}  // namespace rhizodont
