// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/jaw.hpp"

namespace rhizodont {

/// What the labels of a scan number teeth by. In all of them 0 is gum.
enum class LabelNumbers {
  fdi,        ///< ISO 3950: 11-48, milk teeth 51-85
  universal,  ///< 1-32 from the upper right wisdom tooth to the lower right one; 33 is gum too
  arch14,     ///< 1-14 along the arch, second molar to second molar; label 1 is 17 in most upper jaws
  arch16,     ///< 1-16 along the arch, wisdom tooth to wisdom tooth
};

/// Vertex attribute with numbers of teeth: FDI, 0 for gum.
inline constexpr const char* fdi_attribute = "fdi";

}  // namespace rhizodont
