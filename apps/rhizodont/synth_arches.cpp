// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth_arches.hpp"

#include "command_line/output_checks.hpp"
#include "io/write_labels.hpp"
#include "pictures/render.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/output_files.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include <array>
#include <vector>

namespace rhizodont::command_line {
namespace {

nlohmann::json numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::string drawn_json(const GeneratedArch& arch, std::uint64_t seed) {
  nlohmann::json teeth = nlohmann::json::array();
  for (const GeneratedTooth& tooth : arch.teeth) {
    nlohmann::json one{{"fdi", tooth.fdi},
                       {"middle", numbers(tooth.middle)},
                       {"occlusal", numbers(tooth.directions.occlusal)},
                       {"buccal", numbers(tooth.directions.buccal)},
                       {"vertices", tooth.vertices}};
    if (tooth.worn) one["worn"] = true;
    if (tooth.stump) one["stump"] = true;
    if (tooth.bracket) one["bracket"] = true;
    if (tooth.attachment) one["attachment"] = true;
    if (tooth.half_erupted) one["half_erupted"] = true;
    teeth.push_back(std::move(one));
  }
  nlohmann::json rotation = nlohmann::json::array();
  for (int r = 0; r < 3; ++r) rotation.push_back(numbers(arch.rotation.row(r).transpose()));
  const nlohmann::json all{{"seed", seed},
                           {"jaw", jaw_name(arch.jaw)},
                           {"size", arch.size},
                           {"drawn", arch.drawn},
                           {"missing", arch.missing},
                           {"teeth", std::move(teeth)},
                           {"scan_from_arch", {{"rotation", std::move(rotation)}, {"shift", numbers(arch.shift)}}}};
  return all.dump(1) + "\n";
}

/// Gum pink, teeth in colours that differ from their neighbours'.
std::vector<Colour> colours_of(const GeneratedArch& arch) {
  constexpr std::array<Colour, 5> palette{
      {{0.85F, 0.75F, 0.45F}, {0.35F, 0.65F, 0.85F}, {0.45F, 0.8F, 0.45F}, {0.8F, 0.5F, 0.8F}, {0.9F, 0.55F, 0.35F}}};
  std::vector<Colour> colours;
  for (const Triangle& t : arch.scan.triangles) {
    const auto label = [&](std::size_t k) { return arch.fdi[static_cast<std::size_t>(t[k])]; };
    const bool one = label(0) == label(1) && label(0) == label(2);
    colours.push_back(!one || label(0) == 0
                          ? Colour{0.75F, 0.5F, 0.48F}
                          : palette[static_cast<std::size_t>(label(0) % 10 + 2 * (label(0) / 10)) % 5]);
  }
  return colours;
}

void write_sheet(const std::filesystem::path& path, const std::vector<GeneratedArch>& arches,
                 const OutputOptions& said) {
  std::vector<RenderItem> items;
  for (const GeneratedArch& arch : arches) {
    const Eigen::Vector3d up = arch.rotation * Eigen::Vector3d(0, arch.jaw == Jaw::upper ? -1 : 1, 0);
    items.push_back({&arch.scan, colours_of(arch), up});
  }
  RenderOptions options;
  options.width = 480;
  options.height = 400;
  options.views = {"top", "front", "left", "oblique"};
  write_output_files({{path, encode_png(render(items, options))}});
  said.tell(path.string());
}

}  // namespace

void write_arches(const SynthArches& command) {
  const ArchFamily family = load_arch_family(command.data);
  require_safe_outputs(files_below(command.data), command.said.outputs());
  std::vector<GeneratedArch> for_sheet;
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (int i = 0; i < command.count; ++i) {
    const std::uint64_t seed = command.seed + static_cast<std::uint64_t>(i);
    GeneratedArch arch = sample_arch(family, seed, command.options);
    if (!command.output.empty()) {
      const std::string name = fmt::format("arch_{}_{}", seed, jaw_name(arch.jaw));
      MeshFile file;
      file.mesh = arch.scan;
      file.comments = {"generated arch, made by rhizodont synth; crowns after Chen Y. et al. 2023 (MIT)"};
      const std::filesystem::path mesh_name = command.output / (name + "." + command.format);
      write_output_files({{mesh_name, mesh_file_bytes(mesh_name, file)},
                          {command.output / (name + ".json"), teeth3ds_json(arch.fdi, arch.jaw, file)},
                          {command.output / (name + "_drawn.json"), drawn_json(arch, seed)}});
      figures.push_back({{"scan", mesh_name.string()},
                         {"seed", seed},
                         {"jaw", jaw_name(arch.jaw)},
                         {"teeth", arch.teeth.size()},
                         {"triangles", arch.scan.triangles.size()}});
      command.said.tell(
          fmt::format("{}: {} teeth, {} triangles", mesh_name.string(), arch.teeth.size(), arch.scan.triangles.size()));
    }
    if (!command.sheet.empty()) for_sheet.push_back(std::move(arch));
  }
  if (!command.sheet.empty()) write_sheet(command.sheet, for_sheet, command.said);
  write_output_files(command.said.print_or_file({{"arches", figures}}));
}

}  // namespace rhizodont::command_line
