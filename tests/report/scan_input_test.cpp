// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/scan_input.hpp"

#include "common/temporary_folder.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

using test::TemporaryFolder;

TEST(ToothInName, IsFoundInEveryWayOfNumbering) {
  const std::vector<std::pair<const char*, int>> names{{"crown_36.ply", 36},    {"36.stl", 36},
                                                       {"patient_UR1.stl", 11}, {"LL6.obj", 36},
                                                       {"ul8.ply", 28},         {"LR2 crown.stl", 42},
                                                       {"scan_id_3.vtk", 16},   {"x_id_32.vtk", 48},
                                                       {"crown_55.ply", 55},    {"2026-11-27_crown_36.stl", 36}};
  for (const auto& [name, fdi] : names) EXPECT_EQ(tooth_in_name(name), std::optional(fdi)) << name;
}

TEST(ToothInName, IsNotGuessed) {
  for (const char* name : {"crown.ply", "crown_19.ply", "36_or_37.stl", "scan_id_33.vtk", "136.stl", "gum.ply"})
    EXPECT_FALSE(tooth_in_name(name)) << name;
}

TEST(RootLengths, AreReadWithHeadingRemarksAndEitherSeparator) {
  const auto lengths = read_root_lengths("tooth,mm\r\n# upper\n36,14.2\n\n 11 ; 13\n");
  EXPECT_EQ(lengths, (std::map<int, double>{{36, 14.2}, {11, 13}}));
}

TEST(RootLengths, WhatIsNoneIsRefusedByItsLine) {
  for (const auto& [text, line] : std::vector<std::pair<std::string, std::string>>{{"36,14\n36,13\n", "Line 2"},
                                                                                   {"36,14\nabc\n", "Line 2"},
                                                                                   {"19,14\n", "Line 1"},
                                                                                   {"36,-4\n", "Line 1"},
                                                                                   {"36\n", "Line 1"}}) {
    try {
      read_root_lengths(text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(line), std::string::npos) << error.what();
    }
  }
}

TEST(RootLengths, LongLinesAndNumbersBeyondAllAreNoTrouble) {
  const std::string many(1'000'000, 'a');
  EXPECT_EQ(read_root_lengths("#" + many + "\n36,14.2\n"), (std::map<int, double>{{36, 14.2}}));
  EXPECT_EQ(read_root_lengths(std::string(1'000'000, ' ') + "36 14.2"), (std::map<int, double>{{36, 14.2}}));
  for (const std::string& text : {"36," + std::string(1'000'000, '9'), "11" + many, std::string("36,1.2.3"),
                                  std::string("36,.5"), std::string("3614"), std::string("36,5.")})
    EXPECT_THROW(read_root_lengths(text), InputError) << text.substr(0, 20);
}

/// Two domes of 8 mm beside a plane of gum, and their labels per vertex.
struct MadeScan {
  std::string obj;
  std::vector<int> labels;
  std::string json() const {
    std::string text = R"({"id_patient": "Doe", "jaw": "lower", "labels": [)";
    for (std::size_t i = 0; i < labels.size(); ++i) text += (i ? "," : "") + std::to_string(labels[i]);
    return text + "]}";
  }
};

MadeScan made_scan() {
  MadeScan scan;
  constexpr int columns = 41, rows = 21;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double x = 0.5 * c, y = 0.5 * r;
      double z = 0;
      int label = 0;
      for (const auto& [middle, fdi] : {std::pair(5.0, 36), std::pair(14.5, 37)}) {
        const double away = std::hypot(x - middle, y - 5);
        if (away < 4) z = 7 * std::sqrt(1 - away * away / 16), label = fdi;
      }
      scan.obj += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
      scan.labels.push_back(label);
    }
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      const int v = r * columns + c + 1;
      scan.obj += "f " + std::to_string(v) + " " + std::to_string(v + 1) + " " + std::to_string(v + columns + 1) + " " +
                  std::to_string(v + columns) + "\n";
    }
  return scan;
}

