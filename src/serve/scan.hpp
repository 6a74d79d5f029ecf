// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/io.hpp"
#include "serve/arch_work.hpp"
#include "serve/limits.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace rhizodont::serve {

/// A file that was sent, read and kept for jobs. Its name is not kept: names tell of patients.
struct Scan {
  MeshFile file;
  std::string sha256;
  std::optional<int> fdi_in_name;
  bool has_label_array = false;
  /// Larger than one tooth in mm: what a page offers first.
  bool looks_like_arch = false;
  std::string labels;  ///< text of a Teeth3DS file; empty: none was sent
  /// What its last job as an arch knew; never null.
  std::shared_ptr<ArchShelf> shelf = std::make_shared<ArchShelf>();
};

/// Reads what was sent. One at a time: packed files may need much memory for a moment. Throws as `read_mesh`; Refusal
/// (413) for more triangles than allowed.
/// @param name  of the file, for its ending and the tooth's number
Scan read_sent_scan(std::string_view bytes, const std::string& name, const ServeLimits& limits);

}  // namespace rhizodont::serve
