// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/program.hpp"
#include "rhizodont/io.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace rhizodont::test {
namespace {

using Json = nlohmann::json;

/// All files below a folder with their bytes.
std::map<std::string, std::string> tree(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = read_all(entry.path());
  return files;
}

/// Batches of sample crowns.
class Batch : public Program {
 protected:
  /// A sample crown, its middle moved to x.
  void place(const char* sample, const std::string& name, double x, std::vector<std::string> comments = {}) const {
    MeshFile crown;
    crown.mesh = load_mesh(fs::path(RHIZODONT_SOURCE_DIR) / "samples" / sample).mesh;
    Point low = crown.mesh.vertices.front(), high = low;
    for (const Point& p : crown.mesh.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const Point to = Point(x, 0, 0) - 0.5 * (low + high);
    for (Point& p : crown.mesh.vertices) p += to;
    round_to_float(crown.mesh);
    crown.comments = std::move(comments);
    const fs::path path = folder.path() / name;
    fs::create_directories(path.parent_path());
    save_mesh(path, crown);
  }

  /// Four crowns and an arch of two.
  void write_five_cases() const {
    std::string manifest = "scan,fdi\n";
    for (int i = 0; i < 4; ++i) {
      const bool first = i % 2 == 0;
      place(first ? "crown_34.ply" : "crown_11.stl", fmt::format("crowns/c{}.ply", i), i);
      manifest += fmt::format("crowns/c{}.ply,{}\n", i, first ? 34 : 11);
    }
    place("crown_34.ply", "arch/34.ply", -7);
    place("crown_36.stl", "arch/36.ply", 7);
    folder.write("manifest.csv", manifest + "arch,\n");
  }

  std::vector<Json> ledger_lines(const std::string& batch, const std::string& event) const {
    std::vector<Json> lines;
    for (const auto& [name, text] : tree(folder.path() / batch / "ledger")) {
      std::istringstream stream(text);
      for (std::string line; std::getline(stream, line);) {
        const Json json = Json::parse(line, nullptr, false);
        if (json.is_object() && json.at("event") == event) lines.push_back(json);
      }
    }
    return lines;
  }

  /// What the ledger says of teeth, without when and how often.
  std::set<std::string> teeth_of(const std::string& batch) const {
    std::set<std::string> lines;
    for (Json line : ledger_lines(batch, "tooth")) {
      line.erase("time");
      lines.insert(line.dump());
    }
    return lines;
  }

  Json status(const std::string& batch) const { return Json::parse(run("batch status " + batch + " --json").out); }
};

TEST_F(Batch, UnionOfKilledAndResumedShardsIsThatOfOneRun) {
  write_five_cases();
  const Outcome whole = run("batch manifest.csv -o whole --e 1");
  ASSERT_EQ(whole.code, 0) << whole.error << whole.out;
  EXPECT_NE(whole.error.find("5 of 5 cases"), std::string::npos) << whole.error;
  EXPECT_EQ(tree(folder.path() / "whole/cases").count("../unfinished"), 0U);
  EXPECT_FALSE(fs::exists(folder.path() / "whole/unfinished"));

  std::mt19937 random{std::random_device{}()};
  const double moment = std::uniform_real_distribution(0.1, 2.0)(random);
  SCOPED_TRACE(fmt::format("killed after {} s", moment));
  run("batch manifest.csv -o parts --e 1 --shard 1/2 --threads 1", fmt::format("timeout -s KILL {:.3f}", moment));
  EXPECT_EQ(run("batch manifest.csv -o parts --e 1 --shard 2/2").code, 0);
  EXPECT_EQ(run("batch manifest.csv -o parts --e 1 --shard 1/2").code, 0);
  EXPECT_EQ(tree(folder.path() / "parts/cases"), tree(folder.path() / "whole/cases"));
  EXPECT_EQ(teeth_of("parts"), teeth_of("whole"));
  EXPECT_EQ(teeth_of("whole").size(), 6U);
  EXPECT_FALSE(fs::exists(folder.path() / "parts/unfinished"));

  // What is there is not done again, however it is divided now.
  const Outcome again = run("batch manifest.csv -o parts --e 1 --shard 2/3");
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(again.error.find("(from before)"), std::string::npos) << again.error;
  EXPECT_EQ(again.error.find(" s)"), std::string::npos) << again.error;
  const Json now = status("parts");
  EXPECT_EQ(now["cases"], 5);
  EXPECT_EQ(now["done"], 5);
  EXPECT_EQ(now["rooted"], 6);
  EXPECT_EQ(now["remaining"], 0);
}

TEST_F(Batch, TeethCheckAgainstTheirCrowns) {
  place("crown_34.ply", "c.ply", 0);
  folder.write("manifest.csv", "scan,fdi,root_lengths,id\nc.ply,34,13.5,my-case\n");
  const Outcome done = run("batch manifest.csv -o out --e 1 --output-format stl");
  ASSERT_EQ(done.code, 0) << done.error;
  const Json one = status("out")["by_case"][0];
  EXPECT_EQ(one["case"], "my-case");
  const std::string tooth = "out/" + one["folder"].get<std::string>() + "/tooth_34";
  EXPECT_EQ(run("check c.ply " + tooth + ".stl --report " + tooth + ".json").code, 0);
  const Json report = Json::parse(read_all(folder.path() / (tooth + ".json")));
  EXPECT_EQ(report["options"]["steering"]["root_length_mm"], 13.5);
  EXPECT_TRUE(report["stages"].empty());  // times differ from run to run
}

TEST_F(Batch, FailuresAreRememberedUntilTheyAreToBeTriedAgain) {
  place("crown_34.ply", "good.ply", 0);
  place("crown_34.ply", "arch/34.ply", -7);
  place("crown_36.stl", "arch/75.ply", 7);  // a milk tooth
  folder.write("bad.ply", "ply\nformat ascii 1.0\n");
  folder.write("manifest.csv", "scan,fdi\nbad.ply,36\nmissing.ply,36\narch,\ngood.ply,34\n");
  const Outcome first = run("batch manifest.csv -o out --e 1");
  EXPECT_EQ(first.code, 6) << first.error;
  EXPECT_EQ(ledger_lines("out", "begun").size(), 3U);
  const Json now = status("out");
  EXPECT_EQ(now["done"], 1);
  EXPECT_EQ(now["partial"], 1);
  EXPECT_EQ(now["failed"], 2);
  EXPECT_EQ(now["reasons"].size(), 3U);
  const std::string text = run("batch status out --cases").out;
  EXPECT_NE(text.find("4 cases: 1 done, 1 in part, 2 failed, 0 running, 0 remaining"), std::string::npos) << text;
  EXPECT_NE(text.find("milk tooth"), std::string::npos) << text;
  const auto before = tree(folder.path() / "out/cases");

  EXPECT_EQ(run("batch manifest.csv -o out --e 1").code, 6);
  EXPECT_EQ(ledger_lines("out", "begun").size(), 3U);
  EXPECT_EQ(run("batch manifest.csv -o out --e 1 --retry-failed").code, 6);
  EXPECT_EQ(ledger_lines("out", "begun").size(), 5U);
  EXPECT_EQ(tree(folder.path() / "out/cases"), before);
  // A file that has changed is another case.
  place("crown_36.stl", "bad.ply", 0);
  place("crown_36.stl", "missing.ply", 1);
  fs::remove(folder.path() / "arch/75.ply");
  place("crown_36.stl", "arch/36.ply", 7);
  EXPECT_EQ(run("batch manifest.csv -o out --e 1").code, 0);
  EXPECT_EQ(status("out")["done"], 4);
}

TEST_F(Batch, ACaseThatEndsTheProgramAgainAndAgainIsPassedOver) {
  place("crown_34.ply", "c.ply", 0);
  folder.write("manifest.csv", "scan,fdi\nc.ply,34\n");
  ASSERT_EQ(run("batch manifest.csv -o out --e 1").code, 0);
  const std::string begun = ledger_lines("out", "begun")[0].dump() + "\n";
  fs::remove_all(folder.path() / "out");
  fs::create_directories(folder.path() / "out/ledger");
  for (const char* run : {"a", "b", "c"}) {
    folder.write(fmt::format("out/ledger/1-of-1.{}.jsonl", run), begun);
  }
  const Outcome passed = run("batch manifest.csv -o out --e 1");
  EXPECT_EQ(passed.code, 6);
  EXPECT_NE(passed.error.find("3 times"), std::string::npos) << passed.error;
  EXPECT_EQ(run("batch manifest.csv -o out --e 1 --retry-failed").code, 0);
  EXPECT_EQ(run("batch manifest.csv -o out --e 1").code, 0);
}

TEST_F(Batch, SignalsEndItInOrder) {
  write_five_cases();
  const Outcome stopped = run("batch manifest.csv -o out --e 1 --threads 1", "timeout --preserve-status -s TERM 1.5");
  EXPECT_TRUE(stopped.code == 143 || stopped.code == 0) << stopped.code << stopped.error;
  if (stopped.out.find("stopped") != std::string::npos) {
    EXPECT_EQ(ledger_lines("out", "stopped").size(), 1U);
    EXPECT_GT(status("out")["remaining"], 0);
  }
  EXPECT_EQ(run("batch manifest.csv -o out --e 1").code, 0);
}

TEST_F(Batch, NothingTellsOfThePatient) {
  place("crown_34.ply", "Smith_Hans/Smith_Hans_34.ply", 0, {"patient Smith Hans, born 17-09-1970"});
  place("crown_34.ply", "Smith_Arch/Smith_34.ply", -7, {"Smith"});
  place("crown_36.stl", "Smith_Arch/Smith_36.ply", 7, {"Smith"});
  place("crown_36.stl", "Smith_Twice/Smith_36.ply", 7);
  place("crown_36.stl", "Smith_Twice/Smith_Hans_36.ply", 7);
  folder.write("Smith_bad.stl", "solid Smith\nfacet normal 0 0 1\nouter Smith\n");
  folder.write("Smith_empty.ply", "");
  folder.write("Smith.ply", read_all(folder.path() / "Smith_Hans/Smith_Hans_34.ply"));
  folder.write("Smith.json", "{\"id_patient\": \"Smith\", \"labels\": [11, 12], \"jaw\": \"upper\"}");
  folder.write("manifest.csv",
               "scan,fdi,labels\nSmith_Hans/Smith_Hans_34.ply,34,\nSmith_Hans/Smith_Hans_34.ply,?,\nSmith_Arch,,\n"
               "Smith_Twice,,\nSmith_bad.stl,36,\nSmith_empty.ply,36,\nSmith_missing.ply,36,\nSmith_missing,,\n"
               "Smith.ply,,Smith.json\nSmith.ply,,Smith_none.json\n");
  const Outcome done = run("batch manifest.csv -o out --e 1");
  EXPECT_EQ(done.code, 6);
  EXPECT_EQ(status("out")["done"], 3);
  std::map<std::string, std::string> all = tree(folder.path() / "out");
  all["what was printed"] = done.out + done.error;
  all["the status"] = run("batch status out --cases").out + run("batch status out --json").out;
  for (const auto& [name, text] : all)
    for (const char* planted : {"Smith", "Hans", "17-09-1970"}) {
      EXPECT_EQ(name.find(planted), std::string::npos) << name;
      EXPECT_EQ(text.find(planted), std::string::npos)
          << name << ": " << text.substr(text.find(planted) < 100 ? 0 : text.find(planted) - 100, 200);
    }
  const Outcome named = run("batch manifest.csv -o named --e 1 --keep-names");
  EXPECT_NE(named.error.find("Smith_Hans_36.ply"), std::string::npos) << named.error;
  EXPECT_EQ(status("named")["by_case"][0]["scan"], "Smith_Hans/Smith_Hans_34.ply");
}

TEST_F(Batch, ScansWithoutLabelsAreSearchedForTeeth) {
  const fs::path scan = fs::path(RHIZODONT_SOURCE_DIR) / "../shared/data/arches/scan_072_upper.ply";
  place("crown_34.ply", "lonely.ply", 0);
  folder.write("manifest.csv", "scan\nlonely.ply\n");
  const Outcome lonely = run("batch manifest.csv -o lonely --e 1");
  EXPECT_EQ(lonely.code, 6);
  EXPECT_NE(lonely.error.find("too small for a jaw"), std::string::npos) << lonely.error;
  if (!fs::exists(scan)) GTEST_SKIP() << "no labelled scans at " << scan;
  fs::copy_file(scan, folder.path() / "scan.ply");
  folder.write("manifest.csv", "scan\nscan.ply\n");
  run("batch manifest.csv -o out --e 1");
  const Json one = status("out")["by_case"][0];
  EXPECT_GE(one["teeth"], 12);
  EXPECT_GE(one["rooted"], 12);
  EXPECT_EQ(run("segment scan.ply -o found.json").code, 0);
  const Json found = Json::parse(read_all(folder.path() / "found.json"));
  const Json used = Json::parse(read_all(folder.path() / "out" / one["folder"].get<std::string>() / "labels.json"));
  EXPECT_EQ(used["labels"], found["labels"]);
}

TEST_F(Batch, WrongUseIsSaidInOneLine) {
  folder.write("manifest.csv", "scan,fdi\nc.ply,34\nd.ply,99\n");
  folder.write("good.csv", "scan,fdi\nc.ply,34\n");
  folder.write("file", "");
  expect_error("batch", 2, "MANIFEST");
  expect_error("batch good.csv", 2, "-o");
  expect_error("batch none.csv -o out", 3, "manifest");
  expect_error("batch manifest.csv -o out", 3, "Line 3, column fdi");
  expect_error("batch good.csv -o out --shard 3/2", 2, "--shard");
  expect_error("batch good.csv -o out --unit mile", 2, "mile");
  expect_error("batch good.csv -o out --e 9", 2, "0.2 to 2");
  expect_error("batch good.csv -o out --clearance 4", 2, "clearance");
  expect_error("batch good.csv -o file", 7, "file/ledger");
  expect_error("batch status out", 3, "no ledger");
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
  const Outcome gaps = run("batch good.csv -o out",
                           "env SLURM_ARRAY_TASK_ID=4 SLURM_ARRAY_TASK_MIN=1 "
                           "SLURM_ARRAY_TASK_MAX=4 SLURM_ARRAY_TASK_COUNT=3");
  EXPECT_EQ(gaps.code, 2);
  EXPECT_NE(gaps.error.find("--shard"), std::string::npos) << gaps.error;
}

}  // namespace
}  // namespace rhizodont::test
