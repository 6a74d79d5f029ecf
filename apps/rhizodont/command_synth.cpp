// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "families/crown_crop.hpp"
#include "families/mean_arch.hpp"
#include "families/mean_teeth.hpp"
#include "families/person.hpp"
#include "families/registered_templates.hpp"
#include "families/synthetic_files.hpp"
#include "families/tooth_family.hpp"
#include "pictures/render.hpp"
#include "pictures/tiles.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "synth_arches.hpp"
#include "teeth/fdi.hpp"
#include "training/skirt_sample.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

using Json = nlohmann::ordered_json;

struct SynthCommand {
  std::string data;
  std::vector<int> fdi;
  int count = 1;
  std::uint64_t seed = 0;
  std::string output;
  std::string sheet;
  std::string atlas, arch;
  std::string population, registered;
  bool person = false;
  bool crowns = false;
  bool clean_cut = false;
  bool skirts = false;
  bool overwrite = false;
  double edge_mm = 0;
  std::string crown_format = "ply";
  double noise_mm = 0.005;
  bool arches = false;
  std::string jaw;
  std::vector<std::size_t> triangles;
  bool upright = false;
  double grid_mm = 0;
  OutputOptions said;
};

CroppedCrown crop(const SynthCommand& command, const SyntheticTooth& tooth, std::uint64_t seed, int fdi) {
  // Teeth of one person have one seed, and each its own gum line.
  RandomStream random(seed, command.person ? 300 + static_cast<std::uint64_t>(fdi) : 200);
  if (!command.clean_cut) return draw_cropped_crown(tooth, 0, 0.3, random);
  return trim_clean(tooth, random);
}

void write_atlas(const SynthCommand& command, const ToothFamilies& families) {
  save_atlas(make_atlas(families), command.atlas);
  command.said.tell(command.atlas);
}

void write_arch(const SynthCommand& command, const ToothFamilies& families) {
  save_arch_model(make_arch_model(make_atlas(families), std::filesystem::path(command.data) / "crowns"), command.arch);
  command.said.tell(command.arch);
}

/// Teeth made so far, for the sheet.
struct Drawing {
  std::vector<TriangleMesh> meshes;
  std::vector<std::vector<Colour>> colours;
};

std::filesystem::path file_name(const SynthCommand& command, const char* kind, int fdi, std::uint64_t seed) {
  return std::filesystem::path(command.output) /
         fmt::format("{}_{}_{}.{}", kind, fdi, seed, std::string_view(kind) == "crown" ? command.crown_format : "ply");
}

/// What will be written into the folder.
std::vector<std::filesystem::path> names_in_folder(const SynthCommand& command) {
  std::vector<std::filesystem::path> names;
  if (command.output.empty()) return names;
  for (const int fdi : command.fdi) {
    for (int i = 0; i < command.count; ++i) {
      const std::uint64_t seed = command.seed + static_cast<std::uint64_t>(i);
      names.push_back(file_name(command, command.skirts ? "skirt" : "tooth", fdi, seed));
      if (command.crowns && !command.skirts) names.push_back(file_name(command, "crown", fdi, seed));
    }
  }
  return names;
}

void require_safe_places(const SynthCommand& command) {
  const std::vector<std::filesystem::path> made_up = names_in_folder(command);
  require_new(made_up, command.overwrite);
  std::vector<std::filesystem::path> outputs;
  if (!made_up.empty()) outputs.push_back(made_up.front());  // one place stands for the folder
  if (!command.sheet.empty()) {
    require_ending(command.sheet, {".png"}, "a picture");
    outputs.emplace_back(command.sheet);
  }
  if (!command.atlas.empty()) {
    require_no_mesh_ending(command.atlas, "a file of mean crowns (--atlas)");
    outputs.emplace_back(command.atlas);
  }
  if (!command.arch.empty()) {
    require_no_mesh_ending(command.arch, "a model of the arch (--arch-model)");
    outputs.emplace_back(command.arch);
  }
  for (const std::filesystem::path& file : command.said.outputs()) outputs.push_back(file);
  std::vector<std::filesystem::path> inputs = files_below(command.data);
  for (const std::filesystem::path& file : files_below(command.registered)) inputs.push_back(file);
  if (!command.population.empty()) inputs.emplace_back(command.population);
  require_separate_files(inputs, made_up);
  require_safe_outputs(inputs, outputs);
}

