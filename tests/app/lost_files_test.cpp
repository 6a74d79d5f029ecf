// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What can be lost: every command, every option that names an output, every way in which that can go wrong. Whatever
// happens, every file that was there is there still, byte for byte, with its mode and its links, and no other.
#include "app/program.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/test_meshes.hpp"

#include <sys/stat.h>

#include <map>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using test::Outcome;

/// A command with one output to be tried at bad places.
struct Output {
  std::string command;  // OUT is where the output goes
  std::string ending;   // of the output's name
  std::string input;    // a file that it reads
};

/// A bad place.
struct Place {
  std::string what;
  std::string name;  // without the ending
  int code;
};

const std::vector<Place> places{
    {"the input through a link", "input_linked", 2},
    {"the input's other name", "input_hard", 2},
    {"a full device", "full", 7},
    {"a write-protected file", "protected", 7},
    {"a folder", "folder", 7},
    {"a circle of links", "circle", 7},
    {"a link into a folder that is not there", "nowhere", 7},
    {"below a file", "crown.stl/below", 7},
    {"a folder that cannot be made", "/proc/missing/below", 7},
    {"a name that is too long", std::string(254, 'n'), 7},
};

// What fails before the work fails in milliseconds, so that all commands can be tried at all places; only a full device
// is met at the end of the work.
const std::vector<Output> outputs{
    {"complete crown.stl --fdi 36 --e 2 -o OUT", ".ply", "crown.stl"},
    {"complete crown.stl --fdi 36 --e 2 -o older.ply --report OUT", ".json", "crown.stl"},
    {"complete crown.stl --fdi 36 --e 2 --skirt auto -o older.ply --skirt-confidence OUT", ".ply", "crown.stl"},
    {"complete crown.stl --fdi 36 --e 2 -o older.ply --json OUT", ".json", "crown.stl"},
    {"label-skirt crown.stl tooth.ply -o older.ply --json OUT", ".json", "tooth.ply"},
    {"check crown.stl tooth.ply --json OUT", ".json", "tooth.ply"},
    {"measure tooth.ply --json OUT", ".json", "tooth.ply"},
    {"render tooth.ply --width 20 --height 20 -o OUT", ".png", "tooth.ply"},
    {"label-skirt crown.stl tooth.ply -o OUT", ".ply", "tooth.ply"},
    {"evaluate cases --e 2 --json OUT", ".json", "cases/crown_36.stl"},
    {"evaluate cases --e 2 --csv OUT", ".csv", "cases/crown_36.stl"},
    {"evaluate cases --e 2 --plot OUT", ".svg", "cases/tooth_36.ply"},
};

class LostFiles : public test::Program {
 protected:
  LostFiles() {
    fs::copy_file(sample("crown_36.stl"), at("crown.stl"));
    TriangleMesh ball = test::sphere(2, 4);
    MeshFile file;
    file.mesh = ball;
    save_mesh(at("tooth.ply"), file);
    fs::create_directory(at("cases"));
    fs::copy_file(at("crown.stl"), at("cases/crown_36.stl"));
    fs::copy_file(at("tooth.ply"), at("cases/tooth_36.ply"));
    folder.write("older.ply", "an older tooth");
    folder.write("older.json", "an older report");
    folder.write("neighbour_2.ply", "a neighbour");
  }

  fs::path at(const std::string& name) const { return folder.path() / name; }
  static fs::path sample(const std::string& name) { return fs::path(RHIZODONT_SOURCE_DIR) / "samples" / name; }

  /// The bad places, made for an output of this ending.
  void make_places(const Output& output) const {
    const std::string& e = output.ending;
    fs::create_symlink(output.input, at("input_linked" + e));
    fs::create_hard_link(at(output.input), at("input_hard" + e));
    fs::create_symlink("/dev/full", at("full" + e));
    fs::create_symlink("circle" + e, at("circle" + e));
    fs::create_symlink("missing/new" + e, at("nowhere" + e));
    chmod(folder.write("protected" + e, "protected").c_str(), 0444);
    fs::create_directory(at("folder" + e));
  }

  void remove_places(const std::string& e) const {
    for (const char* name : {"input_linked", "input_hard", "full", "circle", "nowhere", "protected", "folder"})
      fs::remove(at(name + e));
  }

