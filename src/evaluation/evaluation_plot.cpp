// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/evaluation_plot.hpp"

#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>

namespace rhizodont {
namespace {

constexpr double size = 560, margin = 60;
constexpr std::array<std::string_view, 4> colours{"#1b6ca8", "#c0562f", "#4a8f3c", "#7a4fa3"};

/// Millimetres to the drawing's units; both axes have the same range.
struct Scale {
  double low = 0, high = 1;

  double along(double mm) const { return (mm - low) / (high - low) * (size - 2 * margin); }
  double x(double mm) const { return margin + along(mm); }
  double y(double mm) const { return size - margin - along(mm); }
};

Scale find_scale(const Evaluation& evaluation) {
  double low = 1e300, high = -1e300;
  for (const EvaluatedCase& evaluated : evaluation.cases)
    for (const CaseOutcome& outcome : evaluated.outcomes) {
      if (!outcome.figures) continue;
      const double truth = outcome.figures->true_root_length_mm;
      const double predicted = truth + outcome.figures->root_length_error_mm;
      low = std::min({low, truth, predicted});
      high = std::max({high, truth, predicted});
    }
  if (low > high) throw NoResultError("No tooth has figures that could be drawn.");
  return {std::floor(low - 1), std::ceil(high + 1)};
}

void draw_axes(const Scale& scale, std::string& svg) {
  const auto out = std::back_inserter(svg);
  const CbctNoise noise;
  fmt::format_to(out, R"svg(<clipPath id="frame"><rect x="{0}" y="{0}" width="{1}" height="{1}"/></clipPath>)svg",
                 margin, size - 2 * margin);
  fmt::format_to(out, R"svg(<polygon points="{},{} {},{} {},{} {},{}" fill="#e8e8e8" clip-path="url(#frame)"/>)svg",
                 scale.x(scale.low), scale.y(scale.low + noise.root_length_low_mm), scale.x(scale.high),
                 scale.y(scale.high + noise.root_length_low_mm), scale.x(scale.high),
                 scale.y(scale.high + noise.root_length_high_mm), scale.x(scale.low),
                 scale.y(scale.low + noise.root_length_high_mm));
  fmt::format_to(out, R"(<line x1="{0}" y1="{1}" x2="{2}" y2="{3}" stroke="#888"/>)", scale.x(scale.low),
                 scale.y(scale.low), scale.x(scale.high), scale.y(scale.high));
  for (double mm = scale.low; mm <= scale.high; mm += 2)
    fmt::format_to(
        out,
        R"(<text x="{0}" y="{1}" text-anchor="middle">{4}</text><text x="{2}" y="{3}" text-anchor="end">{4}</text>)",
        scale.x(mm), size - margin + 18, margin - 8, scale.y(mm) + 4, mm);
  fmt::format_to(out, R"(<rect x="{0}" y="{0}" width="{1}" height="{1}" fill="none" stroke="#444"/>)", margin,
                 size - 2 * margin);
  fmt::format_to(out, R"(<text x="{0}" y="{1}" text-anchor="middle">true root length, mm</text>)", size / 2, size - 18);
  fmt::format_to(
      out,
      R"svg(<text transform="translate(20 {0}) rotate(-90)" text-anchor="middle">predicted root length, mm</text>)svg",
      size / 2);
  fmt::format_to(out, R"(<text x="{0}" y="{1}" fill="#777">grey band: 95 % limits of CBCT itself</text>)", margin + 8,
                 size - margin - 10);
}

void draw_tooth(const Scale& scale, int fdi, const CaseOutcome& outcome, std::string_view colour, std::string& svg) {
  const auto out = std::back_inserter(svg);
  const double truth = outcome.figures->true_root_length_mm;
  const double predicted = truth + outcome.figures->root_length_error_mm;
  if (outcome.uncertainty && outcome.uncertainty->interval) {
    const RootInterval& interval = *outcome.uncertainty->interval;
    fmt::format_to(
        out,
        R"svg(<line x1="{0:.1f}" x2="{0:.1f}" y1="{1:.1f}" y2="{2:.1f}" stroke="{3}" opacity="0.4" clip-path="url(#frame)"/>)svg",
        scale.x(truth), scale.y(interval.length_low_mm), scale.y(interval.length_high_mm), colour);
  }
  fmt::format_to(out, R"(<circle cx="{:.1f}" cy="{:.1f}" r="3.5" fill="{}"><title>{}</title></circle>)", scale.x(truth),
                 scale.y(predicted), colour, fdi);
}

}  // namespace

std::string root_length_plot(const Evaluation& evaluation) {
  const Scale scale = find_scale(evaluation);
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {0}" font-family="sans-serif" font-size="13">)",
      size);
  svg += R"(<rect width="100%" height="100%" fill="white"/>)";
  draw_axes(scale, svg);
  for (std::size_t p = 0; p < evaluation.predictors.size(); ++p) {
    const std::string_view colour = colours[p % colours.size()];
    for (const EvaluatedCase& evaluated : evaluation.cases)
      if (evaluated.outcomes[p].figures) draw_tooth(scale, evaluated.files.fdi, evaluated.outcomes[p], colour, svg);
    fmt::format_to(std::back_inserter(svg), R"(<text x="{}" y="{}" fill="{}">{}</text>)", margin + 8,
                   margin + 20 + 18 * static_cast<double>(p), colour, evaluation.predictors[p]);
  }
  return svg + "</svg>\n";
}

}  // namespace rhizodont
