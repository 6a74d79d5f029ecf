// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Trains the network by which crowns are judged, and says how often the judgement is wrong.
#include "completion/likeness.hpp"
#include "families/tooth_family.hpp"
#include "families/unlike_crowns.hpp"
#include "intake/take_crown.hpp"
#include "learning/train_classifier.hpp"
#include "pipeline/crown_likeness.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"
#include "teeth/frame.hpp"
#include "teeth/prepared_crown.hpp"
#include "training/likeness_samples.hpp"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

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

/// Seeds of crowns that bounds come from, and of those in the table: neither had a part in the training.
constexpr std::uint64_t bounds_seed = std::uint64_t{1} << 40, table_seed = std::uint64_t{1} << 41;

TriangleMesh generated_crown(const ToothFamilies& families, int type, std::uint64_t seed, RandomStream& random) {
  return draw_scanned_crown(generate_tooth(families, type, seed), random);
}

LabelledPanoramas training_panoramas(const ToothFamilies& families, const std::vector<ModelCrown>& crown_models,
                                     int per_type) {
  std::vector<std::vector<LikenessSample>> of_tooth(static_cast<std::size_t>(per_type) * tooth_type_count);
  tbb::parallel_for(std::size_t{0}, of_tooth.size(), [&](std::size_t i) {
    try {
      of_tooth[i] =
          make_likeness_samples(families, crown_models, static_cast<int>(i % tooth_type_count), i / tooth_type_count);
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

/// Bounds by held-out crowns, of which every third is low, and by what is no crown.
LikenessBounds bounds_of(const ToothFamilies& families, const ToothClassifier& classifier, int per_type) {
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

/// Sets the bounds of a file of weights anew.
void set_bounds(const std::filesystem::path& data, const std::filesystem::path& file, int per_type) {
  TensorFile weights = read_safetensors(file);
  const LikenessBounds bounds = bounds_of(load_tooth_families(data), ToothClassifier(weights), per_type);
  note_bounds(bounds, weights);
  write_safetensors(file, weights);
  fmt::print("{}: bounds {:.2f}, {:.2f}, {:.2f}\n", file.string(), bounds.other_tooth, bounds.unlike, bounds.refused);
}

void fit(const std::filesystem::path& data, const std::filesystem::path& file, int per_type, int steps) {
  const ToothFamilies families = load_tooth_families(data);
  const std::vector<ModelCrown> crown_models = load_model_crowns(data / crown_models_folder);
  const LabelledPanoramas panoramas = training_panoramas(families, crown_models, per_type);
  fmt::print("{} panoramas\n", panoramas.labels.size());
  ClassifierTrainingOptions options;
  options.steps = steps;
  options.progress = [&](const TrainingProgress& progress) {
    fmt::print("step {} of {}, loss {:.4f}, {:.0f} panoramas/s\n", progress.steps, options.steps, progress.loss,
               progress.samples_per_second);
    std::fflush(stdout);
  };
  TensorFile weights = train_classifier(panoramas, options);
  const LikenessBounds bounds = bounds_of(families, ToothClassifier(weights), std::max(60, per_type / 4));
  note_bounds(bounds, weights);
  weights.metadata["content"] = "A network that tells which tooth a crown is (src/completion/tooth_classifier.hpp)";
  weights.metadata["training.panoramas"] = std::to_string(panoramas.labels.size());
  weights.metadata["training.steps"] = std::to_string(steps);
  weights.metadata["attribution"] =
      "derived from \"Permanent Teeth\", University of Dundee School of Dentistry (E. McDougall, A. Mason, M. "
      "Roughley), CC BY 4.0, and crown models of Chen Y. et al., 2023 (MIT)";
  write_safetensors(file, weights);
  fmt::print("{}: bounds {:.2f}, {:.2f}, {:.2f}\n", file.string(), bounds.other_tooth, bounds.unlike, bounds.refused);
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
  const auto number = [&](int at, int otherwise) { return argc > at ? std::atoi(argv[at]) : otherwise; };
  if (argc < 3 || (task != "fit" && task != "bounds" && task != "table" && task != "judge") ||
      ((task == "fit" || task == "bounds") && argc < 4)) {
    fmt::print(stderr,
               "usage: bench_likeness fit DATA FILE [TEETH_PER_TYPE=500] [STEPS=4000]\n"
               "       bench_likeness bounds DATA FILE [TEETH_PER_TYPE=150]\n"
               "       bench_likeness table DATA [CROWNS_PER_TYPE=32]\n"
               "       bench_likeness judge CROWN_FDI.ply...\n");
    return 2;
  }
  try {
    if (task == "fit")
      rhizodont::fit(argv[2], argv[3], number(4, 500), number(5, 4000));
    else if (task == "bounds")
      rhizodont::set_bounds(argv[2], argv[3], number(4, 150));
    else if (task == "table")
      rhizodont::table(argv[2], number(3, 32));
    else
      rhizodont::judge_files({argv + 2, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
