// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/surface_shape.hpp"

#include <array>
#include <charconv>
#include <utility>

#include "networks/surface_sample.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

const std::string surface_format = "rhizodont surface 1";

constexpr std::array<std::pair<const char*, int SurfaceShape::*>, 3> surface_sizes{{
    {"width", &SurfaceShape::width},
    {"blocks", &SurfaceShape::blocks},
    {"eigenvectors", &SurfaceShape::eigenvectors},
}};
constexpr std::array<std::pair<const char*, bool SurfaceShape::*>, 3> surface_inputs{{
    {"position", &SurfaceShape::position},
    {"signature", &SurfaceShape::signature},
    {"surroundings", &SurfaceShape::surroundings},
}};

std::array<std::pair<const char*, int>, 2> counts_of(const SurfaceShape& shape) {
  return {{{"features", feature_count(shape)}, {"outputs", surface_output_count}}};
}

}  // namespace

int feature_count(const SurfaceShape& shape) {
  return (shape.position ? SurfaceFeature::normal - SurfaceFeature::position : 0) +
         (shape.surroundings ? SurfaceFeature::signature - SurfaceFeature::normal : 0) +
         (shape.signature ? surface_feature_count - SurfaceFeature::signature : 0);
}

void note_surface_counts(const SurfaceShape& shape, std::map<std::string, std::string>& metadata) {
  for (const auto& [name, count] : counts_of(shape)) metadata[name] = std::to_string(count);
}

void note_surface_shape(const SurfaceShape& shape, std::map<std::string, std::string>& metadata) {
  metadata["format"] = surface_format;
  for (const auto& [name, member] : surface_sizes)
    metadata["shape." + std::string(name)] = std::to_string(shape.*member);
  for (const auto& [name, member] : surface_inputs)
    metadata["input." + std::string(name)] = shape.*member ? "yes" : "no";
}

SurfaceShape read_surface_shape(const std::map<std::string, std::string>& metadata) {
  const auto text_of = [&](const std::string& key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? std::string() : found->second;
  };
  if (text_of("format") != surface_format) throw InputError("This file does not hold weights of a surface network.");
  SurfaceShape shape;
  for (const auto& [name, member] : surface_sizes) {
    const std::string text = text_of("shape." + std::string(name));
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), shape.*member);
    if (text.empty() || failure != std::errc() || end != text.data() + text.size())
      throw InputError("The weight file does not say how large the network is (" + std::string(name) + ").");
  }
  for (const auto& [name, member] : surface_inputs) {
    const std::string text = text_of("input." + std::string(name));
    if (text != "yes" && text != "no") throw InputError("The weight file does not say what the network looks at.");
    shape.*member = text == "yes";
  }
  try {
    check_surface_shape(shape);
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
  for (const auto& [name, count] : counts_of(shape))
    if (const std::string text = text_of(name); !text.empty() && text != std::to_string(count))
      throw InputError("The weights are of a network with " + text + " " + name + ", here it has " +
                       std::to_string(count) + ".");
  return shape;
}

void check_surface_shape(const SurfaceShape& shape) {
  for (const auto& [name, member] : surface_sizes)
    if (shape.*member < 1 || shape.*member > 1024)
      throw UsageError("The surface network's size " + std::string(name) + " is out of range.");
  if (shape.blocks > 64) throw UsageError("The surface network has too many blocks.");
  if (!shape.position && !shape.signature && !shape.surroundings)
    throw UsageError("A surface network must look at something.");
}

}  // namespace rhizodont