TEST(ReadScan, FindsLabelsBesideTheScanOrWhereItIsTold) {
  const TemporaryFolder folder;
  const MadeScan made = made_scan();
  const auto scan = folder.write("scan.obj", made.obj);
  EXPECT_THROW(read_scan(scan), InputError);  // nothing tells
  ScanLabelSource search;
  search.numbers = LabelNumbers::universal;  // of labels in files: what was found is FDI
  search.jaw = Jaw::lower;
  search.find = [&](const TriangleMesh& mesh, const SegmentOptions& options) {
    EXPECT_EQ(options.jaw, Jaw::lower);
    EXPECT_EQ(options.millimetres_per_unit, 1.5);
    SegmentedScan found;
    found.fdi = made.labels;
    found.teeth = {{36, 0.9, {}, 0, mesh.vertices.front(), 1}, {37, 0.8, {}, 0, mesh.vertices.front(), 1}};
    found.jaw_reason = "It was told.";
    return found;
  };
  const ScanInput searched = read_scan(scan, search, 1.5);
  EXPECT_EQ(searched.scan.fdi, made.labels);
  EXPECT_EQ(searched.found.size(), 2U);
  EXPECT_EQ(searched.notes.front(), "It was told.");
  folder.write("scan.json", made.json());
  const ScanInput beside = read_scan(scan);
  EXPECT_EQ(beside.scan.fdi, made.labels);
  EXPECT_EQ(files_of_scan(scan, {}).size(), 2U);
  for (const std::string& note : beside.notes) EXPECT_EQ(note.find("Doe"), std::string::npos) << note;
  ScanLabelSource told;
  told.labels = folder.write("other.json", made.json());
  EXPECT_EQ(read_scan(scan, told).scan.fdi, made.labels);
  told.array = "Label";
  EXPECT_THROW(read_scan(scan, told), UsageError);  // two sources
}

TEST(ReadScan, OtherNumbersGiveTheSameTeeth) {
  const TemporaryFolder folder;
  MadeScan made = made_scan();
  const std::vector<int> fdi = made.labels;
  for (int& label : made.labels) label = label == 36 ? 19 : label == 37 ? 18 : 33;
  ScanLabelSource source;
  source.labels = folder.write("universal.json", made.json());
  source.numbers = LabelNumbers::universal;
  EXPECT_EQ(read_scan(folder.write("scan.obj", made.obj), source).scan.fdi, fdi);
}

TEST(ReadScan, RefusesLabelsThatAreNone) {
  const TemporaryFolder folder;
  const MadeScan made = made_scan();
  const auto scan = folder.write("scan.obj", made.obj);
  MadeScan shorter = made, unknown = made;
  shorter.labels.pop_back();
  for (int& label : unknown.labels) label = label == 36 ? 99 : label;
  MadeScan empty = made;
  std::fill(empty.labels.begin(), empty.labels.end(), 0);
  for (const std::string& text :
       {shorter.json(), unknown.json(), empty.json(), std::string("[1,2]"), std::string(), std::string("{}")}) {
    ScanLabelSource source;
    source.labels = folder.write("labels.json", text);
    EXPECT_THROW(read_scan(scan, source), InputError) << text.substr(0, 60);
  }
}

TEST(ReadScan, TakesAFolderOfCrowns) {
  const TemporaryFolder folder;
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  folder.write("crown_36.obj", triangle);
  folder.write("LL7.obj", triangle);
  folder.write("notes.txt", "not a crown");
  folder.write("gum.obj", triangle);
  const ScanInput input = read_scan(folder.path());
  EXPECT_EQ(input.scan.mesh.triangles.size(), 2U);
  EXPECT_EQ(input.scan.fdi.size(), 6U);
  EXPECT_EQ(std::count(input.scan.fdi.begin(), input.scan.fdi.end(), 37), 3);
  folder.write("36.obj", triangle);
  EXPECT_THROW(read_scan(folder.path()), InputError);  // 36 twice
  const TemporaryFolder empty;
  EXPECT_THROW(read_scan(empty.path()), InputError);
}

}  // namespace
}  // namespace rhizodont
