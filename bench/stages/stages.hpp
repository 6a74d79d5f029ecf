// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/models.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace rhizodont {

/// A stage of completing one crown, ready to be run as often as wished: what it takes has been made before.
struct BenchStage {
  std::string name;  ///< without blanks
  std::function<void()> run;
};

/// Where the root's points come from.
enum class RootOfBench {
  network,  ///< as in the product
  peg,      ///< a round peg below the crown's border: neither weights nor BLAS have a say in what the later stages do
};

/// The stages of completing a crown, in their order, then what is made of several of them. With a peg those that ask a
/// network are left out. @param crown  a file without skirt @param e  mm, as CompleteOptions::e
/// Throws what the stages throw.
std::vector<BenchStage> stages_of(const std::filesystem::path& crown, int fdi, double e, RootOfBench root,
                                  const std::shared_ptr<const CompletionModels>& models);

}  // namespace rhizodont
