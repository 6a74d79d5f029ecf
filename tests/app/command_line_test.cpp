// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The command line of somebody in a hurry: slips of the pen, several crowns, pipes, numbers and units as people write
// them.
#include "app/program.hpp"
#include "rhizodont/io.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using test::Outcome, test::read_all;

class CommandLine : public test::Program {
 protected:
  CommandLine() {
    for (const char* name : {"crown_34.ply", "crown_36.stl"})
      fs::copy_file(fs::path(RHIZODONT_SOURCE_DIR) / "samples" / name, at(name));
  }

  fs::path at(const std::string& name) const { return folder.path() / name; }
  nlohmann::json report(const std::string& name) const { return nlohmann::json::parse(std::ifstream(at(name))); }

  /// A fast way to complete.
  static std::string complete(const std::string& arguments) { return "complete --e 2 " + arguments; }

  void expect_done(const std::string& arguments, const std::string& before_the_program = {}) const {
    const Outcome outcome = run(arguments, before_the_program);
    ASSERT_EQ(outcome.code, 0) << arguments << "\n" << outcome.error;
  }
};

TEST_F(CommandLine, FewLibrariesAreLoadedAndNoneForTraining) {
  const fs::path list = folder.path() / "libraries";
  ASSERT_EQ(std::system(("ldd '" RHIZODONT_PROGRAM "' > '" + list.string() + "'").c_str()), 0);
  const std::string libraries = read_all(list);
  EXPECT_LT(std::count(libraries.begin(), libraries.end(), '\n'), 40);
  EXPECT_EQ(libraries.find("torch"), std::string::npos) << libraries;
  EXPECT_EQ(libraries.find("blas"), std::string::npos) << libraries;
}

TEST_F(CommandLine, WhatWasMeantIsSuggested) {
  expect_error("complet crown_34.ply", 2, "no command 'complet': did you mean complete?");
  expect_error("comp", 2, "did you mean complete?");
  expect_error("rendre tooth.ply", 2, "did you mean render?");
  expect_error("label_skirt", 2, "did you mean label-skirt?");
  expect_error("crown_34.ply -o tooth.ply", 2, "did you mean complete crown_34.ply?");
  expect_error("xyzzy", 2, "there are complete, arch, batch, segment, evaluate, check");
  expect_error(complete("crown_34.ply --rapair -o tooth.ply"), 2, "no option --rapair: did you mean --repair?");
  expect_error(complete("crown_34.ply --root-lenght=12 -o tooth.ply"), 2, "did you mean --root-length?");
  expect_error(complete("crown_34.ply --xyzzy -o tooth.ply"), 2, "--xyzzy");
}

TEST_F(CommandLine, NumbersAreDecimal) {
  for (const char* fdi : {"\"\"", "0", "x", "3.4", "0x22", "34x", "99999999999", "-34", "19", "++34", "\" 34\""})
    EXPECT_EQ(run(complete(std::string("crown_34.ply -o tooth.ply --fdi ") + fdi)).code, 2) << fdi;
  for (const char* option : {"--e \"\"", "--e nan", "--e inf", "--e 0x1", "--root-length 14mm", "--threads 0b1"})
    EXPECT_EQ(run(complete(std::string("crown_34.ply -o tooth.ply --fdi 34 ") + option)).code, 2) << option;
  expect_error(complete("crown_34.ply -o tooth.ply --fdi 34 --root-length 14,2"), 2, "a point, not a comma");
  expect_error("synth --data . -o teeth --type 34 --seed -1", 2, "below zero");
  EXPECT_FALSE(fs::exists(at("tooth.ply")));
  expect_done(complete("crown_34.ply -o tooth.ply --report r.json --fdi 034 --root-length +14.50 --threads 010"));
  EXPECT_EQ(report("r.json")["fdi"]["number"], 34) << "octal 034 is 28";
  EXPECT_EQ(report("r.json")["options"]["threads"], 10);
  EXPECT_EQ(report("r.json")["options"]["steering"]["root_length_mm"], 14.5);
}

