// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/registered_templates.hpp"

#include "base/lower_case.hpp"
#include "base/parallel_tasks.hpp"
#include "families/self_crossing.hpp"
#include "families/tooth_template.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/nearest_vertex.hpp"
#include "rhizodont/error.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <system_error>

namespace rhizodont {
namespace {

/// The files of a folder, sorted by name.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->is_regular_file()) files.push_back(at->path());
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

/// Where a point of a mesh's surface goes when the mesh's vertices go to `to`.
Point carried_along(const Point& p, const TriangleMesh& mesh, const ClosestPointIndex& surface,
                    const std::vector<Point>& to) {
  const ClosestPoint near = surface.closest(p);
  const Triangle& t = mesh.triangles[static_cast<std::size_t>(near.triangle)];
  const std::array<std::size_t, 3> v{static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                                     static_cast<std::size_t>(t[2])};
  Eigen::Matrix<double, 3, 2> sides;
  sides << mesh.vertices[v[1]] - mesh.vertices[v[0]], mesh.vertices[v[2]] - mesh.vertices[v[0]];
  const Eigen::Vector2d share = sides.colPivHouseholderQr().solve(near.point - mesh.vertices[v[0]]);
  return to[v[0]] + share[0] * (to[v[1]] - to[v[0]]) + share[1] * (to[v[2]] - to[v[0]]);
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
  const TriangleMesh light = simplified(of_type.mesh, vertices);
  const ClosestPointIndex surface(of_type.mesh);
  const NearestVertexIndex full(of_type.mesh.vertices);
  std::vector<std::uint8_t> crown;
  for (const Point& p : light.vertices) crown.push_back(of_type.crown[static_cast<std::size_t>(full.nearest(p).index)]);
  parallel_tasks(files.size(), [&](std::size_t i) {
    const TriangleMesh registered = load_mesh(files[i]).mesh;
    if (registered.triangles != of_type.mesh.triangles)
      throw InputError(fmt::format(
          "{} was not registered to the template of {} in this folder: register the tooth anew (rhizodont register).",
          files[i].string(), fdi_of_type(type, false)));
    TriangleMesh mesh = light;
    for (Point& p : mesh.vertices) p = carried_along(p, of_type.mesh, surface, registered.vertices);
    teeth[i] = analyse_template(mesh, crown, buccal, mesh.vertices.size());
    if (crosses_itself(teeth[i].mesh))
      throw InputError(files[i].string() + " runs into itself once it is simplified: no tooth can be grown from it.");
  });
  return teeth;
}

}  // namespace rhizodont
