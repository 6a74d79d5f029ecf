// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/ledger.hpp"
#include "batch/case_folders.hpp"
#include "batch/status.hpp"
#include "common/temporary_folder.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::TemporaryFolder;

Json event(const char* name) { return {{"event", name}}; }

void append_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::app | std::ios::binary) << text;
}

fs::path write_ledger(const TemporaryFolder& folder, const std::string& run, const std::vector<Json>& lines) {
  fs::create_directories(folder.path() / "ledger");
  const fs::path file = folder.path() / "ledger" / (run + ".jsonl");
  for (const Json& line : lines) append_text(file, line.dump() + "\n");
  return file;
}

Json run_line(double time, int shard, int shards, int cases, const char* batch = "b") {
  return {{"event", "run"},   {"batch", batch}, {"shard", shard},
          {"shards", shards}, {"cases", cases}, {"cases_of_batch", 2 * cases},
          {"time", time}};
}

Json case_line(double time, const char* id, int code, const char* reason, double seconds = 10) {
  return {{"event", "case"},
          {"case", id},
          {"key", "k"},
          {"code", code},
          {"reason", reason},
          {"teeth", 14},
          {"rooted", code == 0 ? 14 : 0},
          {"from_before", false},
          {"seconds", seconds},
          {"time", time}};
}

TEST(Ledger, EachRunHasAFileOfItsOwn) {
  const TemporaryFolder folder;
  BatchLedger first(folder.path(), {0, 2}), second(folder.path(), {0, 2});
  first.append({event("run"), event("case")});
  second.append({event("run")});
  const auto files = read_ledgers(folder.path());
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].run.rfind("1-of-2.", 0), 0U);
  EXPECT_EQ(files[0].lines.size() + files[1].lines.size(), 3U);
  EXPECT_GT(number_in(files[0].lines[0], "time"), 1.7e9);
}

TEST(Ledger, ALineThatWasCutOffIsPassedOver) {
  const TemporaryFolder folder;
  const fs::path file = write_ledger(folder, "1-of-1.a", {event("run"), event("case")});
  for (const char* torn : {"{\"event\": \"ca", "{\"event\": \"case\"}"}) {  // the second lacks its end of line alone
    append_text(file, torn);
    const auto files = read_ledgers(folder.path());
    ASSERT_EQ(files.size(), 1U);
    EXPECT_EQ(files[0].lines.size(), 2U);
    EXPECT_EQ(files[0].unreadable, 1U);
    fs::remove(file);
    write_ledger(folder, "1-of-1.a", {event("run"), event("case")});
  }
  append_text(file, std::string("\0\0garbage\n", 10));
  append_text(file, event("finished").dump() + "\n");
  EXPECT_EQ(read_ledgers(folder.path()).front().lines.size(), 3U);
}

TEST(Ledger, APlaceThatCannotBeWrittenIsSaid) {
  const TemporaryFolder folder;
  folder.write("file", "");
  EXPECT_THROW(BatchLedger(folder.path() / "file", {}), OutputError);
}

TEST(Status, CountsWhatTheLatestRunsSay) {
  const TemporaryFolder folder;
  write_ledger(folder, "1-of-1.old", {run_line(1, 1, 1, 9, "other"), case_line(2, "9", 0, "")});
  write_ledger(folder, "1-of-2.a",
               {run_line(100, 1, 2, 4), case_line(110, "1", 3, "It is empty."),
                Json{{"event", "begun"}, {"case", "3"}, {"time", 111}}});  // was killed
  write_ledger(folder, "1-of-2.b",
               {run_line(120, 1, 2, 4), case_line(130, "1", 0, ""), case_line(150, "3", 0, "", 20),
                Json{{"event", "begun"}, {"case", "5"}, {"time", 150}}});
  write_ledger(
      folder, "2-of-2.a",
      {run_line(100, 2, 2, 4), Json{{"event", "tooth"}, {"case", "2"}, {"reason", "A milk tooth."}, {"time", 105}},
       case_line(105, "2", 6, "1 of 14 teeth has no root."), case_line(106, "4", 3, "It is empty.")});
  const BatchStatus status = batch_status(folder.path(), 160);
  EXPECT_EQ(status.cases, 8U);
  EXPECT_EQ(status.done, 2U);
  EXPECT_EQ(status.partial, 1U);
  EXPECT_EQ(status.failed, 1U);
  EXPECT_EQ(status.remaining(), 4U);
  EXPECT_EQ(status.running, 1U);
  ASSERT_EQ(status.shards.size(), 2U);
  EXPECT_EQ(status.shards[0].at, "5");
  EXPECT_EQ(status.shards[0].state, RunState::running);
  EXPECT_DOUBLE_EQ(*status.shards[0].seconds_left, 2 * 15.0);
  EXPECT_EQ(status.shards[1].dealt_with, 2U);
  ASSERT_EQ(status.reasons.size(), 2U);
  EXPECT_EQ(status.by_case.front().id, "1");
  EXPECT_EQ(batch_status(folder.path(), 5000).shards[0].state, RunState::silent);
  const Json json = batch_status_json(status);
  EXPECT_EQ(json.at("remaining"), 4);
  EXPECT_EQ(json.at("by_case").size(), 4U);
  EXPECT_EQ(duration_text(3 * 3600 + 61), "3 h 1 min");
}

TEST(Status, AFolderWithoutALedgerIsSaid) {
  const TemporaryFolder folder;
  EXPECT_THROW(batch_status(folder.path(), 0), InputError);
  EXPECT_THROW(batch_status(folder.path() / "none", 0), InputError);
}

TEST(CaseFolders, AreThereWholeOrNotAtAll) {
  const TemporaryFolder folder;
  BatchOutcome outcome;
  outcome.teeth = {{36, true, "", "tooth_36.ply", 12.25, 100, 99}, {75, false, "A milk tooth.", "", 0, 0, 0}};
  outcome.code = 6;
  outcome.reason = "1 of 2";
  outcome.files = {{"tooth_36.ply", "bytes"}};
  EXPECT_FALSE(find_case(folder.path(), "k"));
  place_case(folder.path(), "k", outcome, "1-of-1.a", false);
  const auto found = find_case(folder.path(), "k");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->code, 6);
  EXPECT_EQ(found->teeth[0].root_length_mm, 12.25);
  EXPECT_EQ(found->teeth[1].reason, "A milk tooth.");
  EXPECT_FALSE(find_case(folder.path(), "other"));
  place_case(folder.path(), "k", outcome, "1-of-1.b", false);  // another shard has done it too
  EXPECT_TRUE(find_case(folder.path(), "k"));
  fs::resize_file(folder.path() / "cases/k/tooth_36.ply", 2);  // no longer complete
  EXPECT_FALSE(find_case(folder.path(), "k"));
  place_case(folder.path(), "k", outcome, "1-of-1.c", false);
  EXPECT_EQ(test::read_all(folder.path() / "cases/k/tooth_36.ply"), "bytes");
  outcome.files = {{"tooth_36.ply", "others"}};
  place_case(folder.path(), "k", outcome, "1-of-1.d", true);
  EXPECT_EQ(test::read_all(folder.path() / "cases/k/tooth_36.ply"), "others");
  fs::create_directories(folder.path() / "unfinished/1-of-1.x/k");
  fs::create_directories(folder.path() / "unfinished/1-of-10.x/k");
  remove_unfinished(folder.path(), "1-of-1");
  EXPECT_FALSE(fs::exists(folder.path() / "unfinished/1-of-1.x"));
  EXPECT_TRUE(fs::exists(folder.path() / "unfinished/1-of-10.x"));
}

}  // namespace
}  // namespace rhizodont
