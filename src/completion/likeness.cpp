// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/likeness.hpp"

#include "base/conformal_quantile.hpp"
#include "completion/crown_panorama.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rhizodont {
namespace {

constexpr const char* bounds_name = "bounds";

}  // namespace

LikenessModel load_likeness(const std::filesystem::path& path) {
  const TensorFile file = read_safetensors(path);
  const auto found = file.tensors.find(bounds_name);
  if (found == file.tensors.end() || found->second.type == TensorType::int32)
    throw InputError("The weights that tell teeth apart come without bounds.");
  const std::vector<float> values = load_floats(found->second);
  const bool good = values.size() == 3 &&
                    std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); }) &&
                    values[2] >= values[1];
  if (!good) throw InputError("The bounds of the weights that tell teeth apart are damaged.");
  return {ToothClassifier(file), {double{values[0]}, double{values[1]}, double{values[2]}}, file.metadata};
}

void note_bounds(const LikenessBounds& bounds, TensorFile& weights) {
  const std::vector<float> values{static_cast<float>(bounds.other_tooth), static_cast<float>(bounds.unlike),
                                  static_cast<float>(bounds.refused)};
  weights.tensors[bounds_name] = store_floats(values, {3});
}

double Likeness::lead_over(std::size_t tooth) const {
  constexpr std::size_t sides = 2, teeth_of_quadrant = 8, first_molar = 5, third_molar = 7;
  const auto place = [](std::size_t t) { return t / sides % teeth_of_quadrant; };
  const auto quadrant = [](std::size_t t) { return std::pair(t / (sides * teeth_of_quadrant), t % sides); };
  const double own = log_probability.at(tooth);
  double most = own;
  for (std::size_t t = 0; t < tooth_count; ++t) {
    const bool tells_nothing = place(tooth) == third_molar && place(t) >= first_molar && quadrant(t) == quadrant(tooth);
    if (!tells_nothing) most = std::max(most, log_probability[t]);
  }
  return most - own;
}

Likeness likeness(const TriangleMesh& open_crown, const Eigen::Vector3d& growth_axis,
                  const ToothClassifier& classifier) {
  const ToothProbabilities all =
      classifier(crown_panorama(open_crown, growth_axis, panorama_centre(open_crown, growth_axis)));
  double any_tooth = 0;
  for (const double p : all.log_tooth) any_tooth += std::exp(p);
  any_tooth = std::log(std::max(any_tooth, 1e-300));
  Likeness result;
  for (std::size_t t = 0; t < tooth_count; ++t) result.log_probability[t] = all.log_tooth[t] - any_tooth;
  result.log_unlike = all.log_unlike - any_tooth;
  return result;
}

LikenessBounds likeness_bounds(const std::vector<Likeness>& crowns, const std::vector<std::size_t>& teeth,
                               const std::vector<Likeness>& strangers) {
  constexpr std::size_t fewest = 500, fewest_strangers = 100;
  constexpr double passing = 0.995, strangers_missed = 0.04, sides_missed = 0.19, strangers_not_refused = 0.5;
  if (crowns.size() != teeth.size() || crowns.size() < fewest || strangers.size() < fewest_strangers)
    throw UsageError("Bounds need at least 500 crowns, each with its tooth, and 100 strangers.");
  std::vector<double> lead, wrong_side, unlike, strange;
  for (std::size_t i = 0; i < crowns.size(); ++i) {
    lead.push_back(crowns[i].lead_over(teeth[i]));
    wrong_side.push_back(crowns[i].lead_over(teeth[i] ^ 1U));
    unlike.push_back(crowns[i].log_unlike);
  }
  for (const Likeness& stranger : strangers) strange.push_back(stranger.log_unlike);
  LikenessBounds bounds;
  bounds.other_tooth = std::max(conformal_quantile(lead, passing), conformal_quantile(wrong_side, sides_missed));
  bounds.unlike = std::max(conformal_quantile(unlike, passing), conformal_quantile(strange, strangers_missed));
  bounds.refused = std::max(bounds.unlike, conformal_quantile(strange, strangers_not_refused));
  return bounds;
}

}  // namespace rhizodont
