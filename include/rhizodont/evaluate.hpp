// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"
#include "rhizodont/export.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/models.hpp"

#include <filesystem>
#include <functional>
#include <string>

namespace rhizodont {

struct EvaluateOptions {
  CompleteOptions tooth;            ///< of every tooth; its number must be unset, for the files' names have it
  std::filesystem::path templates;  ///< folder with tooth_FDI.ply: the template fit's figures stand beside; empty: none
};

/// Called before each tooth is made: whose number, its place among the cases from 0, how many cases there are, and by
/// what it is made ("rhizodont", "template").
using EvaluateProgress = std::function<void(int fdi, int place, int cases, const std::string& predictor)>;

/// Completes the crowns of a folder whose whole teeth are known (crown_FDI and tooth_FDI, or _FDI_NAME, mm) and
/// measures how far the roots are off: the figures of `rhizodont evaluate --json`. Throws InputError for a folder
/// without such pairs, UsageError for options out of range; what goes wrong with one tooth is that tooth's failure in
/// the figures.
RHIZODONT_EXPORT std::string evaluate_to_json(const std::filesystem::path& cases, const CompletionModels& models,
                                              const EvaluateOptions& options = {},
                                              const EvaluateProgress& progress = {});

/// How far the root of one tooth is from the true one's, as JSON: of the same names as in `evaluate_to_json`. The axis
/// is that of the crown's border.
/// @param crown  open at its base, mm; the others stand on it
/// Throws InputError for a crown that is closed, for meshes without a surface, and for a true tooth without a root
/// below the crown; NoResultError for a prediction without one.
RHIZODONT_EXPORT std::string root_figures_to_json(const TriangleMesh& crown, const TriangleMesh& truth,
                                                  const TriangleMesh& predicted);

}  // namespace rhizodont
