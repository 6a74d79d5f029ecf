// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration_error.hpp"

#include "base/parallel_tasks.hpp"
#include "common/timing.hpp"
#include "completion/registration.hpp"
#include "families/crown_crop.hpp"
#include "families/mean_teeth.hpp"
#include "teeth/fdi.hpp"
#include "teeth/prepared_crown.hpp"
#include "training/completion_sample.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace rhizodont {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// One crown: what the registration says beside what is true, radians.
struct Outcome {
  double seconds = 0;
  double turn = 0;                                     ///< error of the turn about the growth axis
  Eigen::Vector2d leans = Eigen::Vector2d::Zero();     ///< true axis of the crown's form, x and y, canonical
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();  ///< the same as registered
};

Outcome register_generated(const ToothFamilies& families, const Atlas& atlas, int type, std::uint64_t number) {
  const SyntheticTooth tooth = generate_tooth(families, type, (std::uint64_t{1} << 35) + number);
  RandomStream random(number, 300);
  const CompletionSampleOptions samples;
  CroppedCrown crop = draw_cropped_crown(tooth, samples.paper_crop_share, samples.gap_probability, random);
  if (random.chance(samples.skirt_probability)) add_skirt_remains(crop.mesh, samples.skirt_mm, random);
  const CanonicalFrame truth = frame_of_crop(crop.mesh, -tooth.crown_turn);
  CrownFrame found;
  const auto lay = [&] {
    found = canonical_frame(prepare_crown(crop.mesh), fdi_of_type(type, false),
                            atlas.types[static_cast<std::size_t>(type)]);
  };
  Outcome outcome;
  outcome.seconds = median_seconds(lay, 1);
  const Eigen::Matrix3d r = found.frame.rotation * truth.rotation.transpose();
  outcome.turn = std::atan2(r(1, 0) - r(0, 1), r(0, 0) + r(1, 1));
  outcome.leans = found.frame.direction_to_canonical(tooth.crown_axis).head<2>();
  outcome.measured = found.form_axis;
  return outcome;
}

}  // namespace

void registration_table(const ToothFamilies& families, std::uint64_t count) {
  const Atlas atlas = make_atlas(families);
  std::array<std::vector<Outcome>, tooth_type_count> outcomes;
  parallel_tasks(tooth_type_count, [&](int type) {
    auto& list = outcomes[static_cast<std::size_t>(type)];
    for (std::uint64_t i = 0; i < count; ++i) list.push_back(register_generated(families, atlas, type, i));
  });
  fmt::print(
      "| tooth | ms | turn within 0.1 rad | over 0.5 | deviation of the form's true lean, x / y degrees | slope of the "
      "registered on it | bias | deviation of the rest |\n|---|---|---|---|---|---|---|---|\n");
  for (int type = 0; type < tooth_type_count; ++type) {
    const auto& list = outcomes[static_cast<std::size_t>(type)];
    const auto n = static_cast<double>(list.size());
    double within = 0, lost = 0, seconds = 0;
    Eigen::Vector2d x = Eigen::Vector2d::Zero(), y = x, xx = x, xy = x, yy = x;
    for (const Outcome& o : list) {
      seconds += o.seconds / n;
      if (std::abs(o.turn) < 0.1) within += 1 / n;
      if (std::abs(o.turn) > 0.5) lost += 1 / n;
      x += o.leans / n, y += o.measured / n;
      xx += o.leans.cwiseAbs2() / n, yy += o.measured.cwiseAbs2() / n, xy += o.leans.cwiseProduct(o.measured) / n;
    }
    const Eigen::Vector2d spread = xx - x.cwiseAbs2(), slope = (xy - x.cwiseProduct(y)).cwiseQuotient(spread);
    const Eigen::Vector2d rest = yy - y.cwiseAbs2() - slope.cwiseAbs2().cwiseProduct(spread);
    const Eigen::Vector2d bias = degrees * (y - slope.cwiseProduct(x));
    fmt::print(
        "| {} | {:.1f} | {:.0f} % | {:.0f} % | {:.1f} / {:.1f} | {:.2f} / {:.2f} | {:.1f} / {:.1f} | {:.1f} / {:.1f} "
        "|\n",
        fdi_of_type(type, false), 1000 * seconds, 100 * within, 100 * lost, degrees * std::sqrt(spread.x()),
        degrees * std::sqrt(spread.y()), slope.x(), slope.y(), bias.x(), bias.y(),
        degrees * std::sqrt(std::max(0.0, rest.x())), degrees * std::sqrt(std::max(0.0, rest.y())));
  }
  fmt::print("\n");
}

}  // namespace rhizodont
