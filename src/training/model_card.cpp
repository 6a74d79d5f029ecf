// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/model_card.hpp"

#include "rhizodont/error.hpp"

#include <charconv>
#include <cstdio>
#include <initializer_list>

namespace rhizodont {
namespace {

std::map<std::string, std::string> values_of(const WeightFile& weights, std::initializer_list<const char*> figures) {
  std::map<std::string, std::string> values = weights.metadata;
  for (const char* figure : figures) values.try_emplace(std::string("validation.") + figure, "not measured");
  char size[32];
  std::snprintf(size, sizeof size, "%.1f", static_cast<double>(weights.bytes) * 1e-6);
  values["file"] = weights.name;
  values["size_mb"] = size;
  return values;
}

long long number_of(const std::map<std::string, std::string>& metadata, const std::string& key) {
  const auto found = metadata.find(key);
  const std::string text = found == metadata.end() ? "" : found->second;
  long long number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || end != text.data() + text.size())
    throw InputError("The weights do not say their \"" + key + "\", which their model card needs.");
  return number;
}

}  // namespace

std::string model_card(std::string_view text, const std::map<std::string, std::string>& values) {
  std::string card;
  while (true) {
    const std::size_t open = text.find('{');
    card += text.substr(0, open);
    if (open == std::string_view::npos) return card;
    const std::size_t close = text.find('}', open);
    if (close == std::string_view::npos) throw InputError("A brace in the text of the model card is not closed.");
    const std::string name(text.substr(open + 1, close - open - 1));
    const auto found = values.find(name);
    if (found == values.end())
      throw InputError("The weights do not say their \"" + name + "\", which their model card needs.");
    card += found->second;
    text.remove_prefix(close + 1);
  }
}

std::string completion_card(const WeightFile& weights) {
  std::map<std::string, std::string> values = values_of(
      weights, {"samples", "tooth_chamfer_l1_mm", "root_chamfer_l1_mm", "depth_error_mm", "normal_error_degrees"});
  values["output_points"] =
      std::to_string(number_of(weights.metadata, "shape.queries") * number_of(weights.metadata, "shape.patch_points"));
  return model_card(completion_card_template, values);
}

std::string skirt_card(const WeightFile& weights) {
  std::map<std::string, std::string> values = values_of(weights, {"samples", "accuracy", "intersection_over_union"});
  values.try_emplace("training.pool", "N");  // a checkpoint does not say
  return model_card(skirt_card_template, values);
}

std::string segment_card(const WeightFile& weights) {
  std::map<std::string, std::string> values =
      values_of(weights, {"samples", "accuracy", "tooth_gum", "jaw", "offset_mm", "turn_deg"});
  values.try_emplace("training.pool", "N");  // a checkpoint does not say
  return model_card(segment_card_template, values);
}

}  // namespace rhizodont
