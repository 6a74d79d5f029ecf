// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/tooth_labels.hpp"
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "mesh_detail.hpp"
#include "pictures/render.hpp"
#include "pictures/tiles.hpp"
#include "pictures/tooth_colours.hpp"
#include "pictures/upward.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>

#include <algorithm>
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
  std::size_t per_row = 1;
  OutputOptions said;
};

std::vector<Colour> colours_of(const MeshFile& file, const std::string& colour_by, const std::string& path) {
  const auto& attributes = file.vertex_attributes;
  if (colour_by == "none") return {plain_colour()};
  std::string name = colour_by;
  if (colour_by == "auto") {
    name = attributes.contains(source_attribute) ? source_attribute : fdi_attribute;
    if (!attributes.contains(name)) return {plain_colour()};
  }
  const auto place = attributes.find(name);
  if (place == attributes.end())
    throw UsageError(fmt::format("{}: there is no attribute '{}' to colour by", path, name));
  const std::vector<double>& values = place->second.values;
  if (name == source_attribute) return colours_by_source(file.mesh, values);
  return name == fdi_attribute ? colours_by_tooth(file.mesh, values) : colours_by_value(file.mesh, values);
}

void run(const RenderCommand& command) {
  require_ending(command.output, {".png"}, "a picture");
  require_safe_outputs({command.meshes.begin(), command.meshes.end()}, {command.output});
  std::vector<MeshFile> files;
  for (const std::string& path : command.meshes)
    detail_of_mesh(command.said, path, files.emplace_back(load_mesh(path)));
  std::vector<RenderItem> items;
  for (std::size_t k = 0; k < files.size(); ++k) {
    RenderItem item{&files[k].mesh, colours_of(files[k], command.colour_by, command.meshes[k]), upward_of(files[k])};
    if (command.axis.size() == 3) item.up = Eigen::Vector3d(command.axis[0], command.axis[1], command.axis[2]);
    items.push_back(std::move(item));
  }
  Image picture = render(items, command.options);
  const std::size_t per_row = std::min(command.per_row, items.size());
  if (per_row > 1) picture = side_by_side(picture, items.size(), per_row);
  write_output_files({{command.output, encode_png(picture)}});
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
      ->type_name("TEXT:{front,back,left,right,top,bottom,oblique}")
      ->delimiter(',')
      ->capture_default_str();
  render_app
      ->add_option("--axis", command->axis,
                   "Direction from root to crown, x,y,z (default: from an open crown's border, or z)")
      ->delimiter(',')
      ->expected(3);
  render_app->add_option("--per-row", command->per_row, "Meshes side by side in a row of the picture")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  render_app->add_flag("--wireframe", command->options.wireframe, "Draw the edges of the triangles");
  render_app
      ->add_option("--color-by", command->colour_by,
                   "source, fdi (numbers of teeth), another attribute of a PLY file, none, or auto: source or fdi if "
                   "there is one")
      ->type_name("TEXT:{auto,source,fdi,none,...}")
      ->capture_default_str();
  command->said.add_to(*render_app);
  render_app->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