TEST_F(CommandLine, UnitsInAnySpelling) {
  MeshFile crown = load_mesh(at("crown_34.ply"));
  const std::vector<Point> mm = crown.mesh.vertices;
  const std::vector<std::pair<std::vector<std::string>, double>> units{
      {{"MM", "Millimetres"}, 1},
      {{"cm", "centimeter"}, 10},
      {{"M", "metre"}, 1000},
      {{"inch", "Inches", "in."}, 25.4},
      {{"um", "\u00b5m", "\u03bcm", "microns", "micrometres"}, 1e-3}};
  for (const auto& [names, size] : units) {
    for (std::size_t v = 0; v < mm.size(); ++v) crown.mesh.vertices[v] = mm[v] / size;
    save_mesh(at("other.ply"), crown);
    for (const std::string& name : names) {
      expect_done(complete("other.ply --fdi 34 -o tooth.ply --report r.json --unit '" + name + "'"));
      EXPECT_EQ(report("r.json")["options"]["millimetres_per_unit"], size) << name;
    }
  }
  expect_error(complete("crown_34.ply --fdi 34 -o tooth.ply --unit feet"), 2, "none of mm, cm, m, um and in");
}

TEST_F(CommandLine, SeveralCrownsGoToAFolder) {
  fs::copy_file(at("crown_34.ply"), at("somebody.ply"));
  folder.write("bad_11.stl", "nothing");
  const Outcome outcome =
      run(complete("crown_34.ply bad_11.stl crown_36.stl somebody.ply -o teeth/today --report teeth/reports"));
  EXPECT_EQ(outcome.code, 6) << outcome.error;
  EXPECT_NE(outcome.error.find("bad_11.stl"), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.out.find("3 of 4 crowns completed"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("Tooth 34, taken from the file's name."), std::string::npos) << outcome.out;
  for (const char* name : {"crown_34", "crown_36", "somebody"}) {
    EXPECT_TRUE(fs::exists(at("teeth/today/" + std::string(name) + "_tooth.ply"))) << name;
    EXPECT_TRUE(fs::exists(at("teeth/reports/" + std::string(name) + "_tooth.json"))) << name;
  }
  EXPECT_FALSE(fs::exists(at("teeth/today/bad_11_tooth.ply")));
  EXPECT_TRUE(report("teeth/reports/bad_11_tooth.json").contains("refused"));
  EXPECT_EQ(report("teeth/reports/crown_36_tooth.json")["fdi"]["number"], 36);
  EXPECT_TRUE(report("teeth/reports/somebody_tooth.json")["fdi"]["guessed"].get<bool>());
  EXPECT_EQ(run("check crown_36.stl teeth/today/crown_36_tooth.ply").code, 0);

  // A file that is not there is one without a tooth like others; where none has one, the reason's own code stays.
  EXPECT_EQ(run(complete("crown_34.ply gone_36.stl -o other/")).code, 6);
  EXPECT_EQ(run(complete("bad_11.stl gone_36.stl -o other/")).code, 3);

  expect_error(complete("crown_34.ply crown_36.stl -o teeth/today"), 2, "did not name it yourself");
  expect_error(complete("crown_34.ply crown_36.stl --fdi 34 -o more"), 2, "--fdi is of one crown");
  expect_error(complete("crown_34.ply crown_36.stl -o somebody.ply"), 2, "need a folder");
  expect_error(complete("crown_34.ply crown_36.stl -o more/tooth.ply"), 2, "need a folder");
  expect_error(complete("crown_34.ply crown_36.stl -o more --report -"), 2, "give a folder (--report FOLDER)");
  expect_error(complete("crown_34.ply crown_36.stl -o -"), 2, "give a folder (-o FOLDER)");
  expect_error(complete("crown_34.ply crown_34.ply -o more"), 2, "crown_34.ply is given twice");
  fs::create_directory(at("p2"));
  fs::copy_file(at("crown_34.ply"), at("p2/crown_34.ply"));
  expect_error(complete("crown_34.ply p2/crown_34.ply -o more"), 2, "crown_34.ply and p2/crown_34.ply would both");
  EXPECT_FALSE(fs::exists(at("more"))) << "nothing is made before all is planned";
  expect_done(complete("crown_36.stl --fdi 36 -o teeth/today --overwrite --output-format stl --quiet"));
  EXPECT_TRUE(fs::exists(at("teeth/today/crown_36_tooth.stl")));
}

TEST_F(CommandLine, SlipsInNamesAndWordsAreSaid) {
  expect_error(complete("crown_36.stl -o new"), 2, "for a new folder write new/.");
  expect_error(complete("crown_36.stl -o -  --report -"), 2, "Standard output takes one result only");
  expect_error(complete("crown_36.stl -o tooth.stl --output-format obj"), 2, "ends in .obj");
  expect_error("arch crown_36.stl -o -", 2, "give a folder (-o FOLDER)");
  expect_error("synth --data . --type 36 -o -", 2, "give a folder (-o FOLDER)");
  expect_error("batch cases.csv -o -", 2, "give a folder (-o FOLDER)");
  for (const char* option : {"-o ''", "-o tooth.ply --report ''", "-o tooth.ply --models ''"})
    expect_error(complete(std::string("crown_36.stl ") + option), 2, "an empty one was given");
  expect_error(complete("crown_36.stl -o tooth.ply --unit 10"), 2, "--unit takes a name, not the number 10");
  expect_error(complete("no.stl -o tooth.ply --skirt AUTO --cap Drop"), 3, "no.stl");
}

TEST_F(CommandLine, TheNumberInTheNameOfASingleCrownIsBelieved) {
  struct Case {
    const char* name;
    int fdi;  // 0: guessed
  };
  for (const auto& [name, fdi] : {Case{"crown_36.stl", 36},
                                  {"2026-11-27_36.STL", 36},
                                  {"11_2026_36.stl", 36},
                                  {"scan_2026-11-12.stl", 0},
                                  {"27.11.2026.stl", 0},
                                  {"patient11_36.stl", 0},
                                  {"crown_136.stl", 0},
                                  {"tooth_55.stl", 0},
                                  {"crown.stl", 0}}) {
    fs::copy_file(fs::path(RHIZODONT_SOURCE_DIR) / "samples/crown_36.stl", at(name),
                  fs::copy_options::overwrite_existing);
    const Outcome outcome = run(complete(std::string(name) + " -o tooth.ply --report r.json"));
    ASSERT_EQ(outcome.code, 0) << name << outcome.error;
    EXPECT_EQ(report("r.json")["fdi"]["guessed"].get<bool>(), fdi == 0) << name;
    if (fdi != 0) {
      EXPECT_EQ(report("r.json")["fdi"]["number"], fdi) << name;
    }
    EXPECT_EQ(outcome.out.find("note: Tooth 36, taken from the file's name.") != std::string::npos, fdi != 0) << name;
  }
  expect_done(complete("crown_36.stl --fdi 37 -o tooth.ply --report r.json"));
  EXPECT_EQ(report("r.json")["fdi"]["number"], 37) << "what the user says goes before the name";
  expect_done(complete("open_12 -o tooth.ply --report r.json"), "ln -s /dev/fd/9 open_12; exec 9< crown_36.stl;");
  EXPECT_TRUE(report("r.json")["fdi"]["guessed"].get<bool>()) << "numbers of open files are no tooth's";
}

TEST_F(CommandLine, OfAFolderOfModelsOnlyTheModelsAreGuarded) {
  fs::create_directory(at("models"));
  expect_error(complete("crown_36.stl -o models/tooth.ply --models models"), 3, "no completion.safetensors in models");
  for (const auto& model : fs::directory_iterator(fs::path(RHIZODONT_SOURCE_DIR) / "models"))
    fs::copy(model.path(), at("models") / model.path().filename());
  folder.write("models/tooth.ply", "an older tooth");
  expect_done(complete("crown_36.stl -o models/tooth.ply --models models"));
  const std::string before = read_all(at("models/skirt.safetensors"));
  expect_error(complete("crown_36.stl -o tooth.ply --report models/skirt.safetensors --models models"), 2,
               "which is read");
  EXPECT_TRUE(read_all(at("models/skirt.safetensors")) == before);
}

TEST_F(CommandLine, StandardInputAndOutput) {
  expect_done(complete("crown_36.stl --fdi 36 -o file.ply"));
  expect_error(complete("- - --format stl -o teeth"), 2, "only once");
  const Outcome piped = run(complete("- --format stl --fdi 36 -o - --report r.json"), "cat crown_36.stl |");
  ASSERT_EQ(piped.code, 0) << piped.error;
  EXPECT_TRUE(piped.out == read_all(at("file.ply"))) << "nothing but the tooth on standard output";
  EXPECT_NE(piped.error.find("tooth 36"), std::string::npos) << piped.error;
  EXPECT_TRUE(report("r.json")["input"]["sha256"].is_string());
  expect_error(complete("- --format stl --fdi 36 -o tooth.ply"), 3, "standard input");  // an empty one
  const Outcome full = run(complete("crown_36.stl --fdi 36 -o - > /dev/full; exit $?; true"));
  EXPECT_EQ(full.code, 7) << full.error;
  EXPECT_EQ(run("measure crown_36.stl > /dev/full; exit $?; true").code, 7);
  EXPECT_EQ(run("measure crown_36.stl --json > /dev/full; exit $?; true").code, 7);
  for (const char* command : {"--version", "--help", "complete --help", "manual complete", "shell-completion zsh"}) {
    const Outcome unprinted = run(command + std::string(" > /dev/full 2> said; exit $?; true"));
    EXPECT_EQ(unprinted.code, 7) << command;
    EXPECT_EQ(read_all(at("said")), "rhizodont: standard output cannot be written: No space left on device\n");
  }
}

TEST_F(CommandLine, NamesThatAreNotUtf8AndNamesOfPatients) {
  const std::string name = "M\xfcller_36.stl";  // Latin-1
  fs::copy_file(at("crown_36.stl"), at(name));
  expect_done(complete("'" + name + "' --fdi 36 -o tooth.ply --report r.json"));
  EXPECT_TRUE(report("r.json")["input"]["file"].is_null());
  EXPECT_EQ(read_all(at("r.json")).find("ller_36"), std::string::npos);
  expect_done(complete("'" + name + "' --fdi 36 -o '" + name + ".ply' --report r.json --name-in-report"));
  EXPECT_EQ(report("r.json")["input"]["file"], "M\xef\xbf\xbdller_36.stl");
  EXPECT_EQ(run("measure 'no " + name + "'").code, 3);
}

TEST_F(CommandLine, TheReportOnARefusedFileDoesNotNameIt) {
  folder.write("Mueller_36.stl", "nothing");
  const Outcome outcome = run(complete("Mueller_36.stl -o tooth.ply --report r.json"));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.error.find("Mueller_36.stl: "), std::string::npos) << "on the screen it helps: " << outcome.error;
  EXPECT_TRUE(report("r.json").contains("refused"));
  EXPECT_EQ(read_all(at("r.json")).find("Mueller"), std::string::npos) << read_all(at("r.json"));
  EXPECT_EQ(run(complete("Mueller_36.stl -o tooth.ply --report r.json --name-in-report")).code, 3);
  EXPECT_EQ(report("r.json")["input"]["file"], "Mueller_36.stl");
}

