// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "teeth/fdi.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace rhizodont {

/// A template tooth as its file has it.
struct TemplateFile {
  TriangleMesh mesh;                ///< closed, genus 0, outward; millimetres, in the frame of the families' folder
  std::vector<std::uint8_t> crown;  ///< per vertex: 1 enamel, 0 cementum
};

/// Reads folder/templates/tooth_FDI.ply of a type (0..15): see load_tooth_families. Throws InputError if it is missing
/// or damaged.
TemplateFile load_template_file(const std::filesystem::path& folder, int type);
/// Those of all types.
std::array<TemplateFile, tooth_type_count> load_template_files(const std::filesystem::path& folder);

struct RegisterToothOptions {
  int start_turns = 12;              ///< >= 4: rotations about the tooth's axis that are tried, either end up
  std::size_t vertices = 4000;       ///< >= 500: of the simplified template that is bent
  double largest_mean_mm = 0.15;     ///< > 0: mean distance between the two surfaces in the end
  double largest_95_mm = 0.6;        ///< > 0: 95th percentile of it
  double largest_rigid_mm = 1.0;     ///< > 0: mean distance before the template is bent
  double largest_type_ratio = 1.25;  ///< >= 1: how much worse the tooth may fit its own type than one of another kind
};

/// A whole tooth in correspondence with a template.
struct RegisteredTooth {
  std::vector<Point>
      vertices;        ///< of the template's vertices on the tooth: true size, in the template's place and pose
  double mean_mm = 0;  ///< mean distance between the registered surface and the tooth's, both ways
  double percentile_95_mm = 0;  ///< of the same
  double size_ratio = 1;        ///< the tooth's size over the template's
  double rigid_mean_mm = 0;     ///< mean distance before the template was bent
};

/// Brings a whole tooth into correspondence with the template of its type: moved, turned and scaled from many starts
/// onto it, then the template is bent onto the tooth, ever less stiffly. Deterministic.
/// @param tooth  closed, one piece, genus 0, millimetres, in any pose
/// @param fdi    of a permanent tooth; a tooth of the right side is mirrored
/// @param templates  of all types, for comparison
/// Throws InputError with the reason for a tooth that is open, in several pieces, defective, of another size or by its
/// form of another kind (incisor, canine, premolar, molar), and for one that the template cannot be brought onto;
/// UsageError for options out of range and a number that is no permanent tooth's.
RegisteredTooth register_tooth(const TriangleMesh& tooth, int fdi,
                               const std::array<TemplateFile, tooth_type_count>& templates,
                               const RegisterToothOptions& options = {});

}  // namespace rhizodont