  /// Everything in the folder: kind, mode, contents or where a link leads.
  std::map<std::string, std::string> everything() const {
    std::map<std::string, std::string> all;
    add_everything(folder.path(), all);
    return all;
  }

  void add_everything(const fs::path& in, std::map<std::string, std::string>& all) const {
    for (const auto& entry : fs::directory_iterator(in)) {
      struct stat status {};
      lstat(entry.path().c_str(), &status);
      if (S_ISDIR(status.st_mode)) add_everything(entry.path(), all);
      std::string what = std::to_string(status.st_mode) + " ";
      if (S_ISLNK(status.st_mode)) what += fs::read_symlink(entry.path()).string();
      if (S_ISREG(status.st_mode)) what += std::to_string(status.st_ino) + " " + test::read_all(entry.path());
      all[entry.path().string()] = what;
    }
  }

  void expect_nothing_lost(const std::string& arguments, int code, const std::string& what = {},
                           const std::string& before_the_program = {}) const {
    const auto before = everything();
    const Outcome outcome = run(arguments, before_the_program);
    EXPECT_EQ(outcome.code, code) << arguments << " (" << what << ")\n" << outcome.error;
    EXPECT_EQ(outcome.error.rfind("rhizodont: ", 0), 0U) << arguments << "\n" << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    EXPECT_TRUE(everything() == before) << arguments << " (" << what << ")";
  }
};

TEST_F(LostFiles, EveryOutputAtEveryBadPlace) {
  for (const Output& output : outputs) {
    make_places(output);
    for (const Place& place : places) {
      if (place.name == "folder" && output.command.starts_with("complete")) continue;  // results go into it
      std::string command = output.command;
      command.replace(command.find("OUT"), 3, place.name + output.ending);
      expect_nothing_lost(command, place.code, place.what);
    }
    remove_places(output.ending);
  }
}

TEST_F(LostFiles, AnOutputThatIsAnInputIsRefusedBeforeTheWork) {
  for (const char* command : {"complete crown.stl --fdi 36 -o crown.stl", "complete crown.stl --fdi 36 -o ./crown.stl",
                              "complete tooth.ply --fdi 36 -o older.ply --report tooth.ply",
                              "complete tooth.ply --fdi 36 --skirt auto -o older.ply --skirt-confidence tooth.ply",
                              "render tooth.ply -o tooth.ply", "label-skirt crown.stl tooth.ply -o tooth.ply",
                              "measure crown.stl --json ./crown.stl", "check crown.stl tooth.ply --json tooth.ply",
                              "check crown.stl tooth.ply --report older.json --json older.json",
                              "evaluate cases --csv cases/crown_36.stl", "evaluate cases --plot cases/tooth_36.ply"})
    expect_nothing_lost(command, 2);
}

TEST_F(LostFiles, WhatTheShellOpenedAsStandardInputIsAnInput) {
  fs::create_hard_link(at("tooth.ply"), at("link.json"));
  fs::create_symlink("tooth.ply", at("neighbour_3.ply"));
  for (const char* names : {"-o new/../tooth.ply", "-o older.ply --report link.json",
                            "-o older.ply --skirt auto --skirt-confidence tooth.ply",
                            "-o neighbour.ply --candidates 3 --overwrite", "-o /dev/fd/9"})
    expect_nothing_lost(std::string("complete - --fdi 36 ") + names, 2, "standard input",
                        "exec < tooth.ply 9>> tooth.ply;");
  expect_error("complete - --fdi 36 -o ./crown.stl < crown.stl", 2, "over standard input, which is read");
}

TEST_F(LostFiles, TwoOutputsThatAreOneFileAreRefused) {
  fs::create_symlink("older.ply", at("link.json"));
  for (const char* command :
       {"complete crown.stl --fdi 36 -o older.ply --report older.ply",
        "complete crown.stl --fdi 36 -o older.ply --report link.json",
        "complete crown.stl --fdi 36 -o new.ply --report sub/../new.ply",
        "complete crown.stl --fdi 36 --skirt auto -o new.ply --skirt-confidence new.ply",
        "complete crown.stl --fdi 36 --candidates 2 -o new.ply --report new_2.ply",
        "complete crown.stl --fdi 36 --skirt auto --candidates 2 -o new.ply --skirt-confidence new_2.ply",
        "evaluate cases --csv new.txt --plot new.txt", "evaluate cases --json new.txt --plot new.txt",
        "synth --data cases --sheet new.png --atlas new.png"})
    expect_nothing_lost(command, 2);
}