/// Writes it and tells of it; returns its figures.
Json write_tooth(const SynthCommand& command, const ToothFamilies& families, int fdi, std::uint64_t seed,
                 Drawing& drawing) {
  const bool right_side = is_right_side(fdi);
  const SyntheticTooth tooth = command.person ? generate_tooth_of_person(families, fdi, draw_person(seed))
                                              : generate_tooth(families, tooth_type_of_fdi(fdi), seed);
  const CroppedCrown cropped = crop(command, tooth, seed, fdi);
  const MeshFile file = synthetic_tooth_file(tooth, cropped.line, right_side);
  const auto tooth_name = file_name(command, "tooth", fdi, seed);
  std::vector<OutputFile> files{{tooth_name, mesh_file_bytes(tooth_name, file)}};
  Json figures{{"tooth", tooth_name.string()},
               {"fdi", fdi},
               {"seed", seed},
               {"root_length_mm", tooth.root_length},
               {"crown_height_mm", tooth.crown_height},
               {"roots", tooth.apices.size()}};
  if (command.crowns) {
    const MeshFile crown = synthetic_crown_file(tooth, cropped, right_side, {command.edge_mm, command.noise_mm, seed});
    const auto crown_name = file_name(command, "crown", fdi, seed);
    files.push_back({crown_name, mesh_file_bytes(crown_name, crown)});
    figures["crown"] = crown_name.string();
    drawing.meshes.push_back(crown.mesh);
    drawing.colours.push_back({plain_colour()});
  }
  write_output_files(files);
  command.said.tell(fmt::format("{}: root {:.1f} mm, crown {:.1f} mm, {} root{}", tooth_name.string(),
                                tooth.root_length, tooth.crown_height, tooth.apices.size(),
                                tooth.apices.size() == 1 ? "" : "s"));
  drawing.meshes.push_back(file.mesh);
  drawing.colours.push_back(colours_by_source(file.mesh, file.vertex_attributes.at(source_attribute).values));
  return figures;
}

/// Returns the figures of all.
Json write_teeth(const SynthCommand& command, const ToothFamilies& families) {
  Drawing drawing;
  Json teeth = Json::array();
  for (const int fdi : command.fdi)
    for (int i = 0; i < command.count; ++i)
      teeth.push_back(write_tooth(command, families, fdi, command.seed + static_cast<std::uint64_t>(i), drawing));
  Json figures{{"teeth", std::move(teeth)}};
  if (command.sheet.empty()) return figures;
  RenderOptions options;
  options.width = 240;
  options.height = 320;
  options.views = {"front", "right", "back", "left", "top", "bottom"};
  std::vector<RenderItem> items;
  for (std::size_t i = 0; i < drawing.meshes.size(); ++i)
    items.push_back({&drawing.meshes[i], drawing.colours[i], Eigen::Vector3d::UnitZ().eval()});
  write_output_files({{command.sheet, encode_png(render(items, options))}});
  return figures;
}

/// `count` teeth of every type (or of one), a row for each type, from the cheek's side, from the side and from above.
void write_contact_sheet(const SynthCommand& command, const ToothFamilies& families) {
  const auto count = static_cast<std::size_t>(command.count);
  std::vector<int> types;
  for (const int fdi : command.fdi) types.push_back(tooth_type_of_fdi(fdi));
  for (int type = 0; command.fdi.empty() && type < tooth_type_count; ++type) types.push_back(type);
  std::vector<MeshFile> teeth;
  for (int type : types) {
    for (std::size_t i = 0; i < count; ++i) {
      const SyntheticTooth tooth = generate_tooth(families, type, command.seed + i);
      teeth.push_back(
          synthetic_tooth_file(tooth, crop(command, tooth, command.seed + i, fdi_of_type(type, false)).line, false));
    }
  }
  RenderOptions options;
  options.width = 110;
  options.height = 190;
  options.views = {"back", "right", "top"};
  std::vector<RenderItem> items;
  items.reserve(teeth.size());
  for (const MeshFile& tooth : teeth)
    items.push_back({&tooth.mesh, colours_by_source(tooth.mesh, tooth.vertex_attributes.at(source_attribute).values),
                     Eigen::Vector3d::UnitZ().eval()});
  write_output_files({{command.sheet, encode_png(side_by_side(render(items, options), items.size(), count))}});
  command.said.tell(command.sheet);
}

