// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Sources of the default table's values: populations/middle.json and docs/tooth_families.md.
#include "families/population.hpp"

#include "base/option_range.hpp"
#include "families/population_tables.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <string_view>

namespace rhizodont {
namespace {

struct Field {
  std::string_view name;
  double ToothPopulation::*value;
  double low, high;
};

constexpr std::array<Field, 20> fields{
    {{"root_length_mm", &ToothPopulation::root_length_mm, 4, 30},
     {"root_length_deviation_mm", &ToothPopulation::root_length_deviation_mm, 0, 6},
     {"root_follows_crown", &ToothPopulation::root_follows_crown, 0, 1},
     {"crown_size", &ToothPopulation::crown_size, 0.7, 1.4},
     {"crown_size_deviation", &ToothPopulation::crown_size_deviation, 0, 0.25},
     {"crown_proportion_deviation", &ToothPopulation::crown_proportion_deviation, 0, 0.2},
     {"crown_form_factor", &ToothPopulation::crown_form_factor, 0, 2},
     {"neighbour_share", &ToothPopulation::neighbour_share, 0, 1},
     {"fused_share", &ToothPopulation::fused_share, 0, 1},
     {"trunk_mm", &ToothPopulation::trunk_mm, 0, 10},
     {"trunk_deviation_mm", &ToothPopulation::trunk_deviation_mm, 0, 4},
     {"lean_mesiodistal_degrees", &ToothPopulation::lean_mesiodistal_degrees, 0, 15},
     {"lean_buccolingual_degrees", &ToothPopulation::lean_buccolingual_degrees, 0, 15},
     {"curved_share", &ToothPopulation::curved_share, 0, 1},
     {"curve_degrees", &ToothPopulation::curve_degrees, 0, 45},
     {"curve_deviation_degrees", &ToothPopulation::curve_deviation_degrees, 0, 20},
     {"curve_usual_share", &ToothPopulation::curve_usual_share, 0, 1},
     {"dilaceration_share", &ToothPopulation::dilaceration_share, 0, 1},
     {"root_thickness_deviation", &ToothPopulation::root_thickness_deviation, 0, 0.3},
     {"short_root_share", &ToothPopulation::short_root_share, 0, 1}}};

constexpr std::string_view format_name = "rhizodont population 1";

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw InputError(fmt::format("The table of a population {} cannot be used: {}.", file, why));
}

void read_value(const std::string& file, const std::string& tooth, const std::string& name, const nlohmann::json& value,
                ToothPopulation& of_type) {
  for (const Field& field : fields) {
    if (field.name != name) continue;
    if (!value.is_number()) refuse(file, fmt::format("{} of tooth {} is no number", name, tooth));
    const auto number = value.get<double>();
    if (!OptionRange::at_least(field.low).at_most(field.high).contains(number))
      refuse(file, fmt::format("{} of tooth {} is {}, and must be from {} to {}", name, tooth, number, field.low,
                               field.high));
    of_type.*field.value = number;
    return;
  }
  refuse(file, fmt::format("tooth {} has \"{}\", which is no value of such a table", tooth, name));
}

/// Central incisors and canines of the upper jaw and canines of the lower one resemble no neighbour.
void require_neighbours(const std::string& file, const Population& population) {
  for (const std::size_t type : {0U, 2U, 10U})
    if (population.teeth[type].neighbour_share > 0)
      refuse(file, fmt::format("neighbour_share of tooth {} must be 0: it has no neighbour whose form it takes",
                               fdi_of_type(static_cast<int>(type), false)));
}

int type_named(const std::string& file, const std::string& tooth) {
  const std::optional<int> fdi = read_fdi(tooth);
  if (!fdi || !is_permanent_tooth(*fdi) || is_right_side(*fdi))
    refuse(file, fmt::format("\"{}\" is no tooth of the left side, 21 to 28 and 31 to 38", tooth));
  return tooth_type_of_fdi(*fdi);
}

Population read(std::string_view text, const std::string& file, Population population) {
  const nlohmann::json table = nlohmann::json::parse(text, nullptr, false);
  if (table.is_discarded()) refuse(file, "it is no JSON");
  if (!table.is_object() || table.value("format", nlohmann::json()) != format_name)
    refuse(file, fmt::format("it lacks \"format\": \"{}\"", format_name));
  for (const auto& [key, value] : table.items()) {
    if (key == "format" || key == "sources") continue;
    if (key == "name" && value.is_string()) {
      population.name = value.get<std::string>();
    } else if (key == "teeth" && value.is_object()) {
      for (const auto& [tooth, values] : value.items()) {
        ToothPopulation& of_type = population.teeth[static_cast<std::size_t>(type_named(file, tooth))];
        if (!values.is_object()) refuse(file, fmt::format("tooth {} has no list of named values", tooth));
        for (const auto& [name, number] : values.items()) read_value(file, tooth, name, number, of_type);
      }
    } else {
      refuse(file, fmt::format("\"{}\" is not of such a table, or not as it has to be", key));
    }
  }
  require_neighbours(file, population);
  return population;
}

}  // namespace

const Population& default_population() {
  static const Population population = read(middle_population_table, "middle.json", {});
  return population;
}

Population read_population(std::string_view text, const std::string& file) {
  return read(text, file, default_population());
}

Population load_population(const std::filesystem::path& file) {
  try {
    return read_population(read_file_bytes(file), file.string());
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find(file.string()) != std::string_view::npos) throw;
    throw error.reworded(fmt::format("The table of a population {} cannot be read: {}", file.string(), error.what()));
  }
}

}  // namespace rhizodont
