// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_checks.hpp"
#include "commands.hpp"
#include "pictures/render.hpp"
#include "pictures/upward.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>

#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct RenderCommand {
  std::vector<std::string> meshes;
  std::string output;
  std::vector<double> axis;
  std::string colour_by = "auto";
  RenderOptions options;
};

std::vector<Colour> colours_of(const MeshFile& file, const std::string& colour_by, const std::string& path) {
  const auto& attributes = file.vertex_attributes;
  if (colour_by == "none") return {plain_colour()};
  if (colour_by == "auto" && !attributes.contains(source_attribute)) return {plain_colour()};
  const std::string name = colour_by == "auto" ? source_attribute : colour_by;
  const auto place = attributes.find(name);
  if (place == attributes.end())
    throw UsageError(fmt::format("{}: there is no attribute '{}' to colour by", path, name));
  return name == source_attribute ? colours_by_source(file.mesh, place->second.values)
                                  : colours_by_value(file.mesh, place->second.values);
}

void run(const RenderCommand& command) {
  require_ending(command.output, {".png"}, "a picture");
  require_safe_outputs({command.meshes.begin(), command.meshes.end()}, {command.output});
  std::vector<MeshFile> files;
  for (const std::string& path : command.meshes) files.push_back(load_mesh(path));
  std::vector<RenderItem> items;
  for (std::size_t k = 0; k < files.size(); ++k) {
    RenderItem item{&files[k].mesh, colours_of(files[k], command.colour_by, command.meshes[k]), upward_of(files[k])};
    if (command.axis.size() == 3) item.up = Eigen::Vector3d(command.axis[0], command.axis[1], command.axis[2]);
    items.push_back(std::move(item));
  }
  write_output_files({{command.output, encode_png(render(items, command.options))}});
}

}  // namespace

void add_render_command(CLI::App& app) {
  auto command = std::make_shared<RenderCommand>();
  CLI::App* render_app =
      app.add_subcommand("render", "Draw meshes to a PNG picture: a row per mesh, a column per view");
  render_app->add_option("MESH", command->meshes, "Meshes (.stl .ply .obj .off .vtp)")->required();
  render_app->add_option("-o,--output", command->output, "The picture (.png)")->required();
  render_app->add_option("--width", command->options.width, "Pixels of one tile")->capture_default_str();
  render_app->add_option("--height", command->options.height, "Pixels of one tile")->capture_default_str();
  render_app
      ->add_option("--views", command->options.views,
                   "Of front, back, left, right, top, bottom, oblique, with commas between")
      ->delimiter(',')
      ->capture_default_str();
  render_app
      ->add_option("--axis", command->axis,
                   "Direction from root to crown, x,y,z (default: from an open crown's border, or z)")
      ->delimiter(',')
      ->expected(3);
  render_app->add_flag("--wireframe", command->options.wireframe, "Draw the edges of the triangles");
  render_app
      ->add_option("--color-by", command->colour_by,
                   "source, another attribute of a PLY file, none, or auto: source if there is one")
      ->capture_default_str();
  render_app->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