/// Crowns as they are cut from scans, skirts labelled. Returns the figures of all.
Json write_skirts(const SynthCommand& command, const ToothFamilies& families) {
  Json crowns = Json::array();
  for (const int fdi : command.fdi) {
    for (int i = 0; i < command.count; ++i) {
      const std::uint64_t seed = command.seed + static_cast<std::uint64_t>(i);
      SkirtSampleOptions options;
      options.type = tooth_type_of_fdi(fdi);
      if (command.edge_mm > 0) options.finest_edge_mm = options.coarsest_edge_mm = command.edge_mm;
      const SkirtSample sample = make_skirt_sample(families, seed, options);
      const auto name = file_name(command, "skirt", fdi, seed);
      save_mesh(name, skirt_sample_file(sample));
      const auto skirt = std::count(sample.is_tooth.begin(), sample.is_tooth.end(), 0);
      command.said.tell(fmt::format("{}: {} vertices, {} skirt", name.string(), sample.is_tooth.size(), skirt));
      crowns.push_back({{"crown", name.string()},
                        {"fdi", fdi},
                        {"seed", seed},
                        {"vertices", sample.is_tooth.size()},
                        {"skirt", skirt}});
    }
  }
  return {{"crowns", std::move(crowns)}};
}

SynthArches arches_of(const SynthCommand& command) {
  SynthArches arches{command.data, command.output, command.sheet, command.count, command.seed, command.crown_format,
                     {},           command.said};
  if (command.person || !command.population.empty() || !command.registered.empty())
    throw UsageError(
        "Scans of arches are made of models of crowns: --person, --population and --registered are for teeth.");
  if (command.output.empty() && command.sheet.empty())
    throw UsageError("Say where to: -o FOLDER for arches, --sheet PNG for a picture of them.");
  if (arches.format == "stl")
    throw UsageError("STL does not number its vertices, so it cannot be labelled: ply or obj.");
  if (!command.jaw.empty()) arches.options.jaw = command.jaw == "upper" ? Jaw::upper : Jaw::lower;
  if (!command.triangles.empty()) arches.options.triangles = {command.triangles.front(), command.triangles.back()};
  if (command.grid_mm > 0) arches.options.grid_mm = command.grid_mm;
  arches.options.any_pose = !command.upright;
  return arches;
}

/// Teeth of people are whole dentitions where no teeth are named.
SynthCommand with_teeth_of_people(SynthCommand command) {
  if (!command.person) return command;
  if (command.output.empty() || command.skirts)
    throw UsageError("Teeth of people go to a folder: --person with -o FOLDER, without --skirts.");
  const bool given_none = command.fdi.empty();
  for (int fdi = 11; given_none && fdi <= 48; ++fdi)
    if (is_permanent_tooth(fdi)) command.fdi.push_back(fdi);
  return command;
}

