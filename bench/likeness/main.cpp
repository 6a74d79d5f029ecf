// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Makes the statistics by which crowns are judged, and says how often the judgement is wrong.
#include "atlas/crown_crop.hpp"
#include "atlas/tooth_family.hpp"
#include "atlas/unlike_crowns.hpp"
#include "completion/likeness.hpp"
#include "pipeline/crown_likeness.hpp"
#include "rhizodont/error.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

namespace rhizodont {
namespace {

const std::filesystem::path models = std::filesystem::path(RHIZODONT_SOURCE_DIR) / "models";

/// Seeds from here on had no part in the statistics.
constexpr std::uint64_t table_seed = std::uint64_t{1} << 41;

/// A crown as scans give it: mostly near the junction, some with notches at the contacts or remains of gum.
TriangleMesh generated_crown(const ToothFamilies& families, int type, std::uint64_t seed, RandomStream& random) {
  constexpr double paper_share = 0.02, gap_probability = 0.3, skirt_probability = 0.2, skirt_mm = 0.9;
  const SyntheticTooth tooth = generate_tooth(families, type, seed);
  TriangleMesh crown = draw_cropped_crown(tooth, paper_share, gap_probability, random).mesh;
  if (random.chance(skirt_probability)) add_skirt_remains(crown, skirt_mm, random);
  return crown;
}

void fit(const std::filesystem::path& data, const std::filesystem::path& file, int per_type) {
  const ToothFamilies families = load_tooth_families(data);
  const Atlas atlas = load_atlas(models / "atlas.safetensors");
  std::vector<LikenessSample> samples;
  for (int i = 0; i < per_type; ++i)
    for (int type = 0; type < tooth_type_count; ++type) {
      const auto seed = static_cast<std::uint64_t>(i);
      RandomStream random(seed, 700 + static_cast<std::uint64_t>(type));
      const TriangleMesh crown = generated_crown(families, type, seed, random);
      samples.push_back({type, crown_traits(crown, atlas, 2 * static_cast<std::size_t>(type))});
    }
  LikenessModel model = fit_likeness(samples);
  model.metadata["content"] =
      "Statistics of generated crowns by which a crown's tooth is told (src/completion/likeness.hpp)";
  model.metadata["crowns"] = std::to_string(samples.size());
  model.metadata["attribution"] =
      "derived from \"Permanent Teeth\", University of Dundee School of Dentistry (E. McDougall, A. Mason, M. "
      "Roughley), "
      "CC BY 4.0, and crown models of Chen Y. et al., 2023 (MIT)";
  save_likeness(model, file);
  fmt::print("{}: {} crowns, weights {:.2f}, {:.2f}, bounds {:.2f}, {:.2f}, {:.2f}, {:.2f}\n", file.string(),
             samples.size(), model.type_weight, model.side_weight, model.type_bound, model.side_bound,
             model.strange_bound, model.refused_bound);
}

/// What judgements came to.
struct Tally {
  int crowns = 0, other = 0, unlike = 0, refused = 0;

  void add(const TriangleMesh& crown, int fdi, const Atlas& atlas, const LikenessModel& model) {
    ++crowns;
    try {
      const LikenessVerdict verdict = judge_crown(crown, fdi, atlas, model).verdict;
      other += verdict == LikenessVerdict::other_tooth ? 1 : 0;
      unlike += verdict == LikenessVerdict::unlike ? 1 : 0;
    } catch (const InputError&) {
      ++refused;
    }
  }

  void print(const std::string& name) const {
    const auto share = [&](int count) { return 100.0 * count / std::max(1, crowns); };
    fmt::print("| {} | {} | {:.1f} % | {:.1f} % | {:.1f} % | {:.1f} % |\n", name, crowns, share(other), share(unlike),
               share(refused), share(other + unlike + refused));
  }
};

/// How often the tooth is guessed without a number.
struct Guesses {
  int crowns = 0, right = 0, type = 0, second = 0;

