// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "reproduction/inputs.hpp"

#include "families/crown_crop.hpp"
#include "families/scanner_mesh.hpp"
#include "families/tooth_family.hpp"
#include "guiding/guiding_cloud.hpp"
#include "intake/take_crown.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/quality.hpp"
#include "pipeline/models.hpp"
#include "poisson/clouds.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "teeth/prepared_crown.hpp"
#include "training/sample_numbers.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

/// The shares of marked teeth, each none or all.
ToothVariation variation_of(const std::string& mark) {
  const std::map<std::string, std::vector<double ToothVariation::*>> shares{
      {"none", {}},
      {"worn", {&ToothVariation::wear_share}},
      {"bracket", {&ToothVariation::bracket_share}},
      {"worn-bracket", {&ToothVariation::wear_share, &ToothVariation::bracket_share}},
      {"decayed", {&ToothVariation::decay_share}}};
  const auto chosen = shares.find(mark);
  if (chosen == shares.end()) throw UsageError("There is no mark '" + mark + "'.");
  ToothVariation variation;
  variation.deciduous_share = 0;
  for (const auto& [name, members] : shares)
    for (const auto member : members) variation.*member = 0;
  for (const auto member : chosen->second) variation.*member = 1;
  return variation;
}

/// Two vertices more, which no triangle has, with 0 and `most`: pictures of several meshes share one scale.
void add_scale_ends(TriangleMesh& mesh, std::vector<double>& values, double most) {
  for (const double end : {0.0, most}) {
    mesh.vertices.push_back(mesh.vertices.front());
    values.push_back(end);
  }
}

}  // namespace

TriangleMesh open_crown(const TriangleMesh& crown, int fdi, const CompletionModels& models) {
  CompleteOptions options;
  options.fdi = fdi;
  return take_crown(crown, content_of(models)->atlas, std::nullopt, options).kept.mesh;
}

OrientedPoints guiding_samples(const TriangleMesh& crown, int fdi, const CompletionModels& models) {
  return assemble_guiding_cloud(prepare_crown(crown), predicted_points(crown, fdi, models)).samples;
}

MarkedTooth marked_tooth(const std::filesystem::path& data, int fdi, std::uint64_t seed, const std::string& mark) {
  const int type = tooth_type_of_fdi(fdi);
  FamilyLoadOptions options;
  options.vertices = 12000;
  options.types = {type};
  const SyntheticTooth tooth =
      generate_tooth(load_tooth_families(data, options), type, first_validation_sample + seed, variation_of(mark));
  RandomStream random(seed);
  return {scanner_mesh(trim_clean(tooth, random).mesh, 0.3, 0.005, seed), tooth.mesh};
}

MeshFile with_deviation(const TriangleMesh& crown, const TriangleMesh& surface, double most_mm) {
  MeshFile file;
  file.mesh = crown;
  std::vector<double> distances;
  const ClosestPointIndex index(surface);
  for (const Point& p : crown.vertices) distances.push_back(std::min(most_mm, index.closest(p).distance));
  add_scale_ends(file.mesh, distances, most_mm);
  file.vertex_attributes["deviation_mm"] = {AttributeType::float32, std::move(distances)};
  return file;
}

MeshFile with_quality(const TriangleMesh& mesh) {
  MeshFile file;
  file.mesh = mesh;
  std::vector<double> worst(mesh.vertices.size(), 1.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::int32_t v : mesh.triangles[t]) {
      double& at = worst[static_cast<std::size_t>(v)];
      at = std::min(at, triangle_quality(mesh, t));
    }
  add_scale_ends(file.mesh, worst, 1);
  file.vertex_attributes["quality"] = {AttributeType::float32, std::move(worst)};
  return file;
}

MeshFile near_transition(const MeshFile& tooth, const MeshFile& smoothed, double reach_mm) {
  const auto source = smoothed.vertex_attributes.find(source_attribute);
  if (source == smoothed.vertex_attributes.end() || !tooth.vertex_attributes.contains(source_attribute))
    throw InputError("The tooth does not say where it comes from.");
  std::vector<Point> middle;
  for (std::size_t v = 0; v < smoothed.mesh.vertices.size(); ++v)
    if (source->second.values[v] == static_cast<double>(VertexSource::transition))
      middle.push_back(smoothed.mesh.vertices[v]);
  if (middle.empty()) throw InputError("The tooth has no transition.");
  const auto is_near = [&](std::int32_t v) {
    const Point& p = tooth.mesh.vertices[static_cast<std::size_t>(v)];
    return std::any_of(middle.begin(), middle.end(), [&](const Point& m) { return (m - p).norm() <= reach_mm; });
  };
  std::vector<bool> taken;
  for (const Triangle& t : tooth.mesh.triangles) taken.push_back(std::all_of(t.begin(), t.end(), is_near));
  const Submesh kept = submesh(tooth.mesh, taken);
  MeshFile part;
  part.mesh = kept.mesh;
  VertexAttribute& attribute = part.vertex_attributes[source_attribute];
  attribute.type = AttributeType::uint8;
  for (const int v : kept.old_vertices)
    attribute.values.push_back(tooth.vertex_attributes.at(source_attribute).values[static_cast<std::size_t>(v)]);
  return part;
}

}  // namespace rhizodont
