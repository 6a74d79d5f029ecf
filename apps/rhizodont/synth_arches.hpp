// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/output_options.hpp"
#include "families/arch_family.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace rhizodont::command_line {

/// What `synth --arch` was asked for.
struct SynthArches {
  std::filesystem::path data, output, sheet;
  int count = 1;
  std::uint64_t seed = 0;
  std::string format = "ply";
  ArchDrawOptions options;
  OutputOptions said;
};

/// Writes arch_SEED_JAW.ply (or .obj), its labels (arch_SEED_JAW.json, Teeth3DS) and what was drawn
/// (arch_SEED_JAW_drawn.json), or a picture of them all. Throws as sample_arch and write_output_files.
void write_arches(const SynthArches& command);

}  // namespace rhizodont::command_line
