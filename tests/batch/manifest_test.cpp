// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/manifest.hpp"
#include "batch/csv.hpp"
#include "batch/shard.hpp"
#include "report/without_names.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace rhizodont {
namespace {

using Fields = std::vector<std::string>;

std::string said_of(const std::string& manifest) {
  try {
    read_manifest(manifest, "/data");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void expect_fault(const std::string& manifest, const std::vector<std::string>& words) {
  const std::string said = said_of(manifest);
  for (const std::string& word : words)
    EXPECT_NE(said.find(word), std::string::npos) << manifest << "\n" << said << "\nshould hold: " << word;
}

TEST(Csv, ReadsWhatTheStandardAllows) {
  const auto records = read_csv(
      "\xEF\xBB\xBF"
      "a,b\r\n\"x, \"\"y\"\"\",\"two\r\nlines\"\n\n,\rlast,",
      ',');
  ASSERT_EQ(records.size(), 4U);
  EXPECT_EQ(records[0].fields, (Fields{"a", "b"}));
  EXPECT_EQ(records[1].fields, (Fields{"x, \"y\"", "two\nlines"}));
  EXPECT_EQ(records[1].line, 2);
  EXPECT_EQ(records[2].fields, (Fields{"", ""}));
  EXPECT_EQ(records[2].line, 5);
  EXPECT_EQ(records[3].fields, (Fields{"last", ""}));
  EXPECT_EQ(records[3].line, 6);
}

TEST(Csv, SaysOnWhichLineItIsBroken) {
  for (const auto& [text, words] :
       std::map<std::string, std::string>{{"a\nb\"c", "Line 2: a quote stands inside"},
                                          {"a\n\"b\"c", "Line 2: text follows the quote"},
                                          {"a\n\"b\n\n", "Line 2: a quote is opened"},
                                          {"a\nb\xE4\n", "Line 2: this is no text in UTF-8"},
                                          {std::string("a\0b", 3), "Line 1: this is no text in UTF-8"}}) {
    try {
      read_csv(text, ',');
      FAIL() << text;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(words, 0), 0U) << error.what();
    }
  }
}

TEST(Manifest, ReadsEveryColumn) {
  const BatchManifest manifest = read_manifest(
      "scan,labels,label_array,palette,labels_are,jaw,fdi,root_lengths,unit,id\n"
      "a.ply,a.json,,,FDI,upper,,36=14.2 11=13,cm,A-1\n"
      "/abs/b.stl,,,,,,36,14.5,,\n"
      "\"c, d.stl\",,,,,,?,,,\n"
      "e.vtp,,Label,,,,,,,\n",
      "/data");
  ASSERT_EQ(manifest.cases.size(), 4U);
  const BatchCase &arch = manifest.cases[0], &crown = manifest.cases[1], &guessed = manifest.cases[2];
  EXPECT_EQ(arch.scan, "/data/a.ply");
  EXPECT_EQ(arch.labels.labels, "/data/a.json");
  EXPECT_EQ(arch.labels.numbers, LabelNumbers::fdi);
  EXPECT_EQ(arch.labels.jaw, Jaw::upper);
  EXPECT_EQ(arch.root_lengths, (std::map<int, double>{{11, 13}, {36, 14.2}}));
  EXPECT_EQ(arch.millimetres_per_unit, 10);
  EXPECT_EQ(arch.id, "A-1");
  EXPECT_FALSE(arch.is_crown);
  EXPECT_EQ(crown.scan, "/abs/b.stl");
  EXPECT_TRUE(crown.is_crown);
  EXPECT_EQ(crown.fdi, 36);
  EXPECT_EQ(crown.root_length, 14.5);
  EXPECT_EQ(crown.id, "2");
  EXPECT_EQ(guessed.scan, "/data/c, d.stl");
  EXPECT_TRUE(guessed.is_crown);
  EXPECT_FALSE(guessed.fdi);
  EXPECT_EQ(manifest.cases[3].labels.array, "Label");
  EXPECT_EQ(read_manifest("scan;fdi\na.stl;36\n", "").cases.front().fdi, 36);
}

TEST(Manifest, SaysWhatIsWrongOnWhichLine) {
  expect_fault("", {"empty"});
  expect_fault("scan\n", {"no case"});
  expect_fault("file,fdi\na,36\n", {"Line 1, column 1", "scan, labels"});
  expect_fault("labels,fdi\na,36\n", {"none is scan"});
  expect_fault("scan,fdi,fdi\na,36,36\n", {"two columns fdi"});
  expect_fault("scan,fdi\na\n", {"Line 2: it has 1 fields", "2 columns"});
  expect_fault("scan,fdi\na,36\n,36\n", {"Line 3, column scan"});
  expect_fault("scan,fdi\na,19\n", {"Line 2, column fdi"});
  expect_fault("scan,fdi,labels\na,36,b\n", {"Line 2, column fdi", "single crown"});
  expect_fault("scan,labels,palette\na,b,c\n", {"Line 2: labels come from one place"});
  expect_fault("scan,labels_are\na,roman\n", {"Line 2, column labels_are"});
  expect_fault("scan,jaw\na,left\n", {"Line 2, column jaw"});
  expect_fault("scan,first_label\na,up\n", {"Line 2, column first_label"});
  expect_fault("scan,unit\na,mile\n", {"Line 2, column unit"});
  expect_fault("scan,root_lengths\na,14\n", {"Line 2, column root_lengths", "36=14.2"});
  expect_fault("scan,root_lengths\na,36=14 36=15\n", {"Line 2, column root_lengths", "two lengths"});
  expect_fault("scan,root_lengths\na,36=140\n", {"Line 2, column root_lengths"});
  expect_fault("scan,root_lengths,fdi\na,35=14,36\n", {"another tooth's"});
  expect_fault("scan,id\na,x\nb,\nc,x\n", {"Line 4, column id: it is that of line 2"});
  expect_fault("scan,id\na,Hans Smith\n", {"Line 2, column id"});
  expect_fault("scan,id\na,2\nb,\n", {"Line 3, column id"});  // the second case's number
  expect_fault("scan,fdi\n,99\nb\n", {"Line 2, column scan", "Line 2, column fdi", "Line 3"});
}

TEST(Manifest, QuotesNoCell) {
  const std::string said =
      said_of("scan,fdi,unit,jaw,labels_are,root_lengths,id\na,Smith,Smith,Smith,Smith,Smith,Smith Hans\n");
  EXPECT_FALSE(said.empty());
  EXPECT_EQ(said.find("Smith"), std::string::npos) << said;
}

TEST(Shard, EachCaseBelongsToOne) {
  for (const std::size_t count : {1U, 2U, 3U, 7U})
    for (std::size_t place = 0; place < 50; ++place) {
      int holders = 0;
      for (std::size_t index = 0; index < count; ++index) holders += BatchShard{index, count}.holds(place);
      EXPECT_EQ(holders, 1);
    }
  EXPECT_EQ(read_shard("3/8"), (BatchShard{2, 8}));
  for (const char* wrong : {"", "3", "0/2", "3/2", "1/0", "a/2", "1/2/3", "-1/2", "1 / 2"})
    EXPECT_THROW(read_shard(wrong), UsageError) << wrong;
}

BatchShard shard_in(std::map<std::string, std::string> variables) {
  return shard_of_environment([variables = std::move(variables)](const char* name) {
    const auto found = variables.find(name);
    return found == variables.end() ? std::nullopt : std::optional(found->second);
  });
}

TEST(Shard, ComesFromTheScheduler) {
  EXPECT_EQ(shard_in({}), (BatchShard{0, 1}));
  EXPECT_EQ(shard_in({{"SLURM_ARRAY_TASK_ID", "5"},
                      {"SLURM_ARRAY_TASK_MIN", "1"},
                      {"SLURM_ARRAY_TASK_MAX", "9"},
                      {"SLURM_ARRAY_TASK_STEP", "2"},
                      {"SLURM_ARRAY_TASK_COUNT", "5"}}),
            (BatchShard{2, 5}));
  // 1, 2 and 4: which of three a task is, its number does not say
  for (const char* id : {"1", "2", "4"})
    EXPECT_THROW(shard_in({{"SLURM_ARRAY_TASK_ID", id},
                           {"SLURM_ARRAY_TASK_MIN", "1"},
                           {"SLURM_ARRAY_TASK_MAX", "4"},
                           {"SLURM_ARRAY_TASK_COUNT", "3"}}),
                 UsageError)
        << id;
  EXPECT_EQ(shard_in({{"JOB_COMPLETION_INDEX", "3"}, {"JOB_COMPLETIONS", "4"}}), (BatchShard{3, 4}));
  EXPECT_THROW(shard_in({{"JOB_COMPLETION_INDEX", "3"}}), UsageError);
  EXPECT_THROW(shard_in({{"JOB_COMPLETION_INDEX", "4"}, {"JOB_COMPLETIONS", "4"}}), UsageError);
}

TEST(WithoutNames, LeavesNeitherPathsNorWordsOfFiles) {
  const std::vector<std::filesystem::path> files{"in/Smith Hans/Smith_Hans.stl", "in/36", "arch"};
  EXPECT_EQ(without_names("in/Smith Hans/Smith_Hans.stl: line 2: 'facet' is expected, 'Hans' was found", files),
            "the file: line 2: 'facet' is expected, a word was found");
  EXPECT_EQ(without_names("Smith_Hans.stl and another", files), "the file and another");
  EXPECT_EQ(without_names("Tooth 36 is the tooth's, in/36 is not.", files),
            "Tooth 36 is the tooth's, the file is not.");
  EXPECT_EQ(without_names("arch has no crown; it is no arch [arch]", files),
            "the file has no crown; it is no arch [the file]");
}

}  // namespace
}  // namespace rhizodont
