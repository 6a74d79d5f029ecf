// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment_options.hpp"

#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <string_view>

namespace rhizodont::command_line {
namespace {

std::vector<std::string_view> parts_of(std::string_view text, char between) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(between);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

void add_missing(const std::string& text, std::set<int>& missing) {
  for (const std::string_view part : parts_of(text, ',')) {
    const auto fdi = read_fdi(part);
    if (!fdi) throw UsageError(fmt::format("--missing takes numbers of teeth, such as 14,24, not '{}'.", text));
    missing.insert(*fdi);
  }
}

void add_tooth(const std::string& text, std::map<int, Point>& teeth) {
  const std::size_t at = text.find('=');
  const auto fdi = read_fdi(std::string_view(text).substr(0, at));
  bool good = fdi && at != std::string::npos;
  Point place = Point::Zero();
  if (good) {
    const auto parts = parts_of(std::string_view(text).substr(at + 1), ',');
    good = parts.size() == 3;
    for (std::size_t i = 0; good && i < 3; ++i) {
      const char* end = parts[i].data() + parts[i].size();
      const auto [stop, failure] = std::from_chars(parts[i].data(), end, place[static_cast<Eigen::Index>(i)]);
      good = failure == std::errc() && stop == end;
    }
  }
  if (!good)
    throw UsageError(fmt::format("--tooth takes a tooth and a place on it, such as 24=12.5,-3,40.1, not '{}'.", text));
  if (!teeth.emplace(*fdi, place).second) throw UsageError(fmt::format("Tooth {} has two places.", *fdi));
}

}  // namespace

void FoundTeethOptions::add_to(CLI::App& app) {
  app.add_option("--jaw", jaw, "upper or lower; found by itself if not given")
      ->check(CLI::IsMember({"upper", "lower"}));
  app.add_option("--missing", missing, "Teeth that are not there: 14,24");
  app.add_option("--tooth", teeth, "A tooth's number and a place on it in the scan: 24=x,y,z");
}

void FoundTeethOptions::read_into(SegmentOptions& options) const {
  if (!jaw.empty()) options.jaw = jaw == "upper" ? Jaw::upper : Jaw::lower;
  for (const std::string& text : missing) add_missing(text, options.missing);
  for (const std::string& text : teeth) add_tooth(text, options.teeth);
}

}  // namespace rhizodont::command_line
