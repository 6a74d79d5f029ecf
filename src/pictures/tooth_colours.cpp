// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/tooth_colours.hpp"

#include "base/tooth_labels.hpp"
#include "io/scan_labels.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>

namespace rhizodont {

Colour colour_of_tooth(int fdi) {
  constexpr std::array<Colour, 4> colours{
      {{0.80F, 0.62F, 0.36F}, {0.45F, 0.62F, 0.72F}, {0.62F, 0.70F, 0.42F}, {0.60F, 0.50F, 0.70F}}};
  constexpr Colour gum{0.72F, 0.38F, 0.36F};
  if (fdi <= 0) return gum;
  const bool right_side = fdi / 10 % 4 <= 1;                // quadrants 1, 4, of milk teeth 5, 8
  const int from_middle = fdi % 10 + (right_side ? 0 : 2);  // the two central incisors are neighbours, too
  return colours[static_cast<std::size_t>(from_middle) % colours.size()];
}

std::vector<Colour> colours_by_tooth(const TriangleMesh& mesh, const std::vector<double>& fdi) {
  if (fdi.size() != mesh.vertices.size()) throw InputError("a colour by tooth needs one number per vertex");
  std::vector<int> numbers;
  for (const double number : fdi) {
    if (!(number >= 0 && number < 1000))
      throw InputError(fmt::format("The attribute {} holds {}, which is no tooth's number.", fdi_attribute, number));
    numbers.push_back(static_cast<int>(number));
  }
  std::vector<Colour> chosen;
  for (const int number : triangle_labels_from_vertices(mesh, numbers)) chosen.push_back(colour_of_tooth(number));
  return chosen;
}

}  // namespace rhizodont
