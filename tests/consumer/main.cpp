// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Completes the crown given as the argument with the installed library and its installed models.

#include <rhizodont/check.hpp>
#include <rhizodont/complete.hpp>
#include <rhizodont/error.hpp>
#include <rhizodont/io.hpp>
#include <rhizodont/version.hpp>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    rhizodont::load_mesh("there_is_none.ply");
    return 1;
  } catch (const rhizodont::InputError& error) {  // the library's types are the caller's
    std::printf("%s\n", error.what());
  }
  const rhizodont::TriangleMesh crown = rhizodont::load_mesh(argv[1]).mesh;
  const auto models = rhizodont::CompletionModels::load(rhizodont::default_models_folder());
  const rhizodont::CompletedTooth tooth = rhizodont::complete_tooth(crown, models);
  std::printf("rhizodont %s, root %.2f mm\n", RHIZODONT_VERSION, tooth.record.root.length_mm);
  return rhizodont::check(crown, tooth.mesh).holds() ? 0 : 4;
}
