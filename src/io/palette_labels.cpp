// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Labels from colours, with the user's palette.
#include "io/cursors.hpp"
#include "io/scan_labels.hpp"
#include "io/whole_labels.hpp"
#include "mesh/adjacency.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace rhizodont {
namespace {

using Colour = std::array<std::uint8_t, 3>;
using Numbers = std::vector<std::optional<int>>;  // nothing where the palette has no entry

std::string shown(const Colour& colour) { return fmt::format("{:02X}{:02X}{:02X}", colour[0], colour[1], colour[2]); }

/// RRGGBB, also with # in front.
std::optional<Colour> colour_from(std::string_view word) {
  if (word.starts_with('#')) word.remove_prefix(1);
  Colour colour{};
  if (word.size() != 2 * colour.size()) return std::nullopt;
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const char* begin = word.data() + 2 * i;
    if (std::from_chars(begin, begin + 2, colour[i], 16).ptr != begin + 2) return std::nullopt;
  }
  return colour;
}

class Palette {
 public:
  void add(const Colour& colour, int number, const std::string& where) {
    const auto [place, is_new] = numbers_.try_emplace(colour, number);
    if (!is_new && place->second != number)
      throw InputError(
          fmt::format("{}: the colour {} has two numbers, {} and {}", where, shown(colour), place->second, number));
  }

  std::vector<PaletteEntry> entries() const {
    if (numbers_.empty()) throw InputError("the palette has no entry: 'RRGGBB number' is expected, one per line");
    std::vector<PaletteEntry> entries;
    for (const auto& [colour, number] : numbers_) entries.push_back({colour, number});
    return entries;
  }

 private:
  std::map<Colour, int> numbers_;
};

std::vector<PaletteEntry> palette_from_text(std::string_view text) {
  Palette palette;
  for (TextCursor cursor(text); cursor.remaining() > 0;) {
    const std::int64_t line = cursor.line();
    TextCursor words(cursor.rest_of_line());
    const std::string_view first = words.word().value_or("");
    if (first.empty()) continue;
    const auto colour = colour_from(first);
    const auto number = parse_number<int>(words.word().value_or(""));
    if (first.starts_with('#') && !(colour && number)) continue;  // a remark
    if (!colour || !number || words.word())
      throw InputError(fmt::format("line {}: 'RRGGBB number' is expected, such as 'FF8000 36'", line), {line});
    palette.add(*colour, *number, fmt::format("line {}", line));
  }
  return palette.entries();
}

std::vector<PaletteEntry> palette_from_json(std::string_view text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) throw InputError("the palette begins as JSON and is damaged or cut off");
  Palette palette;
  const auto add = [&](const std::string& word, const nlohmann::json& value, std::size_t place) {
    const auto colour = colour_from(word);
    if (!colour || !value.is_number() || !is_whole_label(value.get<double>()))
      throw InputError(fmt::format(
          "entry {} of the palette (counted from 1) is no colour with a number, such as \"FF8000\": 36", place));
    palette.add(*colour, static_cast<int>(value.get<double>()), fmt::format("entry {}", place));
  };
  std::size_t place = 0;
  for (const auto& [key, value] : json.items()) {
    const bool is_pair = json.is_array() && value.is_array() && value.size() == 2 && value[0].is_string();
    ++place;
    if (json.is_object())
      add(key, value, place);
    else
      add(is_pair ? value[0].get<std::string>() : std::string(), is_pair ? value[1] : value, place);
  }
  return palette.entries();
}

/// The colours among attributes; empty if there are none.
std::vector<Colour> colours_among(const std::map<std::string, VertexAttribute>& attributes) {
  std::array<const VertexAttribute*, 3> parts{};
  bool are_shares = false;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string name = std::array{"red", "green", "blue"}[i];
    auto place = attributes.find(name);
    if (place == attributes.end()) place = attributes.find("diffuse_" + name);
    if (place == attributes.end()) return {};
    parts[i] = &place->second;
    are_shares |= place->second.type >= AttributeType::float32;
  }
  for (const VertexAttribute* part : parts)
    are_shares &= std::all_of(part->values.begin(), part->values.end(), [](double x) { return x <= 1; });
  std::vector<Colour> colours(parts[0]->values.size());
  for (std::size_t k = 0; k < colours.size(); ++k)
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const double value = (are_shares ? 255.0 : 1.0) * parts[i]->values[k];
      colours[k][i] = static_cast<std::uint8_t>(std::isfinite(value) ? std::clamp(std::round(value), 0.0, 255.0) : 0);
    }
  return colours;
}

struct Coloured {
  const char* what;  // they are
  std::vector<Colour> colours;
  Numbers numbers;
  std::size_t unknown = 0;
};

