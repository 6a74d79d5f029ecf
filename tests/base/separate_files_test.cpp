// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/temporary_folder.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/output_files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

class SeparateFiles : public ::testing::Test {
 protected:
  SeparateFiles() {
    folder_.write("scan.stl", "scan");
    folder_.write("other.stl", "scan");
    fs::create_directory(at("sub"));
    fs::create_symlink("scan.stl", at("link.ply"));
    fs::create_symlink(at("sub"), at("linked"));
    fs::create_symlink("sub/new.ply", at("dangling.ply"));
    fs::create_hard_link(at("scan.stl"), at("hard.ply"));
    mkfifo(at("pipe").c_str(), 0600);
  }

  fs::path at(const std::string& name) const { return folder_.path() / name; }

  void expect_refused(const std::string& input, const std::vector<std::string>& outputs) const {
    EXPECT_THROW(require_separate_files({at(input)}, all(outputs)), UsageError) << outputs.front();
  }
  void expect_taken(const std::string& input, const std::vector<std::string>& outputs) const {
    EXPECT_NO_THROW(require_separate_files({at(input)}, all(outputs))) << outputs.front();
  }

 private:
  std::vector<fs::path> all(const std::vector<std::string>& names) const {
    std::vector<fs::path> paths;
    for (const std::string& name : names) paths.push_back(at(name));
    return paths;
  }

  test::TemporaryFolder folder_;
};

TEST_F(SeparateFiles, AnOutputThatIsTheInputIsRefusedByAnyName) {
  for (const char* name : {"scan.stl", "./scan.stl", "sub/../scan.stl", "linked/../scan.stl", "link.ply", "hard.ply"})
    expect_refused("scan.stl", {name});
  for (const char* name : {"missing/../scan.stl", "missing/too/../../link.ply"}) expect_refused("scan.stl", {name});
  for (const char* input : {"link.ply", "hard.ply"}) expect_refused(input, {"scan.stl"});
  expect_refused("scan.stl", {"new.ply", "scan.stl"});
  for (const char* name : {"other.stl", "new.ply", "sub/scan.stl"}) expect_taken("scan.stl", {name});
}

TEST_F(SeparateFiles, TwoOutputsThatAreOneFileAreRefused) {
  expect_refused("scan.stl", {"new.ply", "new.ply"});
  expect_refused("scan.stl", {"new.ply", "sub/../new.ply"});
  expect_refused("scan.stl", {"dangling.ply", "linked/new.ply"});  // neither is there yet
  expect_refused("scan.stl", {"missing/new.ply", "missing/./new.ply"});
  expect_refused("scan.stl", {"other.stl", "other.stl"});
  expect_taken("scan.stl", {"new.ply", "new.json"});
  expect_taken("scan.stl", {"new.ply", "sub/new.json"});
}

TEST_F(SeparateFiles, DevicesMayBeNamedTwicePipesMayNot) {
  EXPECT_NO_THROW(require_separate_files({at("scan.stl")}, {"/dev/null", "/dev/null"}));
  expect_refused("scan.stl", {"pipe", "pipe"});
  expect_refused("pipe", {"pipe"});
}

TEST_F(SeparateFiles, TheSentenceNamesBoth) {
  try {
    require_separate_files({at("scan.stl")}, {at("link.ply")});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("link.ply would be written over"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("scan.stl, which is read"), std::string::npos) << error.what();
  }
}

TEST_F(SeparateFiles, StandardOutputIsKnownByItsNames) {
  EXPECT_TRUE(is_standard_output("/dev/stdout"));
  EXPECT_TRUE(is_standard_output("/proc/self/fd/1"));
  EXPECT_FALSE(is_standard_output("/dev/stderr"));
  EXPECT_FALSE(is_standard_output(at("scan.stl")));
  for (const char* name : {"/dev/stdout", "/dev/null", "/dev/fd/0"}) EXPECT_TRUE(is_stream(name)) << name;
  EXPECT_TRUE(is_stream(at("pipe")));
  for (const char* name : {"scan.stl", "sub", "new.ply", "link.ply", "dangling.ply"}) EXPECT_FALSE(is_stream(at(name)));
}

}  // namespace
}  // namespace rhizodont
