// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What scripts/reproduce.sh compares with, one method and one tooth a run, so that time and memory are those of a
// process; and what its pictures need. usage: bench_reproduction WHAT ARGUMENTS..., see `commands`.
#include "evaluation/evaluate_cases.hpp"
#include "evaluation/root_figures.hpp"
#include "evaluation/template_predictor.hpp"
#include "poisson/iterative_poisson.hpp"
#include "poisson/peers.hpp"
#include "reproduction/cgal_peers.hpp"
#include "reproduction/inputs.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace rhizodont;
using Arguments = std::vector<std::string>;

TriangleMesh mesh_of(const std::string& path) { return load_mesh(path).mesh; }

void save(const std::string& path, TriangleMesh mesh) {
  MeshFile file;
  file.mesh = std::move(mesh);
  save_mesh(path, file);
}

void open(const Arguments& a) { save(a[2], open_crown(mesh_of(a[0]), std::stoi(a[1]), CompletionModels::load(a[3]))); }

void cloud(const Arguments& a) {
  write_samples(a[2], guiding_samples(mesh_of(a[0]), std::stoi(a[1]), CompletionModels::load(a[3])));
}

void iterative(const Arguments& a) { save(a[1], iterative_poisson(read_samples(a[0]).points).surface); }

void open3d(const Arguments& a) { save(a[1], open3d_poisson(read_samples(a[0]), 8, 1, a[2]).mesh); }

void cgal(const Arguments& a) { save(a[1], cgal_poisson(read_samples(a[0]), std::stod(a[2])).mesh); }

void fill(const Arguments& a) { save(a[1], cgal_filled(mesh_of(a[0]))); }

void fit(const Arguments& a) { save(a[3], fit_template(mesh_of(a[0]), load_template_tooth(a[2], std::stoi(a[1])))); }

void unite(const Arguments& a) {
  const TriangleMesh crown = mesh_of(a[0]);
  save(a[3], cgal_united(crown, fit_template(crown, load_template_tooth(a[2], std::stoi(a[1])))));
}

void remesh(const Arguments& a) { save(a[1], cgal_remeshed(mesh_of(a[0]), std::stod(a[2]))); }

void figures(const Arguments& a) {
  const TriangleMesh crown = mesh_of(a[0]);
  const nlohmann::ordered_json json(root_figures(crown, mesh_of(a[1]), mesh_of(a[2]), crown_growth_axis(crown)));
  fmt::print("{}\n", json.dump());
}

void marked(const Arguments& a) {
  const MarkedTooth made = marked_tooth(a[0], std::stoi(a[1]), std::stoull(a[2]), a[3]);
  save(a[4], made.crown);
  save(a[5], made.tooth);
}

void deviation(const Arguments& a) { save_mesh(a[2], with_deviation(mesh_of(a[0]), mesh_of(a[1]), std::stod(a[3]))); }

void quality(const Arguments& a) { save_mesh(a[1], with_quality(mesh_of(a[0]))); }

void seam(const Arguments& a) { save_mesh(a[2], near_transition(load_mesh(a[0]), load_mesh(a[1]), std::stod(a[3]))); }

struct Command {
  std::string arguments;
  std::function<void(const Arguments&)> run;
};

const std::map<std::string, Command>& commands() {
  static const std::map<std::string, Command> all{
      {"open", {"CROWN FDI OUT MODELS", open}},
      {"cloud", {"CROWN FDI SAMPLES.bin MODELS", cloud}},
      {"iterative-poisson", {"SAMPLES.bin OUT", iterative}},
      {"open3d-poisson", {"SAMPLES.bin OUT SCRATCH_FOLDER", open3d}},
      {"cgal-poisson", {"SAMPLES.bin OUT SPACING_MM", cgal}},
      {"cgal-fill", {"CROWN OUT", fill}},
      {"template", {"CROWN FDI TEMPLATES OUT", fit}},
      {"cgal-union", {"CROWN FDI TEMPLATES OUT", unite}},
      {"cgal-remesh", {"MESH OUT EDGE_MM", remesh}},
      {"figures", {"CROWN TRUE_TOOTH MESH", figures}},
      {"marked", {"DATA FDI SEED none|worn|bracket|worn-bracket|decayed CROWN_OUT TOOTH_OUT", marked}},
      {"deviation", {"CROWN MESH OUT MOST_MM", deviation}},
      {"quality", {"MESH OUT", quality}},
      {"seam", {"TOOTH SMOOTHED_TOOTH OUT REACH_MM", seam}}};
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments(argv + std::min(argc, 2), argv + argc);
    const auto command = argc > 1 ? commands().find(argv[1]) : commands().end();
    const auto wanted = [](const Command& c) { return std::count(c.arguments.begin(), c.arguments.end(), ' ') + 1; };
    if (command == commands().end() || static_cast<long>(arguments.size()) != wanted(command->second)) {
      for (const auto& [name, about] : commands())
        fmt::print(stderr, "bench_reproduction {} {}\n", name, about.arguments);
      return 2;
    }
    command->second.run(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