  void add(const TriangleMesh& crown, int fdi, const Atlas& atlas, const LikenessModel& model) {
    ++crowns;
    try {
      const CrownLikeness judged = judge_crown(crown, std::nullopt, atlas, model);
      right += judged.said.fdi == fdi ? 1 : 0;
      type += tooth_type_of_fdi(judged.said.fdi) == tooth_type_of_fdi(fdi) ? 1 : 0;
      second +=
          std::any_of(judged.next.begin(), judged.next.end(), [&](const ToothLikeness& t) { return t.fdi == fdi; }) ? 1
                                                                                                                    : 0;
    } catch (const InputError&) {
    }
  }

  void print(const std::string& name) const {
    const auto share = [&](int count) { return 100.0 * count / std::max(1, crowns); };
    fmt::print("| {} | {} | {:.0f} % | {:.0f} % | {:.0f} % |\n", name, crowns, share(right), share(type),
               share(right + second));
  }
};

int of_other_class(int fdi) { return fdi % 10 <= 3 ? 10 * (fdi / 10) + 6 : 10 * (fdi / 10) + 1; }
int of_other_side(int fdi) { return fdi_of_type(tooth_type_of_fdi(fdi), !is_right_side(fdi)); }
int of_other_jaw(int fdi) { return fdi_of_type((tooth_type_of_fdi(fdi) + 8) % tooth_type_count, is_right_side(fdi)); }

void table(const std::filesystem::path& data, int per_type) {
  const ToothFamilies families = load_tooth_families(data);
  const Atlas atlas = load_atlas(models / "atlas.safetensors");
  const LikenessModel model = load_likeness(models / "likeness.safetensors");
  Tally genuine, side, jaw, wrong_class;
  std::array<Tally, unlike_kind_count> unlike;
  std::array<Guesses, tooth_type_count> guesses;
  Guesses all;
  for (int i = 0; i < per_type; ++i)
    for (int type = 0; type < tooth_type_count; ++type) {
      const std::uint64_t seed = table_seed + static_cast<std::uint64_t>(i);
      RandomStream random(seed, 700 + static_cast<std::uint64_t>(type));
      const TriangleMesh crown = generated_crown(families, type, seed, random);
      const int fdi = fdi_of_type(type, false);
      genuine.add(crown, fdi, atlas, model);
      guesses[static_cast<std::size_t>(type)].add(crown, fdi, atlas, model);
      all.add(crown, fdi, atlas, model);
      side.add(crown, of_other_side(fdi), atlas, model);
      jaw.add(crown, of_other_jaw(fdi), atlas, model);
      wrong_class.add(crown, of_other_class(fdi), atlas, model);
      const auto kind = static_cast<std::size_t>((i + type) % unlike_kind_count);
      unlike[kind].add(unlike_crown(crown, static_cast<UnlikeKind>(kind), random), fdi, atlas, model);
    }
  fmt::print(
      "| crowns | how many | said to be another | hardly like it | refused | together |\n|---|---|---|---|---|---|\n");
  genuine.print("right number (false alarms)");
  side.print("wrong side");
  jaw.print("wrong jaw");
  wrong_class.print("wrong class");
  for (std::size_t k = 0; k < unlike.size(); ++k) unlike[k].print(name_of(static_cast<UnlikeKind>(k)));
  fmt::print("\n| guessed | how many | tooth | type | among the first three |\n|---|---|---|---|---|\n");
  for (int type = 0; type < tooth_type_count; ++type)
    guesses[static_cast<std::size_t>(type)].print(std::to_string(fdi_of_type(type, false)));
  all.print("all");
}

}  // namespace
}  // namespace rhizodont

int main(int argc, char** argv) {
  const std::string task = argc > 1 ? argv[1] : "";
  if (argc < 3 || (task != "fit" && task != "table") || (task == "fit" && argc < 4)) {
    fmt::print(stderr,
               "usage: bench_likeness fit DATA FILE [CROWNS_PER_TYPE=150] | bench_likeness table DATA "
               "[CROWNS_PER_TYPE=32]\n");
    return 2;
  }
  try {
    if (task == "fit")
      rhizodont::fit(argv[2], argv[3], argc > 4 ? std::atoi(argv[4]) : 150);
    else
      rhizodont::table(argv[2], argc > 3 ? std::atoi(argv[3]) : 32);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
