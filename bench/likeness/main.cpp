// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// How often the judgement of crowns is wrong.
#include "completion/likeness.hpp"
#include "families/tooth_family.hpp"
#include "families/unlike_crowns.hpp"
#include "intake/take_crown.hpp"
#include "pipeline/crown_likeness.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"
#include "teeth/frame.hpp"
#include "teeth/prepared_crown.hpp"
#include "training/likeness_samples.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace rhizodont {
namespace {

const std::filesystem::path models = std::filesystem::path(RHIZODONT_SOURCE_DIR) / "models";

constexpr const char* crown_models_folder = "crowns/ssm";

/// Seed of crowns in the table: they had a part neither in the training nor in finding the bounds.
constexpr std::uint64_t table_seed = std::uint64_t{1} << 41;

TriangleMesh generated_crown(const ToothFamilies& families, int type, std::uint64_t seed, RandomStream& random) {
  return draw_scanned_crown(generate_tooth(families, type, seed), random);
}

constexpr const char* tally_head =
    "| crowns | how many | said to be another | hardly like it | refused | together |\n|---|---|---|---|---|---|\n";
constexpr const char* guesses_head =
    "\n| guessed | how many | tooth | type | among the first three |\n|---|---|---|---|---|\n";

/// What judgements came to.
struct Tally {
  int crowns = 0, other = 0, unlike = 0, refused = 0;

  void add(const TriangleMesh& crown, int fdi, const Atlas& atlas, const LikenessModel& model) {
    ++crowns;
    try {
      const LikenessVerdict verdict = judge_crown(prepare_crown(crown), fdi, atlas, model).verdict;
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
      const CrownLikeness judged = judge_crown(prepare_crown(crown), std::nullopt, atlas, model);
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
  const std::vector<ModelCrown> crown_models = load_model_crowns(data / crown_models_folder);
  Tally genuine, modelled, side, jaw, wrong_class;
  Guesses modelled_guesses;
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
      if (const auto tooth = draw_model_crown_of_type(crown_models, type, random)) {
        const TriangleMesh other = draw_scanned_crown(*tooth, random);
        modelled.add(other, fdi, atlas, model);
        modelled_guesses.add(other, fdi, atlas, model);
      }
      side.add(crown, of_other_side(fdi), atlas, model);
      jaw.add(crown, of_other_jaw(fdi), atlas, model);
      wrong_class.add(crown, of_other_class(fdi), atlas, model);
      const auto kind = static_cast<std::size_t>((i + type) % unlike_kind_count);
      unlike[kind].add(unlike_crown(crown, static_cast<UnlikeKind>(kind), random), fdi, atlas, model);
    }
  fmt::print("{}", tally_head);
  genuine.print("right number (false alarms)");
  modelled.print("right number, statistical models' crowns");
  side.print("wrong side");
  jaw.print("wrong jaw");
  wrong_class.print("wrong class");
  for (std::size_t k = 0; k < unlike.size(); ++k) unlike[k].print(name_of(static_cast<UnlikeKind>(k)));
  fmt::print("{}", guesses_head);
  for (int type = 0; type < tooth_type_count; ++type)
    guesses[static_cast<std::size_t>(type)].print(std::to_string(fdi_of_type(type, false)));
  all.print("all");
  modelled_guesses.print("statistical models' crowns");
}

/// Crowns in files whose names end in their number (crown_36.ply), as `complete --repair --skirt auto` takes them.
void judge_files(const std::vector<std::filesystem::path>& files) {
  const CompletionModels loaded = CompletionModels::load(models);
  const CompletionModels::Content& content = *content_of(loaded);
  Tally genuine;
  Guesses guesses;
  int untaken = 0;
  for (const std::filesystem::path& file : files) {
    CompleteOptions options;
    options.repair = true;
    options.skirt = 0.5;
    const std::string name = file.stem().string();
    options.fdi = std::atoi(name.substr(name.size() < 2 ? 0 : name.size() - 2).c_str());
    try {
      const TriangleMesh crown = take_crown(load_mesh(file).mesh, content.atlas, content.skirt, options).kept.mesh;
      genuine.add(crown, *options.fdi, content.atlas, *content.likeness);
      guesses.add(crown, *options.fdi, content.atlas, *content.likeness);
      const Likeness judged = likeness(crown, growth_axis(crown), content.likeness->classifier);
      const std::size_t said = tooth_of_fdi(*options.fdi);
      const LikenessBounds& bounds = content.likeness->bounds;
      if (judged.log_unlike > bounds.unlike || judged.lead_over(said) > bounds.other_tooth)
        fmt::print("warned of: {}: ln unlike {:.1f} (bounds {:.1f}, {:.1f}), ln another {:.1f} (bound {:.1f})\n",
                   file.string(), judged.log_unlike, bounds.unlike, bounds.refused, judged.lead_over(said),
                   bounds.other_tooth);
    } catch (const Error& error) {
      fmt::print("not taken: {}: {}\n", file.string(), error.what());
      ++untaken;
    }
  }
  fmt::print("{} files, {} not taken before they were judged\n{}", files.size(), untaken, tally_head);
  genuine.print("right number (false alarms)");
  fmt::print("{}", guesses_head);
  guesses.print("all");
}

}  // namespace
}  // namespace rhizodont

int main(int argc, char** argv) {
  const std::string task = argc > 1 ? argv[1] : "";
  if (argc < 3 || (task != "table" && task != "judge")) {
    fmt::print(stderr,
               "usage: bench_likeness table DATA [CROWNS_PER_TYPE=32]\n"
               "       bench_likeness judge CROWN_FDI.ply...\n");
    return 2;
  }
  try {
    if (task == "table")
      rhizodont::table(argv[2], argc > 3 ? std::atoi(argv[3]) : 32);
    else
      rhizodont::judge_files({argv + 2, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
