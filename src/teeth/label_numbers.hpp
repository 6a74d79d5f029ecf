// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/tooth_labels.hpp"
#include "rhizodont/mesh.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Which teeth the numbers of a labelled scan mean.
namespace rhizodont {

/// fdi, universal, arch14 or arch16, as `--labels-are` takes them. Throws UsageError for another word.
LabelNumbers read_label_numbers(std::string_view word);

/// The word that `read_label_numbers` takes.
const char* label_numbers_name(LabelNumbers numbers);

/// The jaw of a permanent or milk tooth. Throws UsageError for other numbers.
Jaw jaw_of_fdi(int fdi);

/// FDI number of 1-32; nothing for others, and for 33, which is gum.
std::optional<int> fdi_of_universal(int number);

/// FDI number of the tooth at a place along an arch of 14 or 16, counted from 1 at the patient's right. Throws
/// UsageError for another place or arch.
int fdi_of_arch_place(int place, int arch_length, Jaw jaw);

struct LabelNumberOptions {
  std::optional<LabelNumbers> forced;  ///< `--labels-are`
  std::optional<LabelNumbers> stated;  ///< RawLabels::stated_numbers: taken where the numbers allow it
  std::optional<Jaw> jaw;              ///< `--jaw`, else RawLabels::stated_jaw; needed by numbers along the arch
  std::optional<bool> first_is_patients_right;  ///< of numbers along the arch; nothing: geometry decides
  /// (0, 1): 33 on more than this share of the labelled surface is gum, not a canine
  double gum_share = 0.3;
};

/// Teeth of a scan by FDI numbers.
struct ScanLabels {
  std::vector<int> fdi;  ///< per vertex; 0 is gum
  LabelNumbers numbers = LabelNumbers::fdi;
  std::string decided;  ///< a sentence: what the numbers were taken for, and why
};

/// Decides what the numbers are and turns them into FDI numbers.
/// - Forced, if the caller says so; as stated by their source, if all of them exist there; else
/// - one of 34-38, 41-48, 51-85: FDI;
/// - none above 33, and 33 on more than `gum_share` of the surface, 0 on hardly any: universal;
/// - none above 14 (16): along the arch;
/// - all of them FDI numbers: FDI; all at most 33: universal.
/// Numbers 11-16 alone could be FDI or along the arch: refused unless stated, forced or told by the jaw.
/// Along the arch, which end is the patient's right follows from the surface: up is where the teeth's surfaces face
/// (down in an upper jaw), front from the two end teeth to those between, left = up x front. Nothing depends on the
/// pose. Where fewer than three teeth, or a straight row, leave that open, label 1 of an upper jaw is at the right, and
/// a lower jaw is refused.
/// Throws InputError, a sentence each: no tooth at all; numbers that name no tooth (which, on how many vertices; ids of
/// vertices); along the arch without a jaw (asks for `--jaw`).
/// Precondition: valid indices, finite coordinates, a number per vertex.
ScanLabels decide_label_numbers(const TriangleMesh& mesh, const std::vector<int>& raw,
                                const LabelNumberOptions& options = {});

/// The labels in another numbering, 0 (universal: 33) for gum; along the arch label 1 is at the patient's right in both
/// jaws. Throws InputError, naming the teeth, for those that have no number there: milk teeth (universal, arch), wisdom
/// teeth (arch14), teeth of both jaws (arch).
std::vector<int> numbered_as(const std::vector<int>& fdi, LabelNumbers numbers);

}  // namespace rhizodont
