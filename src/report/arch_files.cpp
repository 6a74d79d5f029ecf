// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/arch_files.hpp"

#include "base/tooth_labels.hpp"
#include "io/scan_labels.hpp"
#include "io/scene.hpp"
#include "io/write_labels.hpp"
#include "mesh/append_mesh.hpp"
#include "pictures/render.hpp"
#include "pictures/tooth_colours.hpp"
#include "report/json.hpp"
#include "rhizodont/report.hpp"
#include "rhizodont/tooth_file.hpp"
#include "rhizodont/version.hpp"
#include "teeth/fdi.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <set>
#include <utility>

namespace rhizodont {
namespace {

using Json = nlohmann::ordered_json;

std::string name_of(const char* kind, int fdi, const std::string& ending) {
  return fmt::format("{}_{}.{}", kind, fdi, ending);
}

MeshFile crown_file(const ToothOfArch& tooth, const MeshFile& scan) {
  MeshFile file;
  file.mesh = tooth.crown;
  for (const auto& [name, attribute] : scan.vertex_attributes) {
    VertexAttribute& part = file.vertex_attributes[name];
    part.type = attribute.type;
    for (const int v : tooth.scan_vertices) part.values.push_back(attribute.values[static_cast<std::size_t>(v)]);
  }
  VertexAttribute& numbers_in_scan = file.vertex_attributes["scan_vertex"] = {AttributeType::int32, {}};
  for (const int v : tooth.scan_vertices)
    numbers_in_scan.values.push_back(scan.file_vertices.empty() ? v : scan.file_vertices[static_cast<std::size_t>(v)]);
  file.comments = {"crown as cut from its scan; scan_vertex: number of the vertex in the scan's file, from 0"};
  return file;
}

MeshFile with_clearance(MeshFile file, const ToothOfArch& tooth) {
  VertexAttribute& clearance = file.vertex_attributes["clearance"];
  for (const double c : tooth.clearance) clearance.values.push_back(static_cast<float>(c));
  return file;
}

/// All teeth in one mesh.
MeshFile arch_in_one(const CompletedArch& arch) {
  MeshFile file;
  VertexAttribute fdi{AttributeType::uint8, {}}, source{AttributeType::uint8, {}},
      uncertainty{AttributeType::float32, {}}, clearance{AttributeType::float32, {}};
  for (const ToothOfArch& tooth : arch.teeth) {
    if (!tooth.tooth) continue;
    append_mesh(file.mesh, tooth.tooth->mesh);
    fdi.values.resize(file.mesh.vertices.size(), tooth.fdi);
    for (const VertexSource s : tooth.tooth->source) source.values.push_back(static_cast<double>(s));
    for (const double u : tooth.tooth->uncertainty) uncertainty.values.push_back(static_cast<float>(u));
    for (const double c : tooth.clearance) clearance.values.push_back(static_cast<float>(c));
  }
  file.vertex_attributes = {{fdi_attribute, std::move(fdi)},
                            {source_attribute, std::move(source)},
                            {"uncertainty", std::move(uncertainty)},
                            {"clearance", std::move(clearance)}};
  file.comments = {"whole teeth: scanned crowns with predicted roots, not the patient's anatomy",
                   "fdi: number of the tooth", "source: 0 scan, 1 transition, 2 predicted",
                   "clearance: signed distance from the nearest other tooth, mm, at most 3"};
  return file;
}

std::string scene_of(const CompletedArch& arch, double millimetres_per_unit) {
  std::vector<SceneNode> nodes;
  for (const ToothOfArch& tooth : arch.teeth)
    if (tooth.tooth)
      nodes.push_back({fmt::format("tooth {}", tooth.fdi), &tooth.tooth->mesh, colour_of_tooth(tooth.fdi)});
  if (!arch.gum.triangles.empty()) nodes.push_back({"gum", &arch.gum, colour_of_tooth(0)});
  return scene_bytes(nodes, millimetres_per_unit);
}

std::optional<Jaw> only_jaw(const std::vector<int>& labels) {
  std::set<Jaw> jaws;
  for (const int fdi : labels)
    if (fdi != 0) jaws.insert(jaw_of_fdi(fdi));
  return jaws.size() == 1 ? std::optional(*jaws.begin()) : std::nullopt;
}

Json axis_json(const LongAxis& axis) {
  return {{"from", numbers(axis.from)}, {"to", numbers(axis.to)}, {"direction", numbers(axis.direction)}};
}

Json axes_json(const CompletedArch& arch) {
  Json teeth = Json::object();
  for (const ToothOfArch& tooth : arch.teeth) {
    if (!tooth.tooth) continue;
    const LongAxes axes = long_axes(*tooth.tooth);
    const FrameRecord& frame = tooth.tooth->record.frame;
    const Eigen::Vector3d mesial = (frame.mirrored ? -1 : 1) * frame.rotation.row(0).transpose();
    teeth[std::to_string(tooth.fdi)] = {{"origin", numbers(frame.centre / tooth.tooth->record.millimetres_per_unit)},
                                        {"occlusal", numbers(frame.rotation.row(2))},
                                        {"buccal", numbers(frame.rotation.row(1))},
                                        {"along_the_arch", numbers(mesial)},
                                        {"crown_axis", axis_json(axes.crown)},
                                        {"root_axis", axis_json(axes.root)}};
  }
  return {{"unit", "of the scan"}, {"teeth", teeth}};
}

/// Lines for 3D Slicer, whose files say which way their axes point; a scan's are taken as they are.
Json slicer_json(const CompletedArch& arch) {
  Json markups = Json::array();
  const auto line = [&](const std::string& name, const LongAxis& axis) {
    Json points = Json::array();
    for (const auto& [label, point] : {std::pair("neck", axis.from), std::pair("end", axis.to)})
      points.push_back({{"id", fmt::format("{} {}", name, label)},
                        {"label", label},
                        {"position", numbers(point)},
                        {"positionStatus", "defined"}});
    markups.push_back({{"type", "Line"},
                       {"coordinateSystem", "LPS"},
                       {"coordinateUnits", "mm"},
                       {"name", name},
                       {"controlPoints", points}});
  };
  for (const ToothOfArch& tooth : arch.teeth) {
    if (!tooth.tooth) continue;
    LongAxes axes = long_axes(*tooth.tooth);
    const double unit = tooth.tooth->record.millimetres_per_unit;
    for (LongAxis* axis : {&axes.crown, &axes.root}) {
      axis->from *= unit;
      axis->to *= unit;
    }
    line(fmt::format("{} crown axis", tooth.fdi), axes.crown);
    line(fmt::format("{} root axis", tooth.fdi), axes.root);
  }
  return {{"@schema",
           "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
           "markups-schema-v1.0.3.json#"},
          {"markups", markups}};
}

Json tooth_json(const ToothOfArch& tooth, const ArchFileOptions& how) {
  Json json{{"fdi", tooth.fdi},
            {"rooted", tooth.tooth.has_value()},
            {"refusal", tooth.tooth ? Json(nullptr) : Json(tooth.refusal)},
            {"crown_file", name_of("crown", tooth.fdi, "ply")}};
  if (!tooth.tooth) return json;
  const CompletionRecord& record = tooth.tooth->record;
  json["tooth_file"] = name_of("tooth", tooth.fdi, how.tooth_format);
  json["report_file"] = name_of("tooth", tooth.fdi, "json");
  json["crown_triangles"] = record.crown.triangles;
  json["kept_crown_triangles"] = record.crown.kept_triangles;
  json["root_length_mm"] = record.root.length_mm;
  json["root_length_80_percent_mm"] =
      record.root.interval ? Json{record.root.interval->length_low_mm, record.root.interval->length_high_mm}
                           : Json(nullptr);
  json["warnings"] = all_warnings(record);
  return json;
}

Json clearances_json(const CompletedArch& arch) {
  const auto number = [](const std::optional<double>& mm) { return mm ? Json(*mm) : Json(nullptr); };
  Json json = Json::array();
  for (const ToothClearance& c : arch.clearances)
    json.push_back({{"teeth", {c.first, c.second}},
                    {"crown_crown_mm", number(c.crown_crown)},
                    {"root_root_mm", number(c.root_root)},
                    {"root_crown_mm", number(c.root_crown)},
                    {"crown_root_mm", number(c.crown_root)}});
  return json;
}

Json report_json(const ScanInput& input, const CompletedArch& arch, const ArchOptions& options,
                 const ArchFileOptions& how) {
  Json teeth = Json::array(), lengths = Json::object();
  for (const ToothOfArch& tooth : arch.teeth) teeth.push_back(tooth_json(tooth, how));
  for (const auto& [fdi, mm] : options.root_lengths) lengths[std::to_string(fdi)] = mm;
  std::vector<std::string> notes = input.notes;
  notes.insert(notes.end(), arch.notes.begin(), arch.notes.end());
  Json upright = nullptr;
  if (const auto& turn = arch.upright) upright = {numbers(turn->row(0)), numbers(turn->row(1)), numbers(turn->row(2))};
  return {{"arch_report_version", arch_report_version},
          {"program", {{"name", "rhizodont"}, {"version", RHIZODONT_VERSION}}},
          {"notice", "Predicted roots are not the patient's anatomy. For research and visualisation only."},
          {"input",
           {{"file", how.scan_name ? Json(*how.scan_name) : Json(nullptr)},
            {"sha256", input.sha256.empty() ? Json(nullptr) : Json(input.sha256)}}},
          {"options",
           {{"tooth", Json(options.tooth)},
            {"root_lengths_mm", lengths},
            {"resolve_collisions", options.resolve_collisions},
            {"clearance_mm", options.clearance_mm}}},
          {"found", input.found},
          {"rooted", arch.rooted()},
          {"teeth", teeth},
          {"clearances", clearances_json(arch)},
          {"upright", upright},
          {"notes", notes}};
}

/// The arch from the front, both sides and below, crowns and roots in their colours.
std::string picture_of(const MeshFile& all, const Eigen::Matrix3d& upright) {
  TriangleMesh mesh = all.mesh;
  for (Point& p : mesh.vertices) {
    const Eigen::Vector3d at = upright * p;
    p = {at.x(), -at.z(), at.y()};  // pictures have z up and are seen against y
  }
  RenderOptions options;
  options.width = 900;
  options.height = 560;
  options.views = {"front", "left", "right", "bottom"};
  return encode_png(render(
      {{&mesh, colours_by_source(mesh, all.vertex_attributes.at(source_attribute).values), Eigen::Vector3d(0, 0, 1)}},
      options));
}

void add_labels(const ScanInput& input, const ArchFileOptions& how, const std::filesystem::path& folder,
                std::vector<OutputFile>& files) {
  if (input.is_folder) return;
  const std::vector<int>& fdi = input.scan.fdi;
  files.push_back({folder / "labels.json", teeth3ds_json(fdi, only_jaw(fdi), input.file)});
  if (how.labels_vtp)
    files.push_back({folder / "labels.vtp",
                     vtp_with_cell_labels(input.scan.mesh, triangle_labels_from_vertices(input.scan.mesh, fdi))});
  if (how.labels_vtk)
    files.push_back(
        {folder / "labels.vtk", vtk_with_point_labels(input.scan.mesh, numbered_as(fdi, LabelNumbers::universal))});
}

}  // namespace

void refuse_what_no_file_holds(CompletedArch& arch, const ArchFileOptions& how) {
  for (ToothOfArch& tooth : arch.teeth) {
    if (!tooth.tooth) continue;
    try {
      require_format_holds(*tooth.tooth, name_of("tooth", tooth.fdi, how.tooth_format));
    } catch (const NoResultError& error) {
      tooth.refusal = error.what();
      tooth.tooth.reset();
      tooth.clearance.clear();
    }
  }
}

std::string arch_report(const ScanInput& input, const CompletedArch& arch, const ArchOptions& options,
                        const ArchFileOptions& how) {
  return text_of(report_json(input, arch, options, how));
}

std::string arch_mesh_bytes(const CompletedArch& arch, const std::string& format) {
  const std::string name = "arch." + format;
  for (const ToothOfArch& tooth : arch.teeth)
    if (tooth.tooth) require_format_holds(*tooth.tooth, name);
  return mesh_file_bytes(name, arch_in_one(arch));
}

std::vector<OutputFile> arch_files(const ScanInput& input, const CompletedArch& arch, const ArchOptions& options,
                                   const ArchFileOptions& how, const std::filesystem::path& folder) {
  std::vector<OutputFile> files;
  for (const ToothOfArch& tooth : arch.teeth) {
    const std::filesystem::path crown_path = folder / name_of("crown", tooth.fdi, "ply");
    const MeshFile crown = crown_file(tooth, input.file);
    std::string crown_bytes = mesh_file_bytes(crown_path, crown);
    const std::string crown_sha256 = sha256_of_bytes(crown_bytes);
    files.push_back({crown_path, std::move(crown_bytes)});
    if (!tooth.tooth) continue;
    const std::filesystem::path path = folder / name_of("tooth", tooth.fdi, how.tooth_format);
    CompletedTooth referring = *tooth.tooth;
    files.push_back({path, mesh_file_bytes(path, with_clearance(tooth_file(referring, crown), tooth))});
    refer_to_file(referring.record, crown, path);
    files.push_back(
        {folder / name_of("tooth", tooth.fdi, "json"), completion_report(referring, {crown_sha256, {}, {}})});
  }
  add_labels(input, how, folder, files);
  files.push_back({folder / "arch.json", arch_report(input, arch, options, how)});
  if (arch.rooted() == 0) return files;
  const MeshFile all = arch_in_one(arch);
  files.push_back({folder / "arch.glb", scene_of(arch, options.tooth.millimetres_per_unit)});
  files.push_back({folder / "arch.ply", mesh_file_bytes("arch.ply", all)});
  files.push_back({folder / "axes.json", text_of(axes_json(arch))});
  files.push_back({folder / "axes.mrk.json", text_of(slicer_json(arch))});
  if (arch.upright) files.push_back({folder / "arch.png", picture_of(all, *arch.upright)});
  return files;
}

std::vector<std::filesystem::path> arch_file_names(const LabelledScan& scan, const ArchFileOptions& how,
                                                   const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> names;
  for (const char* name :
       {"labels.json", "arch.json", "arch.glb", "arch.ply", "axes.json", "axes.mrk.json", "arch.png"})
    names.push_back(folder / name);
  if (how.labels_vtp) names.push_back(folder / "labels.vtp");
  if (how.labels_vtk) names.push_back(folder / "labels.vtk");
  const std::set<int> teeth(scan.fdi.begin(), scan.fdi.end());
  for (const int fdi : teeth) {
    if (fdi == 0) continue;
    names.push_back(folder / name_of("crown", fdi, "ply"));
    names.push_back(folder / name_of("tooth", fdi, how.tooth_format));
    names.push_back(folder / name_of("tooth", fdi, "json"));
  }
  return names;
}

}  // namespace rhizodont
