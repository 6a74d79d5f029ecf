// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/completion_shape.hpp"

#include <array>
#include <charconv>
#include <utility>

#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

const std::string completion_format = "rhizodont completion 4";

constexpr std::array<std::pair<const char*, int CompletionShape::*>, 10> completion_sizes{{
    {"input_points", &CompletionShape::input_points},
    {"centres_1", &CompletionShape::centres_1},
    {"centres_2", &CompletionShape::centres_2},
    {"width", &CompletionShape::width},
    {"heads", &CompletionShape::heads},
    {"encoder_depth", &CompletionShape::encoder_depth},
    {"decoder_depth", &CompletionShape::decoder_depth},
    {"global_width", &CompletionShape::global_width},
    {"queries", &CompletionShape::queries},
    {"patch_points", &CompletionShape::patch_points},
}};

}  // namespace

void note_shape(const CompletionShape& shape, std::map<std::string, std::string>& metadata) {
  metadata["format"] = completion_format;
  for (const auto& [name, member] : completion_sizes)
    metadata["shape." + std::string(name)] = std::to_string(shape.*member);
}

CompletionShape read_shape(const std::map<std::string, std::string>& metadata) {
  const auto format = metadata.find("format");
  if (format == metadata.end() || format->second != completion_format)
    throw InputError("This file does not hold weights of the completion network.");
  CompletionShape shape;
  for (const auto& [name, member] : completion_sizes) {
    const auto found = metadata.find("shape." + std::string(name));
    const std::string text = found == metadata.end() ? "" : found->second;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), shape.*member);
    if (text.empty() || failure != std::errc() || end != text.data() + text.size())
      throw InputError("The weight file does not say how large the network is (" + std::string(name) + ").");
  }
  try {
    check_shape(shape);
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
  return shape;
}

void check_shape(const CompletionShape& shape) {
  for (const auto& [name, member] : completion_sizes) {
    if (shape.*member < 1 || shape.*member > 65536)
      throw UsageError("The network's size " + std::string(name) + " is out of range.");
  }
  if (shape.centres_2 < 16 || shape.centres_1 < shape.centres_2 || shape.input_points < shape.centres_1 ||
      shape.width % shape.heads != 0 || shape.queries < 8)
    throw UsageError("The network's sizes do not fit together.");
}

}  // namespace rhizodont