TEST_F(LostFiles, NamesThatTheUserDidNotGiveReplaceNothing) {
  expect_nothing_lost("complete crown.stl --fdi 36 --e 2 --candidates 2 -o neighbour.ply", 2);
  fs::create_symlink("crown.stl", at("report_2.json"));
  expect_nothing_lost("complete crown.stl --fdi 36 --e 2 --candidates 2 -o new.ply --report report.json", 2);
  expect_nothing_lost("complete crown.stl --fdi 36 --candidates 2 --overwrite -o new.ply --report report.json", 2);
  folder.write("tooth_36_7.ply", "mine");
  expect_nothing_lost("synth --data cases --type 36 --seed 7 -o .", 2);
  const Outcome said = run("complete crown.stl --fdi 36 --e 2 --candidates 2 --overwrite -o neighbour.ply");
  EXPECT_EQ(said.code, 0) << said.error;
  EXPECT_NE(test::read_all(at("neighbour_2.ply")), "a neighbour");
}

TEST_F(LostFiles, NamesThatDoNotFitAreRefusedBeforeTheWork) {
  for (const char* command :
       {"complete missing.stl --fdi 36 -o new.doc", "complete missing.stl --fdi 36 -o new",
        "complete missing.stl --fdi 36 -o new.ply --report new.stl", "render missing.ply -o new.ply",
        "render missing.ply -o new.jpg", "label-skirt missing.ply missing.ply -o new.stl",
        "complete missing.stl --skirt auto -o new.ply --skirt-confidence new.stl", "measure missing.ply --json new.obj",
        "synth --data cases --sheet new.ply"})
    expect_nothing_lost(command, 2);
}

TEST_F(LostFiles, OneResultThatCannotBeWrittenKeepsAllOthersAsTheyWere) {
  expect_nothing_lost("complete crown.stl --fdi 36 --e 2 -o older.ply --report /dev/full", 7);
  expect_nothing_lost("complete crown.stl --fdi 36 --e 2 -o new/sub/tooth.ply --report /dev/full", 7);
  expect_nothing_lost("evaluate cases --e 2 --csv older.csv --plot /dev/full", 7);
  // the tooth is larger than files may become: 32 blocks of 512 or 1024 bytes
  expect_nothing_lost("complete crown.stl --fdi 36 --e 2 -o older.ply --report older.json", 7, "a limit of sizes",
                      "ulimit -f 32;");
}

TEST_F(LostFiles, AStoppedRunLeavesTheOlderOrTheNewFiles) {
  const std::string command = "complete crown.stl --fdi 36 --e 2 --quiet -o older.ply --report older.json";
  for (const char* seconds : {"0.05", "0.3", "0.6", "0.9", "1.2"}) {
    const auto before = everything();
    const Outcome outcome = run(command, std::string("timeout -s INT ") + seconds);
    const auto after = everything();
    ASSERT_EQ(after.size(), before.size()) << seconds;
    if (outcome.code == 0) continue;
    EXPECT_EQ(after.at(at("older.ply")) == before.at(at("older.ply")),
              after.at(at("older.json")) == before.at(at("older.json")));
  }
}

TEST_F(LostFiles, LinksAndModesOfReplacedResultsStay) {
  fs::create_symlink("older.ply", at("link.ply"));
  chmod(at("older.ply").c_str(), 0640);
  ASSERT_EQ(run("complete crown.stl --fdi 36 --e 2 -o link.ply --report made/for/it/report.json").code, 0);
  EXPECT_TRUE(fs::is_symlink(at("link.ply")));
  EXPECT_EQ(fs::status(at("older.ply")).permissions(), static_cast<fs::perms>(0640));
  EXPECT_GT(fs::file_size(at("older.ply")), 10'000U);
  EXPECT_TRUE(fs::exists(at("made/for/it/report.json")));
}

}  // namespace
}  // namespace rhizodont
