// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <string>
#include <vector>

namespace rhizodont {

/// What a person who looks at a labelled scan says is wrong with it.
struct LabelCorrection {
  enum class Kind {
    number,  ///< the tooth at `at` is `fdi`; a tooth that was `fdi` gets its number
    merge,   ///< `other` is a part of tooth `fdi`
    split,   ///< the tooth at `at` is two, which meet there; one of them is `fdi`
    remove,  ///< there is no tooth `fdi`: what bears its number is gum
  };
  Kind kind = Kind::number;
  int fdi = 0;               ///< FDI number, 11-48 or 51-85
  int other = 0;             ///< likewise; of `merge` alone
  Point at = Point::Zero();  ///< in the scan's frame and unit; of `number` and `split` alone
};

struct CorrectedLabels {
  std::vector<int> fdi;            ///< per vertex, 0 is gum
  std::vector<std::string> notes;  ///< a sentence for each correction
};

/// Makes the corrections one after the other. A tooth is divided by the plane through the place that is across its
/// length, seen from where its surface faces; smaller pieces beyond it stay with what they hang together with. Of the
/// two parts that one is `fdi` which is nearer to the teeth that `fdi` stands nearer to, without others the smaller
/// one. Throws UsageError for a number of no tooth, a place farther than 2 mm from any tooth, a tooth that is not
/// there, a number for a part that another tooth has, and a division that leaves a part less than a tenth of the tooth.
/// @param fdi  per vertex, 0 is gum
/// @param millimetres_per_unit  of the mesh
/// Precondition: valid indices, finite coordinates, a label per vertex.
CorrectedLabels correct_labels(const TriangleMesh& mesh, std::vector<int> fdi,
                               const std::vector<LabelCorrection>& corrections, double millimetres_per_unit = 1);

}  // namespace rhizodont
