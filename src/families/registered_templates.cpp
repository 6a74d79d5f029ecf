// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/registered_templates.hpp"

#include "base/lower_case.hpp"
#include "families/self_crossing.hpp"
#include "families/tooth_template.hpp"
#include "mesh/nearest_vertex.hpp"
#include "rhizodont/error.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <system_error>

namespace rhizodont {
namespace {

bool is_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::none)  // a link that leads nowhere is merely not found
    throw InputError("The file " + path.string() + " cannot be read: " + error.message() + ".");
  return std::filesystem::is_regular_file(status);
}

/// The files of a folder, sorted by name.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (is_file(at->path())) files.push_back(at->path());
  if (error) throw InputError("The folder " + folder.string() + " cannot be read: " + error.message() + ".");
  std::sort(files.begin(), files.end());
  return files;
}

/// A file's name without "tooth" and a separator in front, and without its ending.
std::string name_of(const std::filesystem::path& file) {
  std::string name = file.stem().string();
  if (lower_case(name).starts_with("tooth")) name.erase(0, 5);
  if (!name.empty() && (name[0] == '_' || name[0] == '-' || name[0] == ' ')) name.erase(0, 1);
  return name;
}

/// The number that a name begins with.
std::optional<int> number_in(const std::string& name) {
  int number = 0;
  const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (failure != std::errc() || end == name.data()) return std::nullopt;
  return number;
}

std::optional<int> fdi_of(int number, const ToothFileOptions& options) {
  switch (options.numbers) {
    case LabelNumbers::fdi:
      return is_permanent_tooth(number) ? std::optional(number) : std::nullopt;
    case LabelNumbers::universal:
      return fdi_of_universal(number);
    case LabelNumbers::arch14:
    case LabelNumbers::arch16:
      break;
  }
  if (!options.jaw) throw UsageError("Numbers along the arch need the jaw (--jaw upper or lower).");
  const int length = options.numbers == LabelNumbers::arch14 ? 14 : 16;
  if (number < 1 || number > length) return std::nullopt;
  return fdi_of_arch_place(number, length, *options.jaw);
}

}  // namespace

std::vector<ToothFile> find_tooth_files(const std::filesystem::path& folder, const ToothFileOptions& options) {
  constexpr std::array<std::string_view, 5> endings{".ply", ".stl", ".obj", ".off", ".vtp"};
  std::vector<ToothFile> teeth;
  for (const std::filesystem::path& file : files_of(folder)) {
    const std::string ending = lower_case(file.extension().string());
    if (std::find(endings.begin(), endings.end(), ending) == endings.end()) continue;
    const std::string name = name_of(file);
    const std::optional<int> number = number_in(name);
    if (!number) continue;
    const std::optional<int> fdi = fdi_of(*number, options);
    if (!fdi)
      throw InputError(fmt::format("The number {} in the file name {} names no permanent tooth in this numbering.",
                                   *number, file.filename().string()));
    teeth.push_back({file, *fdi, name});
  }
  if (teeth.empty())
    throw InputError("The folder " + folder.string() + " has no mesh whose name begins with a tooth's number.");
  return teeth;
}

std::string registered_name(const ToothFile& file) {
  return fmt::format("tooth_{}_{}.ply", fdi_of_type(tooth_type_of_fdi(file.fdi), false), file.name);
}

MeshFile registered_file(const RegisteredTooth& tooth, const TemplateFile& of_type, const ToothFile& source) {
  MeshFile file;
  file.mesh.vertices = tooth.vertices;
  file.mesh.triangles = of_type.mesh.triangles;
  VertexAttribute& crown = file.vertex_attributes["crown"];
  crown.type = AttributeType::uint8;
  crown.values.assign(of_type.crown.begin(), of_type.crown.end());
  file.comments = {
      fmt::format("a tooth {} registered to the template of its type by rhizodont register", source.fdi),
      fmt::format("surfaces {:.3f} mm apart, 95 % within {:.3f} mm", tooth.mean_mm, tooth.percentile_95_mm)};
  return file;
}

std::vector<FamilyTemplate> load_registered_teeth(const std::filesystem::path& folder, int type,
                                                  const TemplateFile& of_type, const Eigen::Vector3d& buccal,
                                                  std::size_t vertices) {
  const std::string begins = fmt::format("tooth_{}_", fdi_of_type(type, false));
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& file : files_of(folder))
    if (file.extension() == ".ply" && file.stem().string().starts_with(begins)) files.push_back(file);
  std::vector<FamilyTemplate> teeth(files.size());
  if (files.empty()) return teeth;
  const LightTemplate light = light_template(of_type.mesh, vertices);
  const NearestVertexIndex full(of_type.mesh.vertices);
  std::vector<std::uint8_t> crown;
  for (const Point& p : light.mesh.vertices)
    crown.push_back(of_type.crown[static_cast<std::size_t>(full.nearest(p).index)]);
  tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t i) {
    const TriangleMesh registered = load_mesh(files[i]).mesh;
    if (registered.triangles != of_type.mesh.triangles)
      throw InputError(fmt::format(
          "{} was not registered to the template of {} in this folder: register the tooth anew (rhizodont register).",
          files[i].string(), fdi_of_type(type, false)));
    const TriangleMesh mesh = moved_with(light, registered.vertices);
    teeth[i] = analyse_template(mesh, crown, buccal, mesh.vertices.size());
    if (crosses_itself(teeth[i].mesh))
      throw InputError(files[i].string() + " runs into itself once it is simplified: no tooth can be grown from it.");
  });
  return teeth;
}

}  // namespace rhizodont
