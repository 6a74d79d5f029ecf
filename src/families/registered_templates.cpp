// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/registered_templates.hpp"

#include "base/lower_case.hpp"
#include "base/parallel_tasks.hpp"
#include "families/arch_directions.hpp"
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

// The files stand in one mouth: y up, z to the front, x to the patient's left. The arch runs through the crowns.
Eigen::Vector3d crown_centre(const TriangleMesh& mesh, const std::vector<std::uint8_t>& crown) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t v = 0; v < crown.size(); ++v) {
    if (crown[v] == 1) sum += mesh.vertices[v], count += 1;
  }
  return sum / count;
}

/// A type's template simplified, and how its places become a registered tooth's.
class Simplification {
 public:
  Simplification(const TemplateFile& of_type, std::size_t vertices)
      : of_type_(of_type), light_(simplified(of_type.mesh, vertices)), surface_(of_type.mesh) {
    const NearestVertexIndex full(of_type.mesh.vertices);
    for (const Point& p : light_.vertices)
      crown_.push_back(of_type.crown[static_cast<std::size_t>(full.nearest(p).index)]);
  }

  /// `registered`: of the template's vertices. Throws InputError if the surface then runs into itself.
  FamilyTemplate tooth(const std::vector<Point>& registered, const Eigen::Vector3d& buccal) const {
    TriangleMesh mesh = light_;
    for (Point& p : mesh.vertices) p = carried_along(p, of_type_.mesh, surface_, registered);
    FamilyTemplate tooth = analyse_template(mesh, crown_, buccal, mesh.vertices.size());
    if (crosses_itself(tooth.mesh))
      throw InputError("It runs into itself once it is simplified: no tooth can be grown from it.");
    return tooth;
  }

 private:
  const TemplateFile& of_type_;
  TriangleMesh light_;
  ClosestPointIndex surface_;
  std::vector<std::uint8_t> crown_;
};

std::string registered_beginning(int type) { return fmt::format("tooth_{}_", fdi_of_type(type, false)); }

bool is_registered_name(const std::filesystem::path& file, const std::string& begins) {
  return file.extension() == ".ply" && file.stem().string().starts_with(begins);
}

}  // namespace

Eigen::Vector3d buccal_of_template(const std::array<TemplateFile, tooth_type_count>& files, int type) {
  // From the front to the back by position: neighbours in the file need not be neighbours in the mouth.
  std::vector<Eigen::Vector3d> arch;
  const std::size_t first = type < 8 ? 0 : 8;
  for (std::size_t t = first; t < first + 8; ++t) arch.push_back(crown_centre(files[t].mesh, files[t].crown));
  const Eigen::Vector3d centre = arch[static_cast<std::size_t>(type) - first];
  std::sort(arch.begin(), arch.end(), [](const auto& a, const auto& b) { return a.z() - a.x() > b.z() - b.x(); });
  return buccal_direction(arch, static_cast<std::size_t>(std::find(arch.begin(), arch.end(), centre) - arch.begin()));
}

void require_growable(const RegisteredTooth& tooth, int fdi,
                      const std::array<TemplateFile, tooth_type_count>& templates) {
  const int type = tooth_type_of_fdi(fdi);
  const Eigen::Vector3d buccal = buccal_of_template(templates, type);
  for (const std::size_t vertices : {FamilyLoadOptions{}.vertices, fine_template_vertices})
    Simplification(templates[static_cast<std::size_t>(type)], vertices).tooth(tooth.vertices, buccal);
}

void require_registered_teeth(const std::filesystem::path& folder) {
  for (const std::filesystem::path& file : files_of(folder))
    for (int type = 0; type < tooth_type_count; ++type)
      if (is_registered_name(file, registered_beginning(type))) return;
  throw InputError("The folder " + folder.string() +
                   " has no registered tooth (tooth_FDI_NAME.ply, as rhizodont register writes them).");
}

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
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& file : files_of(folder))
    if (is_registered_name(file, registered_beginning(type))) files.push_back(file);
  std::vector<FamilyTemplate> teeth(files.size());
  if (files.empty()) return teeth;
  const Simplification simplification(of_type, vertices);
  parallel_tasks(files.size(), [&](std::size_t i) {
    const TriangleMesh registered = load_mesh(files[i]).mesh;
    if (registered.triangles != of_type.mesh.triangles)
      throw InputError(fmt::format(
          "{} was not registered to the template of {} in this folder: register the tooth anew (rhizodont register).",
          files[i].string(), fdi_of_type(type, false)));
    try {
      teeth[i] = simplification.tooth(registered.vertices, buccal);
    } catch (const InputError& error) {
      throw error.reworded(files[i].string() + ": " + error.what());
    }
  });
  return teeth;
}

}  // namespace rhizodont
