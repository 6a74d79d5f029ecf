// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/likeness_samples.hpp"

#include "base/parallel_tasks.hpp"
#include "completion/tooth_classifier.hpp"
#include "families/crown_crop.hpp"
#include "families/unlike_crowns.hpp"
#include "rhizodont/error.hpp"
#include "teeth/frame.hpp"
#include "training/panorama_view.hpp"
#include "training/sample_numbers.hpp"

#include <optional>

namespace rhizodont {
namespace {

constexpr double paper_share = 0.02, gap_probability = 0.5;
constexpr double skirt_probability = 0.2, skirt_mm = 0.9;

void maybe_add_skirt(TriangleMesh& crown, RandomStream& random) {
  if (random.chance(skirt_probability)) add_skirt_remains(crown, skirt_mm, random);
}

/// Where teeth stand crowded a scanner does not see between them, up to near the edge or the cusps. Nothing where ten
/// gum lines left no disc.
std::optional<TriangleMesh> draw_crowded_crown(const SyntheticTooth& tooth, RandomStream& random) {
  constexpr double side_probability = 0.75, highest_share = 0.85;
  for (int attempt = 0; attempt < 10; ++attempt) {
    GumLine line = draw_gum_line(tooth, paper_share, gap_probability, random);
    for (std::size_t side = 0; side < 2; ++side) {
      if (!random.chance(side_probability)) continue;
      line.gap_mm[side] = random.uniform(0, highest_share) * tooth.crown_height;
      line.gap_width[side] = random.uniform(0.2, 0.6);
    }
    if (auto crown = crop_crown(tooth, line)) return crown;
  }
  return std::nullopt;
}

}  // namespace

TriangleMesh draw_scanned_crown(const SyntheticTooth& tooth, RandomStream& random) {
  constexpr double crowded_probability = 0.35;
  std::optional<TriangleMesh> crown;
  if (random.chance(crowded_probability)) crown = draw_crowded_crown(tooth, random);
  if (!crown) crown = draw_cropped_crown(tooth, paper_share, gap_probability, random).mesh;
  maybe_add_skirt(*crown, random);
  return *std::move(crown);
}

TriangleMesh draw_low_crown(const SyntheticTooth& tooth, RandomStream& random) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    GumLine line = draw_gum_line(tooth, paper_share, gap_probability, random);
    line.offset_mm += random.uniform(0.05, 0.55) * tooth.crown_height;
    auto crown = crop_crown(tooth, line);
    if (!crown) continue;
    maybe_add_skirt(*crown, random);
    return std::move(*crown);
  }
  throw NoResultError("No gum line left a crown in one piece with one border.");
}

std::optional<SyntheticTooth> draw_model_crown_of_type(const std::vector<ModelCrown>& models, int type,
                                                       RandomStream& random) {
  constexpr double factor = 1.2;  // of the models' own deviations: what 95 people vary less than all
  std::vector<const ModelCrown*> fitting;
  for (const ModelCrown& model : models)
    if (model.mean.type == type) fitting.push_back(&model);
  if (fitting.empty()) return std::nullopt;
  return draw_model_crown(*fitting[random.index(fitting.size())], factor, random);
}

std::vector<LikenessSample> make_likeness_samples(const ToothFamilies& families, const std::vector<ModelCrown>& models,
                                                  int type, std::uint64_t seed) {
  RandomStream random(seed, 700 + static_cast<std::uint64_t>(type));
  std::vector<LikenessSample> samples;
  const auto add = [&](std::size_t label, const auto& make) {
    try {
      const TriangleMesh crown = make();
      const PanoramaView view = view_from_beside(crown, growth_axis(crown), random);
      samples.push_back({crown_panorama(crown, view.axis, view.centre), label});
    } catch (const Error&) {  // a gum line or a cut that leaves nothing
    }
  };
  const std::size_t label = 2 * static_cast<std::size_t>(type);
  const auto add_crowns_of = [&](const SyntheticTooth& tooth, int strangers) {
    add(label, [&] { return draw_scanned_crown(tooth, random); });
    add(label, [&] { return draw_scanned_crown(tooth, random); });
    add(label, [&] { return draw_low_crown(tooth, random); });
    for (int i = 0; i < strangers; ++i) {
      const auto kind = static_cast<UnlikeKind>(random.index(unlike_kind_count));
      add(tooth_count, [&] {
        return unlike_crown(draw_cropped_crown(tooth, paper_share, gap_probability, random).mesh, kind, random);
      });
    }
  };
  add_crowns_of(generate_tooth(families, type, seed), 2);
  if (const auto crown = draw_model_crown_of_type(models, type, random)) add_crowns_of(*crown, 1);
  return samples;
}

LabelledPanoramas make_likeness_panoramas(const ToothFamilies& families, const std::vector<ModelCrown>& models,
                                          int per_type) {
  std::vector<std::vector<LikenessSample>> of_tooth(static_cast<std::size_t>(per_type) * tooth_type_count);
  parallel_tasks(of_tooth.size(), [&](std::size_t i) {
    try {
      of_tooth[i] =
          make_likeness_samples(families, models, static_cast<int>(i % tooth_type_count), i / tooth_type_count);
    } catch (const NoResultError&) {  // no draw of this seed made a tooth
    }
  });
  LabelledPanoramas all{CrownPanorama::channels, CrownPanorama::rows, CrownPanorama::columns, {}, {}};
  for (const std::vector<LikenessSample>& samples : of_tooth)
    for (const LikenessSample& sample : samples) {
      all.values.insert(all.values.end(), sample.panorama.values.begin(), sample.panorama.values.end());
      all.labels.push_back(static_cast<std::int32_t>(sample.label));
    }
  return all;
}

LikenessBounds draw_likeness_bounds(const ToothFamilies& families, const ToothClassifier& classifier, int per_type) {
  constexpr std::uint64_t bounds_seed = first_validation_sample;
  std::vector<Likeness> crowns, strangers;
  std::vector<std::size_t> teeth;
  for (int i = 0; i < per_type; ++i)
    for (int type = 0; type < tooth_type_count; ++type) {
      const std::uint64_t seed = bounds_seed + static_cast<std::uint64_t>(i);
      RandomStream random(seed, 700 + static_cast<std::uint64_t>(type));
      try {
        const SyntheticTooth tooth = generate_tooth(families, type, seed);
        const TriangleMesh crown = i % 3 == 0 ? draw_low_crown(tooth, random) : draw_scanned_crown(tooth, random);
        crowns.push_back(likeness(crown, growth_axis(crown), classifier));
        teeth.push_back(2 * static_cast<std::size_t>(type));
        const auto kind = static_cast<UnlikeKind>((i + type) % unlike_kind_count);
        const TriangleMesh stranger = unlike_crown(draw_scanned_crown(tooth, random), kind, random);
        strangers.push_back(likeness(stranger, growth_axis(stranger), classifier));
      } catch (const Error&) {  // a cut that leaves nothing
      }
    }
  return likeness_bounds(crowns, teeth, strangers);
}

}  // namespace rhizodont