void run(const SynthCommand& given) {
  if (!given.output.empty()) require_folder_name(given.output, given.arches ? "arches" : "teeth");
  if (given.arches) return write_arches(arches_of(given));
  const SynthCommand command = with_teeth_of_people(given);
  if (command.output.empty() && command.atlas.empty() && command.arch.empty() && command.sheet.empty())
    throw UsageError(
        "Say where to: -o FOLDER for teeth, --sheet PNG for a picture, --atlas FILE for mean crowns, "
        "--arch-model FILE for how they stand in the arch.");
  if (!command.output.empty() && command.fdi.empty()) throw UsageError("Say which tooth: --type FDI, such as 36.");
  require_safe_places(command);
  FamilyLoadOptions options;
  options.population = command.population;
  options.registered = command.registered;
  if (command.edge_mm > 0) options.vertices = fine_template_vertices;  // finer than the scan to be made
  const ToothFamilies families = load_tooth_families(command.data, options);
  if (!command.atlas.empty()) write_atlas(command, families);
  if (!command.arch.empty()) write_arch(command, families);
  Json figures{{"teeth", Json::array()}};
  if (!command.output.empty())
    figures = command.skirts ? write_skirts(command, families) : write_teeth(command, families);
  if (command.output.empty() && !command.sheet.empty()) write_contact_sheet(command, families);
  write_output_files(command.said.print_or_file(figures));
}

}  // namespace

void add_synth_command(CLI::App& app) {
  auto command = std::make_shared<SynthCommand>();
  CLI::App* synth = app.add_subcommand("synth", "Make complete synthetic teeth, crowns cut from them, and the atlas");
  synth->add_option("--data", command->data, "Folder with templates/tooth_FDI.ply, anatomy.csv and crowns/ssm")
      ->required();
  synth->add_option("--type", command->fdi, "FDI numbers of the teeth to make (11-18, 21-28, 31-38, 41-48)");
  synth->add_option("--count", command->count, "How many of each")->capture_default_str()->check(CLI::Range(1, 100000));
  synth->add_option("--seed", command->seed, "Number of the first; each tooth depends on its number alone")
      ->capture_default_str();
  synth->add_option("-o,--output", command->output, "Folder for tooth_FDI_SEED.ply (and crown_FDI_SEED.ply)");
  synth->add_option("--registered", command->registered,
                    "Folder of registered teeth (rhizodont register): each is a further template of its type");
  synth->add_option("--population", command->population,
                    "JSON table of lengths, roots and curves by tooth; without it the middle of published populations");
  synth->add_flag("--person", command->person,
                  "Teeth of one person for each number (--count people), alike as one person's are; all 32 without "
                  "--type");
  synth->add_flag("--crowns", command->crowns, "Write the cropped crowns too");
  synth->add_flag("--skirts", command->skirts,
                  "Write crowns with skirts instead, labelled (skirt_FDI_SEED.ply); half of them are mirrored");
  synth->add_flag("--clean-cut", command->clean_cut, "Crop just above the cemento-enamel junction, without gaps");
  synth->add_option("--edge", command->edge_mm, "Remesh the crowns like a scan, edge length in mm")
      ->check(CLI::Range(0.1, 1.0));
  synth->add_option("--crown-format", command->crown_format, "File format of the crowns")
      ->capture_default_str()
      ->check(CLI::IsMember({"ply", "stl", "obj"}));
  synth->add_option("--noise", command->noise_mm, "Noise of remeshed crowns along their normals, mm")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 0.1));
  synth->add_option("--sheet", command->sheet,
                    "Draw what was made to this PNG; without -o: a contact sheet, --count teeth of each type");
  synth->add_option("--atlas", command->atlas, "Write mean crowns and anchors of all types to this safetensors file");
  synth->add_flag(
      "--arch", command->arches,
      "Make scans of whole arches instead: arch_SEED_JAW.ply (--crown-format obj), labels as .json, and what "
      "was drawn as _drawn.json");
  synth->add_option("--jaw", command->jaw, "With --arch: upper or lower; drawn without it")
      ->check(CLI::IsMember({"upper", "lower"}));
  synth->add_option("--triangles", command->triangles, "With --arch: least and most triangles, 2000 to 400000")
      ->expected(1, 2);
  synth->add_option("--grid", command->grid_mm, "With --arch: fineness of the surface, 0.2 to 0.6 mm");
  synth->add_flag("--upright", command->upright, "With --arch: y up, z to the front; else in any pose");
  synth->add_option("--arch-model", command->arch,
                    "Write where the mean crowns stand in the arch, and how, to this safetensors file");
  synth->add_flag("--overwrite", command->overwrite, "Teeth and crowns of the same names in the folder are replaced");
  command->said.add_with_figures_to(*synth);
  synth->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
