// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/tooth_labels.hpp"
#include "families/register_tooth.hpp"
#include "families/tooth_family.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/jaw.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// Whole teeth of people as further templates of the families: found in a folder, written, read again.
namespace rhizodont {

/// A file with a whole tooth.
struct ToothFile {
  std::filesystem::path path;
  int fdi = 0;
  std::string name;  ///< what tells it from others: the file's name without folder, "tooth" and ending
};

struct ToothFileOptions {
  LabelNumbers numbers = LabelNumbers::fdi;  ///< of the teeth in the files' names
  std::optional<Jaw> jaw;                    ///< needed by numbers along the arch
};

/// All meshes (.ply, .stl, .obj, .off, .vtp) of a folder whose name begins with a tooth's number, behind "tooth" or
/// alone: tooth_36.ply, 36.stl, Tooth36_anna.obj; sorted by name. Throws InputError for a folder that cannot be read or
/// has no such file, and for a number that names no permanent tooth; UsageError for numbers along the arch without a
/// jaw.
std::vector<ToothFile> find_tooth_files(const std::filesystem::path& folder, const ToothFileOptions& options = {});

/// The name under which a registered tooth is kept: tooth_FDI_NAME.ply, FDI of its type's left tooth.
std::string registered_name(const ToothFile& file);

/// A registered tooth as a file: the template's triangles and labels of enamel, the tooth's coordinates.
MeshFile registered_file(const RegisteredTooth& tooth, const TemplateFile& of_type, const ToothFile& source);

/// Any vector towards the cheek from the template of a type (0..15), in the frame of the files.
Eigen::Vector3d buccal_of_template(const std::array<TemplateFile, tooth_type_count>& files, int type);

/// So many vertices has a template that crowns as fine as scans are cut from.
inline constexpr std::size_t fine_template_vertices = 20000;

/// Throws InputError with the reason for a registered tooth that load_registered_teeth would refuse, with as many
/// vertices as families have or as fine as they can be asked for (fine_template_vertices).
void require_growable(const RegisteredTooth& tooth, int fdi,
                      const std::array<TemplateFile, tooth_type_count>& templates);

/// Throws InputError for a folder that cannot be read or has no file named as a registered tooth of any type.
void require_registered_teeth(const std::filesystem::path& folder);

/// Reads the registered teeth of a type (0..15) from a folder, sorted by name, each with triangles and places of the
/// simplified template. @param buccal, vertices  as analyse_template. Throws InputError for a folder that cannot be
/// read, for a file that was registered to another template than `of_type`, and for one whose simplified surface runs
/// into itself.
std::vector<FamilyTemplate> load_registered_teeth(const std::filesystem::path& folder, int type,
                                                  const TemplateFile& of_type, const Eigen::Vector3d& buccal,
                                                  std::size_t vertices);

}  // namespace rhizodont
