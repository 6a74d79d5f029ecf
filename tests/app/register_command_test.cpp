// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// `register` as a user meets it, where nothing is registered.
#include "app/program.hpp"
#include "mesh/test_meshes.hpp"

namespace rhizodont {
namespace {

class RegisterProgram : public test::Program {
 protected:
  RegisterProgram() {
    std::filesystem::create_directory(folder.path() / "teeth");
    std::filesystem::create_directory(folder.path() / "data");
  }
  void write_tooth(const std::string& name) const {
    MeshFile file;
    file.mesh = test::sphere(2, 4);
    save_mesh(folder.path() / "teeth" / name, file);
  }
};

TEST_F(RegisterProgram, WrongUsageIs2) {
  expect_error("register", 2, "TEETH_DIR");
  expect_error("register teeth -o out", 2, "--data");
  expect_error("register teeth --data data", 2, "--output");
  expect_error("register teeth --data data -o out --labels-are roman", 2, "roman");
  expect_error("register teeth --data data -o out --jaw left", 2, "--jaw");
  expect_error("register teeth --data data -o out --largest-distance 0", 2, "--largest-distance takes");
  expect_error("register teeth --data data -o -", 2, "give a folder (-o FOLDER)");
  write_tooth("tooth_3_anna.ply");
  expect_error("register teeth --data data -o out --labels-are arch16", 2, "--jaw");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST_F(RegisterProgram, AFolderWithoutTeethIs3) {
  expect_error("register teeth --data data -o out", 3, "has no mesh whose name begins with a tooth's number");
  expect_error("register nowhere --data data -o out", 3, "nowhere");
  write_tooth("tooth_99.ply");
  expect_error("register teeth --data data -o out", 3, "99");
}

TEST_F(RegisterProgram, WithoutTemplatesNothingIsWritten) {
  write_tooth("tooth_36_anna.ply");
  expect_error("register teeth --data data -o out", 3, "templates");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST_F(RegisterProgram, WhatIsThereIsNotReplacedUnasked) {
  write_tooth("tooth_46_anna.ply");
  std::filesystem::create_directory(folder.path() / "out");
  folder.write("out/tooth_36_46_anna.ply", "mine");
  expect_error("register teeth --data data -o out", 2, "--overwrite");
  expect_error("register teeth --data data -o other --json teeth/tooth_46_anna.ply", 2, "name of a mesh");
}

}  // namespace
}  // namespace rhizodont
