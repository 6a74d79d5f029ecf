// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/arch.hpp"
#include "rhizodont/tooth_directions.hpp"

#include <map>
#include <optional>
#include <string>

namespace rhizodont {

/// What is made of one crown of an arch before lengths that were measured, and its neighbours' roots, have their say.
struct MadeTooth {
  std::optional<PreparedTooth> prepared;
  std::optional<CompletedTooth> tooth;
  std::string refusal;  ///< why there is no tooth; empty if there is one
};

/// The teeth of an arch with all that they were made of, so that the next call about the same scan makes only those
/// anew that have changed.
struct ArchMemory {
  struct Tooth {
    TriangleMesh crown;
    std::optional<ToothDirections> directions;
    CompleteOptions options;  ///< of every tooth of the arch
    MadeTooth made;
  };
  std::map<int, Tooth> teeth;  ///< by FDI number
};

/// `complete_arch`, the very same result: crowns that the memory has, of the same shape, number, stand and options, are
/// taken from it; then it has those of this arch. Always to be used with the same models. Where it throws, the memory
/// is as it was.
CompletedArch complete_arch(const LabelledScan& scan, const CompletionModels& models, const ArchOptions& options,
                            const ArchProgress& progress, ArchMemory& memory);

}  // namespace rhizodont