TEST_F(CommandLine, AWrongFolderOfModelsIsNoRefusalOfTheCrown) {
  expect_done(complete("crown_34.ply --fdi 34 -o tooth.ply --report r.json"));
  const std::string before = read_all(at("r.json"));
  expect_error(complete("crown_34.ply --fdi 34 -o tooth.ply --report r.json --models nowhere"), 3, "nowhere");
  EXPECT_EQ(read_all(at("r.json")), before) << "an earlier report is lost";
}

TEST_F(CommandLine, FilesThatCannotBeReadAreNoFaultOfTheProgram) {
  fs::create_symlink("circle.stl", at("circle.stl"));
  const std::string too_long(300, 'a');
  for (const std::string& name : {std::string("circle.stl"), too_long, std::string("/proc/self/mem")}) {
    expect_error(complete("'" + name + "' --fdi 34 -o tooth.ply"), 3, name.substr(0, 20));
    expect_error("measure '" + name + "'", 3, name.substr(0, 20));
  }
  expect_error(too_long, 2, "there is no command");
}

TEST_F(CommandLine, AFaultInOneCrownLeavesTheOthers) {
  std::ofstream(at("endless.stl")).put('0');
  fs::resize_file(at("endless.stl"), std::uintmax_t{1} << 40);  // without a byte on the disk
  folder.write("bad_11.stl", "nothing");
  const Outcome outcome = run(complete("endless.stl bad_11.stl -o teeth"), "ulimit -v 1000000;");
  EXPECT_EQ(outcome.code, 5) << outcome.error;
  EXPECT_NE(outcome.error.find("endless.stl: the machine's memory is not enough"), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find("bad_11.stl: "), std::string::npos) << outcome.error;
}

