// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What every command says, and how: --quiet, --verbose, --json, colours.
#include "app/program.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/io.hpp"

#include <nlohmann/json.hpp>

#include <sstream>

namespace rhizodont {
namespace {

using Json = nlohmann::json;
using test::Outcome;

class OutputOptionsOfCommands : public test::Program {
 protected:
  void SetUp() override {
    for (const char* name : {"crown_11.stl", "crown_34.ply", "skirt_36.ply"})
      fs::copy_file(fs::path(RHIZODONT_SOURCE_DIR) / "samples" / name, folder.path() / name);
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }

  Json file(const std::string& name) const { return Json::parse(test::read_all(folder.path() / name)); }

  /// The names of all commands, as the help lists them.
  std::vector<std::string> commands() const {
    std::istringstream help(run("--help").out);
    std::vector<std::string> names;
    bool is_list = false;
    for (std::string line; std::getline(help, line);) {
      if (line.starts_with("Subcommands:")) is_list = true;
      if (is_list && line.starts_with("  ") && line.size() > 2 && line[2] != ' ')
        names.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
    return names;
  }
};

TEST_F(OutputOptionsOfCommands, AreTheSameForAll) {
  std::vector<std::string> all = commands();
  ASSERT_GE(all.size(), 12U);
  all.emplace_back("batch status");
  for (const std::string& command : all) {
    const std::string help = run(command + " --help").out;
    EXPECT_NE(help.find("--quiet "), std::string::npos) << command;
    EXPECT_NE(help.find("--verbose "), std::string::npos) << command;
  }
  for (const char* command : {"check", "measure", "evaluate", "arch", "complete", "segment", "doctor", "label-skirt",
                              "batch", "batch status"})
    EXPECT_NE(run(command + std::string(" --help")).out.find("--json [FILE]"), std::string::npos) << command;
  expect_error("measure crown_34.ply --quiet --verbose", 2, "--quiet excludes --verbose");
}

TEST_F(OutputOptionsOfCommands, FiguresOfCompleteAreItsReports) {
  const Outcome printed = run("complete crown_34.ply --e 2 -o tooth.ply --report tooth.json --json");
  ASSERT_EQ(printed.code, 0) << printed.error;
  const Json figures = Json::parse(printed.out);
  ASSERT_EQ(figures["crowns"].size(), 1U);
  EXPECT_EQ(figures["crowns"][0]["crown"], "crown_34.ply");
  EXPECT_EQ(figures["crowns"][0]["exit_code"], 0);
  EXPECT_TRUE(figures["crowns"][0]["refusal"].is_null());
  EXPECT_EQ(figures["crowns"][0]["teeth"][0]["tooth"], "tooth.ply");
  EXPECT_EQ(figures["crowns"][0]["teeth"][0]["report"], file("tooth.json"));

  const Outcome several = run("complete crown_34.ply flat.obj -o teeth/ --e 2 --json figures.json");
  EXPECT_EQ(several.code, 6);
  EXPECT_NE(several.out.find("1 of 2 crowns completed"), std::string::npos) << several.out;
  const Json both = file("figures.json")["crowns"];
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0]["teeth"].size(), 1U);
  EXPECT_EQ(both[1]["exit_code"], 3);
  EXPECT_EQ(both[1]["teeth"].size(), 0U);
  EXPECT_EQ(both[1]["refusal"]["refused"]["exit_code"], 3);
}

TEST_F(OutputOptionsOfCommands, FiguresOfARefusedCrownAreWritten) {
  EXPECT_EQ(run("complete flat.obj --fdi 11 -o tooth.ply --json figures.json").code, 3);
  EXPECT_EQ(file("figures.json")["crowns"][0]["exit_code"], 3);
  EXPECT_FALSE(fs::exists(folder.path() / "tooth.ply"));
  expect_error("complete crown_34.ply -o - --json", 2, "would be mixed");
  expect_error("complete crown_34.ply -o tooth.ply --json tooth.ply", 2, "tooth.ply");
  expect_error("complete crown_34.ply -o tooth.ply --json crown_34.json.stl", 2, "name of a mesh");
}

TEST_F(OutputOptionsOfCommands, FiguresOfOtherCommands) {
  fs::create_directory(folder.path() / "crowns");
  fs::copy_file(folder.path() / "crown_34.ply", folder.path() / "crowns" / "crown_34.ply");
  const Outcome arch = run("arch crowns -o out --e 2 --json");
  ASSERT_EQ(arch.code, 0) << arch.error;
  EXPECT_EQ(Json::parse(arch.out), file("out/arch.json"));

  const Outcome labelled = run("label-skirt crown_34.ply crown_34.ply -o labelled.ply --json");
  ASSERT_EQ(labelled.code, 0) << labelled.error;
  const Json counted = Json::parse(labelled.out);
  EXPECT_EQ(counted["tooth"], counted["vertices"]);
  EXPECT_EQ(counted["skirt"], 0);

  folder.write("cases.csv", "scan,fdi\ncrown_34.ply,34\nflat.obj,11\n");
  const Outcome batch = run("batch cases.csv -o batch --e 2 --json");
  EXPECT_EQ(batch.code, 6) << batch.error;
  const Json done = Json::parse(batch.out);
  EXPECT_EQ(done["cases"], 2);
  EXPECT_EQ(done["done"], 1);
  EXPECT_EQ(done["failed"], 1);

  const Outcome doctor = run("doctor --json");
  ASSERT_EQ(doctor.code, 0) << doctor.out;
  EXPECT_EQ(Json::parse(doctor.out)["well"], true);
}

TEST_F(OutputOptionsOfCommands, FiguresOfLabelsThatWereFound) {
  const fs::path scan = fs::path(RHIZODONT_SOURCE_DIR) / "samples" / "scan_lower.ply";
  fs::create_directory(folder.path() / "found");
  const Outcome found = run("segment '" + scan.string() + "' -o found/scan.json --json");
  ASSERT_EQ(found.code, 0) << found.error;
  const Json figures = Json::parse(found.out);
  EXPECT_EQ(figures["jaw"], "lower");
  ASSERT_EQ(figures["teeth"].size(), 12U);
  EXPECT_GT(figures["teeth"][0]["vertices"], 100);
  EXPECT_EQ(figures["teeth"][0]["middle"].size(), 3U);

  // judged against themselves they are right
  fs::create_directory(folder.path() / "truth");
  fs::copy_file(scan, folder.path() / "truth" / "scan.ply");
  fs::copy_file(folder.path() / "found" / "scan.json", folder.path() / "truth" / "scan.json");
  const Outcome judged = run("evaluate truth --labels found --json");
  ASSERT_EQ(judged.code, 0) << judged.error;
  const Json right = Json::parse(judged.out);
  EXPECT_EQ(right["scans"][0]["scan"], "scan");
  EXPECT_EQ(right["scans"][0]["teeth"].size(), 12U);
  EXPECT_EQ(right["summary"]["right"], 12);
  EXPECT_EQ(right["summary"]["without_error"], 1);
  EXPECT_EQ(run("evaluate truth --labels found --quiet").out, "");
}

TEST_F(OutputOptionsOfCommands, QuietPrintsErrorsAlone) {
  ASSERT_EQ(run("complete crown_34.ply --e 2 -o tooth.ply --quiet").code, 0);
  for (const char* command : {"complete crown_34.ply --e 2 -o again.ply", "check crown_34.ply tooth.ply",
                              "measure tooth.ply", "render tooth.ply --width 20 --height 20 -o a.png",
                              "label-skirt crown_34.ply tooth.ply -o labelled.ply", "doctor"}) {
    const Outcome outcome = run(command + std::string(" --quiet"));
    EXPECT_EQ(outcome.code, 0) << command;
    EXPECT_EQ(outcome.out + outcome.error, "") << command;
  }
  const Outcome kept = run("check crown_34.ply crown_34.ply --quiet");
  EXPECT_EQ(kept.code, 4);
  EXPECT_EQ(kept.out + kept.error, "");
  EXPECT_EQ(Json::parse(run("measure tooth.ply --quiet --json").out)["size"]["closed"], true);
  const Outcome doctor = run("doctor --models . --quiet");
  EXPECT_EQ(doctor.code, 3);
  EXPECT_EQ(doctor.out, "");
  EXPECT_NE(doctor.error.find("rhizodont: There is no completion.safetensors"), std::string::npos) << doctor.error;
}

TEST_F(OutputOptionsOfCommands, DoctorDoesNotCallAllWellWhereModelsAreMissing) {
  EXPECT_NE(run("doctor").out.find("\nAll is well.\n"), std::string::npos);
  fs::create_directory(folder.path() / "models");
  for (const char* name : {"completion.safetensors", "atlas.safetensors"})
    fs::create_symlink(fs::path(RHIZODONT_SOURCE_DIR) / "models" / name, folder.path() / "models" / name);
  const Outcome doctor = run("doctor --models models");
  EXPECT_EQ(doctor.code, 0) << doctor.error;
  EXPECT_EQ(doctor.out.find("All is well"), std::string::npos) << doctor.out;
  EXPECT_NE(doctor.out.find("It works, but"), std::string::npos) << doctor.out;
  for (const char* name : {"arch", "likeness", "pose", "segment", "skirt"})
    EXPECT_NE(doctor.out.find(std::string("warning: There is no ") + name + ".safetensors"), std::string::npos) << name;
  // as it says of them
  expect_error("complete crown_34.ply -o tooth.ply --models models --skirt auto", 2, "skirt.safetensors");
  fs::create_directory(folder.path() / "crowns");
  fs::copy_file(folder.path() / "crown_34.ply", folder.path() / "crowns" / "crown_34.ply");
  expect_error("arch crowns -o out --models models", 3, "skirt.safetensors");
  EXPECT_EQ(run("complete crown_34.ply --e 2 -o tooth.ply --models models").code, 0);
}

TEST_F(OutputOptionsOfCommands, VerboseSaysWhatIsDoneOnStandardError) {
  const Outcome plain = run("complete crown_34.ply --e 2 -o tooth.ply");
  const Outcome told = run("complete crown_34.ply --e 2 -o tooth.ply --verbose");
  EXPECT_EQ(plain.error, "");
  EXPECT_EQ(told.out.substr(0, told.out.find(", new triangles")),
            plain.out.substr(0, plain.out.find(", new triangles")));
  for (const char* words : {"models: ", "crown_34.ply: ", " vertices", " ...\n", " MB\n"})
    EXPECT_NE(told.error.find(words), std::string::npos) << words << " in\n" << told.error;
  EXPECT_EQ(told.error.find('\033'), std::string::npos);
  const Outcome measured = run("measure tooth.ply --verbose --json");
  EXPECT_TRUE(Json::parse(measured.out).is_object());
  EXPECT_NE(measured.error.find("tooth.ply: "), std::string::npos) << measured.error;
}

TEST_F(OutputOptionsOfCommands, ColourAndProgressAreForTerminals) {
  const std::string complete = "complete crown_34.ply --e 2 -o tooth.ply";
  const auto on_terminal = [&](const std::string& arguments, const std::string& environment) {
    folder.write("command.sh", environment + " '" RHIZODONT_PROGRAM "' " + arguments + "\n");
    const std::string log = (folder.path() / "log").string();
    const std::string command =
        "cd '" + folder.path().string() + "' && script -qec 'sh command.sh' '" + log + "' > /dev/null < /dev/null";
    EXPECT_EQ(std::system(command.c_str()) & 0xff, 0);
    return test::read_all(log);
  };
  const std::string with_colours = "unset NO_COLOR; TERM=xterm";
  EXPECT_NE(on_terminal(complete, with_colours).find("\033[K"), std::string::npos);
  EXPECT_EQ(on_terminal(complete + " --quiet", with_colours).find("\033"), std::string::npos);
  EXPECT_NE(on_terminal("check crown_34.ply tooth.ply", with_colours).find("\033[32mkept"), std::string::npos);
  EXPECT_NE(on_terminal("measure nothing.ply", with_colours).find("\033[31mrhizodont:\033[0m"), std::string::npos);
  EXPECT_EQ(on_terminal("check crown_34.ply tooth.ply", "NO_COLOR=1 TERM=xterm").find("\033["), std::string::npos);
  EXPECT_EQ(on_terminal("check crown_34.ply tooth.ply", "unset NO_COLOR; TERM=dumb").find("\033["), std::string::npos);
  EXPECT_EQ(run("check crown_34.ply tooth.ply").out.find('\033'), std::string::npos);
}

}  // namespace
}  // namespace rhizodont