Coloured with_palette(const char* what, std::vector<Colour> colours, const std::vector<PaletteEntry>& palette) {
  std::map<Colour, int> known;
  for (const PaletteEntry& entry : palette) known.emplace(entry.colour, entry.number);
  Coloured result{what, std::move(colours), {}, 0};
  for (const Colour& colour : result.colours) {
    const auto place = known.find(colour);
    result.numbers.push_back(place == known.end() ? std::nullopt : std::optional(place->second));
    result.unknown += place == known.end();
  }
  return result;
}

[[noreturn]] void refuse_unknown(const Coloured& coloured) {
  std::map<Colour, std::size_t> counts;
  for (std::size_t k = 0; k < coloured.colours.size(); ++k)
    if (!coloured.numbers[k]) ++counts[coloured.colours[k]];
  std::vector<std::pair<Colour, std::size_t>> commonest(counts.begin(), counts.end());
  std::stable_sort(commonest.begin(), commonest.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  constexpr std::size_t most_shown = 6;
  commonest.resize(std::min(commonest.size(), most_shown));
  std::string text;
  for (const auto& [colour, count] : commonest)
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", shown(colour), count);
  const double share = static_cast<double>(coloured.unknown) / static_cast<double>(coloured.colours.size());
  throw InputError(fmt::format("{:.1f} % of the {} have colours that are not in the palette; the commonest are {}",
                               100 * share, coloured.what, text));
}

/// Numbers flood from all known elements to their neighbours, one step after the other; each takes what most of its
/// known neighbours have, of equally many the lowest. What no number reaches is gum.
std::vector<int> flooded(const Numbers& known, const std::vector<std::pair<int, int>>& neighbours) {
  std::map<int, std::vector<int>> open;  // unknown elements and their neighbours
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  for (const auto& [a, b] : neighbours) {
    if (!known[at(a)]) open[a].push_back(b);
    if (!known[at(b)]) open[b].push_back(a);
  }
  Numbers numbers = known;
  for (bool goes_on = true; goes_on;) {
    std::vector<std::pair<int, int>> found;
    for (const auto& [k, around] : open) {
      std::map<int, int> votes;
      for (const int n : around)
        if (numbers[at(n)]) ++votes[*numbers[at(n)]];
      const auto best = std::max_element(votes.begin(), votes.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
      if (best != votes.end()) found.emplace_back(k, best->first);
    }
    for (const auto& [k, number] : found) {
      numbers[at(k)] = number;
      open.erase(k);
    }
    goes_on = !found.empty();
  }
  std::vector<int> result;
  for (const auto& number : numbers) result.push_back(number.value_or(0));
  return result;
}

std::vector<std::pair<int, int>> vertex_neighbours(const EdgeTable& edges) {
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [a, b] : edges.vertices) pairs.emplace_back(a, b);
  return pairs;
}

std::vector<std::pair<int, int>> triangle_neighbours(const EdgeTable& edges) {
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (int k = edges.first[e] + 1; k < edges.first[e + 1]; ++k)
      pairs.emplace_back(half_edge_triangle(edges.half_edges[static_cast<std::size_t>(k - 1)]),
                         half_edge_triangle(edges.half_edges[static_cast<std::size_t>(k)]));
  return pairs;
}

}  // namespace

std::vector<PaletteEntry> read_palette(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool is_json = first != std::string_view::npos && (text[first] == '{' || text[first] == '[');
  return is_json ? palette_from_json(text) : palette_from_text(text);
}

RawLabels labels_from_colours(const MeshFile& scan, const std::vector<PaletteEntry>& palette,
                              const ColourLabelOptions& options) {
  const Coloured triangles = with_palette("triangles", colours_among(scan.triangle_attributes), palette);
  const Coloured vertices = with_palette("vertices", colours_among(scan.vertex_attributes), palette);
  if (triangles.colours.empty() && vertices.colours.empty())
    throw InputError("the scan has no colours, neither of triangles nor of vertices");
  const auto share = [](const Coloured& c) {
    return c.colours.empty() ? 2.0 : static_cast<double>(c.unknown) / static_cast<double>(c.colours.size());
  };
  const bool by_triangle = share(triangles) <= share(vertices);
  const Coloured& chosen = by_triangle ? triangles : vertices;
  if (share(chosen) > options.unknown_share) refuse_unknown(chosen);
  const EdgeTable edges = edge_table(scan.mesh);
  RawLabels labels;
  labels.per_vertex = flooded(chosen.numbers, by_triangle ? triangle_neighbours(edges) : vertex_neighbours(edges));
  if (by_triangle) labels.per_vertex = vertex_labels_from_triangles(scan.mesh, labels.per_vertex);
  labels.origin = fmt::format("the colours of the {}", chosen.what);
  if (chosen.unknown > 0)
    labels.origin += fmt::format(" ({} without an entry in the palette took their neighbours')", chosen.unknown);
  return labels;
}

}  // namespace rhizodont