TEST_F(CommandLine, CheckReadsTheCrownOnce) {
  expect_done(complete("crown_36.stl --fdi 36 -o tooth.ply --report r.json"));
  expect_done("check /dev/stdin tooth.ply --report r.json", "cat crown_36.stl |");
}

TEST_F(CommandLine, DoubleCoordinatesAreNotRoundedUnasked) {
  MeshFile crown = load_mesh(at("crown_34.ply"));
  for (Point& p : crown.mesh.vertices) p += Point(1e-9, 0, 0);
  save_mesh(at("double.ply"), crown);
  for (const char* name : {"tooth.stl", "tooth.glb"})
    expect_error(complete("double.ply --fdi 34 -o ") + name, 2, "--as-float");
  expect_done(complete("double.ply --fdi 34 -o exact.ply"));
  EXPECT_EQ(run("check double.ply exact.ply").code, 0);
  const Outcome rounded = run(complete("double.ply --fdi 34 -o tooth.stl --as-float --report r.json"));
  ASSERT_EQ(rounded.code, 0) << rounded.error;
  EXPECT_NE(rounded.out.find("rounded to float"), std::string::npos) << rounded.out;
  const double moved = report("r.json")["input"]["rounded_to_float_mm"].get<double>();
  EXPECT_GT(moved, 0);
  EXPECT_LT(moved, 1e-5);
  const Outcome checked = run("check double.ply tooth.stl --report r.json");
  EXPECT_EQ(checked.code, 0) << checked.out;
  EXPECT_NE(checked.out.find("float"), std::string::npos);
}

TEST_F(CommandLine, ThreeIdsAreEnoughOnATerminal) {
  MeshFile crown = load_mesh(at("crown_34.ply"));
  for (std::size_t t = 0; t < 200; t += 20) std::swap(crown.mesh.triangles[t][0], crown.mesh.triangles[t][1]);
  save_mesh(at("bad.ply"), crown);
  const Outcome outcome = run(complete("bad.ply --fdi 34 -o tooth.ply --report r.json"));
  ASSERT_EQ(outcome.code, 3);
  const std::size_t all = report("r.json")["refused"]["ids"].size();
  EXPECT_GT(all, 10U);
  EXPECT_EQ(report("r.json")["refused"]["ids_are"], "pairs of vertices");
  EXPECT_NE(outcome.error.find(", ...: " + std::to_string(all) + " in all, see r.json]"), std::string::npos)
      << outcome.error;
  EXPECT_LT(outcome.error.size(), 300U);
  expect_error("check '" + at("crown_34.ply").string() + "' bad.ply --report r.json", 3, "another crown");
  expect_error("check bad.ply bad.ply --report r.json", 3, "was refused");
}

}  // namespace
}  // namespace rhizodont
