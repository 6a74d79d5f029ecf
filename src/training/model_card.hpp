// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace rhizodont {

/// Texts of the model cards, from src/training/cards: what weights are, where they come from and what they must not be
/// used for. Values stand in them as {name}.
extern const std::string_view completion_card_template;
extern const std::string_view skirt_card_template;
extern const std::string_view segment_card_template;

/// A card with the value of each name in the place of {name}. Values are taken as they are.
/// Throws InputError for a name that has no value and for a brace that is not closed.
std::string model_card(std::string_view text, const std::map<std::string, std::string>& values);

/// A weight file as its card speaks of it.
struct WeightFile {
  std::string name;                             ///< of the file, without folder
  std::size_t bytes = 0;                        ///< its size
  std::map<std::string, std::string> metadata;  ///< what it says of itself
};

/// The card of weights of the completion network, of the skirt network or of the one that finds teeth. Figures of
/// weights that were never validated are "not measured". Throws InputError where the metadata lacks anything else that
/// the card says.
std::string completion_card(const WeightFile& weights);
std::string skirt_card(const WeightFile& weights);
std::string segment_card(const WeightFile& weights);

}  // namespace rhizodont
