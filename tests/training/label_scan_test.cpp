// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/label_scan.hpp"

#include "base/random_stream.hpp"
#include "evaluation/segmentation_figures.hpp"
#include "rhizodont/error.hpp"
#include "training/arch_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

namespace rhizodont {
namespace {

constexpr std::uint64_t first_seed = 5000;
const std::filesystem::path data = std::filesystem::path(RHIZODONT_SOURCE_DIR).parent_path() / "shared" / "data";

const ArchModel& mean_arch() {
  static const ArchModel model =
      load_arch_model(std::filesystem::path(RHIZODONT_SOURCE_DIR) / "models" / "arch.safetensors");
  return model;
}

/// What a good network would say of a generated scan: the truth, unsure at borders, votes and kinds a little off.
TeethReading good_reading(const GeneratedArch& arch, std::uint64_t seed) {
  RandomStream random(seed);
  TeethReading reading;
  reading.frame = true_frame(arch);
  const ScanPoints points = scan_points(arch.scan, reading.frame);
  reading.cloud = points.cloud;
  reading.pyramid = scan_pyramid(reading.cloud, {});
  const bool upper = arch.jaw == Jaw::upper;
  const ScanLevel& level = reading.pyramid.levels[0];
  std::map<int, std::pair<Eigen::Vector3d, double>> middles;
  std::vector<int> teeth;
  for (std::size_t i = 0; i < reading.size(); ++i) {
    teeth.push_back(arch.fdi[static_cast<std::size_t>(points.vertices[static_cast<std::size_t>(level.from[i])])]);
    auto& [sum, count] = middles.try_emplace(teeth[i], Eigen::Vector3d::Zero(), 0).first->second;
    sum += reading.place(i);
    ++count;
  }
  for (std::size_t i = 0; i < reading.size(); ++i) {
    std::vector<float> kinds(scan_kind_count, 0.01F);
    for (std::size_t j = 0; j < 12; ++j) {
      const int kind = scan_kind(teeth[static_cast<std::size_t>(level.neighbours[16 * i + j])], upper);
      kinds[static_cast<std::size_t>(kind)] += j == 0 ? 0.3F : 0.05F;
      if (kind > 1 && kind != 8 && kind != 9 && kind != 16)  // a neighbour is half as likely
        for (const int beside : {kind - 1, kind + 1}) kinds[static_cast<std::size_t>(beside)] += 0.01F;
    }
    float sum = 0;
    for (const float k : kinds) sum += k;
    for (const float k : kinds) reading.said.kinds.push_back(k / sum);
    const auto& [middle, count] = middles.at(teeth[i]);
    for (const double x : middle / count - reading.place(i))
      reading.said.offsets.push_back(static_cast<float>(x + 0.7 * random.normal()));
    const bool border = std::any_of(&level.neighbours[16 * i], &level.neighbours[16 * i] + 8,
                                    [&](std::int32_t j) { return teeth[static_cast<std::size_t>(j)] != teeth[i]; });
    reading.said.borders.push_back(border ? 0.9F : 0.1F);
  }
  reading.said.upper = upper ? 0.7F : 0.3F;
  return reading;
}

TEST(LabelScan, ReadsGeneratedArchesWhereTheNetworkIsGood) {
  if (!std::filesystem::exists(data / "crowns" / "ssm")) GTEST_SKIP() << "no ../shared/data";
  const ArchFamily family = load_arch_family(data);
  std::vector<SegmentationFigures> all;
  for (std::uint64_t seed = first_seed; seed < first_seed + 6; ++seed) {
    const GeneratedArch arch = sample_arch(family, seed);
    const SegmentedScan found = label_scan(arch.scan, good_reading(arch, seed), mean_arch(), {});
    all.push_back(segmentation_figures(arch.scan, arch.fdi, found.fdi));
    std::string errors;
    for (const FoundToothFigures& tooth : all.back().teeth)
      if (!tooth.is_right()) errors += " " + std::to_string(tooth.fdi) + "=" + std::to_string(tooth.most_like);
    std::printf("%d %s: %zu of %zu, faces %.3f, TSA %.3f%s\n", static_cast<int>(seed), jaw_name(arch.jaw),
                all.back().right(), all.back().teeth.size(), all.back().faces_right, all.back().tsa, errors.c_str());
  }
  const SegmentationSummary sum = summary_of(all);
  std::printf("%s", describe(sum).c_str());
  EXPECT_GT(static_cast<double>(sum.right), 0.95 * static_cast<double>(sum.teeth));
  EXPECT_GT(sum.faces_wholly_right, 0.93);  // borders blur where a reading does
  EXPECT_EQ(sum.jaws_right, sum.scans);
}

TEST(LabelScan, WhatAPersonSaysOfTeethTellsTheJawAndAWrongJawIsAskedAbout) {
  if (!std::filesystem::exists(data / "crowns" / "ssm")) GTEST_SKIP() << "no ../shared/data";
  const GeneratedArch arch = sample_arch(load_arch_family(data), first_seed);
  const TeethReading reading = good_reading(arch, first_seed);
  const bool upper = arch.jaw == Jaw::upper;
  SegmentOptions missing;
  for (const int number : {6, 7, 8})
    for (const int quadrant : {upper ? 10 : 30, upper ? 20 : 40}) missing.missing.insert(quadrant + number);
  EXPECT_EQ(label_scan(arch.scan, reading, mean_arch(), missing).jaw, arch.jaw);
  SegmentOptions wrong;
  wrong.jaw = upper ? Jaw::lower : Jaw::upper;
  const SegmentedScan other = label_scan(arch.scan, reading, mean_arch(), wrong);
  EXPECT_EQ(other.jaw, *wrong.jaw);
  EXPECT_NE(other.jaw_reason.find("is that right?"), std::string::npos) << other.jaw_reason;
}

}  // namespace
}  // namespace rhizodont
