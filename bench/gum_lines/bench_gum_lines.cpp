// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// How far the borders of crowns lean against the crowns' form, on scans and as generated: bench_gum_lines DATA CROWNS
// [COUNT]. CROWNS: a folder as scripts/cut_labelled.py makes it, *_FDI.ply; of generated crowns COUNT of each type. On
// both the lean is what laying the type's mean crown on the crown finds (completion/registration.hpp).
#include "base/parallel_tasks.hpp"
#include "base/random_stream.hpp"
#include "completion/registration.hpp"
#include "families/crown_crop.hpp"
#include "families/mean_teeth.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"
#include "teeth/prepared_crown.hpp"
#include "training/completion_sample.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace rhizodont;

/// What the border of one crown looks like.
struct Border {
  double lean = 0;    ///< angle between the border's axis and that of the form, degrees
  double height = 0;  ///< extent of the border along its axis, mm: how far it is from level
};

/// Nothing where the mean crown does not lie well on the crown, or the crown has no single border.
std::optional<Border> measure(const TriangleMesh& crown, int fdi, const Atlas& atlas) {
  try {
    const PreparedCrown prepared = prepare_crown(crown);
    const CrownFrame frame =
        canonical_frame(prepared, fdi, atlas.types[static_cast<std::size_t>(tooth_type_of_fdi(fdi))]);
    Border border;
    border.lean = std::asin(std::min(1.0, frame.form_axis.norm())) * 180 / std::numbers::pi;
    double low = 1e9, high = -1e9;
    for (std::size_t v = 0; v < prepared.border.is_vertex.size(); ++v) {
      if (!prepared.border.is_vertex[v]) continue;
      const double z = prepared.mesh.vertices[v].dot(prepared.growth_axis);
      low = std::min(low, z), high = std::max(high, z);
    }
    border.height = high - low;
    return border;
  } catch (const Error&) {
    return std::nullopt;
  }
}

using Borders = std::array<std::vector<Border>, tooth_type_count>;

Borders of_scans(const std::filesystem::path& folder, const Atlas& atlas) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".ply") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::optional<Border>> found(files.size());
  std::vector<int> types(files.size());
  parallel_tasks(files.size(), [&](std::size_t i) {
    const std::string name = files[i].stem().string();
    const int fdi = std::atoi(name.substr(name.rfind('_') + 1).c_str());
    types[i] = tooth_type_of_fdi(fdi);
    found[i] = measure(load_mesh(files[i]).mesh, fdi, atlas);
  });
  Borders borders;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (found[i]) borders[static_cast<std::size_t>(types[i])].push_back(*found[i]);
  return borders;
}

Borders of_generated(const ToothFamilies& families, const Atlas& atlas, std::uint64_t count) {
  Borders borders;
  const CompletionSampleOptions samples;
  parallel_tasks(tooth_type_count, [&](int type) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const SyntheticTooth tooth = generate_tooth(families, type, (std::uint64_t{1} << 36) + i);
      RandomStream random(i, 400 + static_cast<std::uint64_t>(type));
      const TriangleMesh crown = draw_cropped_crown(tooth, 0, samples.gap_probability, random).mesh;
      if (const auto border = measure(crown, fdi_of_type(type, false), atlas))
        borders[static_cast<std::size_t>(type)].push_back(*border);
    }
  });
  return borders;
}

std::string quantiles(const std::vector<Border>& borders, double Border::*figure) {
  std::vector<double> values;
  for (const Border& border : borders) values.push_back(border.*figure);
  if (values.empty()) return "| 0 | | | | ";
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return fmt::format("| {} | {:.1f} | {:.1f} | {:.1f} ", values.size(), at(0.5), at(0.8), at(0.95));
}

void print(const char* title, const Borders& scans, const Borders& generated, double Border::*figure) {
  fmt::print(
      "\n{}\n\n| tooth | scans | half | 80 % | 95 % | generated | half | 80 % | 95 % "
      "|\n|---|---|---|---|---|---|---|---|---|\n",
      title);
  std::vector<Border> all_scans, all_generated;
  for (std::size_t type = 0; type < scans.size(); ++type) {
    all_scans.insert(all_scans.end(), scans[type].begin(), scans[type].end());
    all_generated.insert(all_generated.end(), generated[type].begin(), generated[type].end());
    fmt::print("| {} {}{}|\n", fdi_of_type(static_cast<int>(type), false), quantiles(scans[type], figure),
               quantiles(generated[type], figure));
  }
  fmt::print("| all {}{}|\n", quantiles(all_scans, figure), quantiles(all_generated, figure));
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    fmt::print(stderr, "usage: bench_gum_lines DATA CROWNS [COUNT]\n");
    return 2;
  }
  try {
    const ToothFamilies families = load_tooth_families(words[1]);
    const Atlas atlas = make_atlas(families);
    const Borders scans = of_scans(words[2], atlas);
    const Borders generated = of_generated(families, atlas, count > 3 ? std::strtoull(words[3], nullptr, 10) : 20);
    print("Lean of the border against the crown's form, degrees:", scans, generated, &Border::lean);
    print("Extent of the border along its axis, mm:", scans, generated, &Border::height);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
