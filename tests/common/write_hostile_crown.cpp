// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Writes a bad crown to a file: write_hostile_crown CLEAN KIND SEED VERTICES OUT. KIND "none" only changes the size;
// without arguments the kinds are listed.

#include "common/hostile_crowns.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <string>

int main(int argc, char** argv) {
  using namespace rhizodont;
  try {
    if (argc == 1) {
      for (const std::string& kind : test::hostile_kinds()) fmt::print("{}\n", kind);
      return 0;
    }
    if (argc != 6) {
      fmt::print(stderr, "usage: write_hostile_crown CLEAN KIND SEED VERTICES OUT\n");
      return 2;
    }
    const std::string kind = argv[2];
    MeshFile file;
    file.mesh = test::resized_to(load_mesh(argv[1]).mesh, std::stoul(argv[4]));
    if (kind != "none") file.mesh = test::hostile_crown(file.mesh, kind, std::stoull(argv[3]));
    save_mesh(argv[5], file);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
