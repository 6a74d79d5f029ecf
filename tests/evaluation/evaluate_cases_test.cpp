// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/evaluate_cases.hpp"

#include "evaluation/made_teeth.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/evaluate.hpp"
#include "rhizodont/io.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

class EvaluateCases : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("rhizodont_cases_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const TriangleMesh& mesh) {
    MeshFile file;
    file.mesh = test::as_float(mesh);
    save_mesh(folder_ / name, file);
  }
  void write_case(const std::string& number, const TriangleMesh& tooth) {
    write("crown_" + number + ".ply", test::crown_of(tooth));
    write("tooth_" + number + ".ply", tooth);
  }

  fs::path folder_;
};

NamedPredictor always(const TriangleMesh& tooth) {
  return {"always", [tooth](const TriangleMesh&, int) { return ToothPrediction{tooth, {}, 0, {}}; }};
}

TEST_F(EvaluateCases, FindsPairsByNumber) {
  write_case("46", test::two_rooted());
  write_case("11", test::one_rooted());
  std::ofstream(folder_ / "crown_notes.txt") << "not a mesh";
  const auto cases = find_evaluation_cases(folder_);
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_EQ(cases[0].fdi, 11);
  EXPECT_EQ(cases[1].fdi, 46);
  EXPECT_EQ(cases[1].truth.filename(), "tooth_46.ply");
}

TEST_F(EvaluateCases, SeveralTeethOfANumberHaveNames) {
  write_case("36_old", test::two_rooted());
  write_case("36_young", test::two_rooted());
  const auto cases = find_evaluation_cases(folder_);
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_EQ(cases[0].fdi, 36);
  EXPECT_EQ(cases[0].name, "old");
  EXPECT_EQ(cases[1].truth.filename(), "tooth_36_young.ply");
  write_case("367", test::one_rooted());
  EXPECT_THROW(find_evaluation_cases(folder_), InputError);
}

TEST_F(EvaluateCases, NamesThatAreNoUtf8DoNotStandInTheWay) {
  write("crown_36_\xff.ply", test::two_rooted());  // closed, so that it is refused at once
  write("tooth_36_\xff.ply", test::two_rooted());
  const CompletionModels models = CompletionModels::load(fs::path(RHIZODONT_SOURCE_DIR) / "models");
  const auto figures = nlohmann::json::parse(evaluate_to_json(folder_, models));
  EXPECT_NE(figures.dump().find("\xef\xbf\xbd"), std::string::npos) << figures;
}

TEST_F(EvaluateCases, FolderThatIsNoSetOfCasesIsRefused) {
  EXPECT_THROW(find_evaluation_cases(folder_ / "nowhere"), InputError);
  EXPECT_THROW(find_evaluation_cases(folder_), InputError);
  write("crown_36.ply", test::crown_of(test::two_rooted()));
  EXPECT_THROW(find_evaluation_cases(folder_), InputError);  // no tooth beside it
  write("tooth_36.ply", test::two_rooted());
  EXPECT_EQ(find_evaluation_cases(folder_).size(), 1u);
  write("tooth_36.stl", test::two_rooted());
  EXPECT_THROW(find_evaluation_cases(folder_), InputError);  // which one?
  fs::remove(folder_ / "tooth_36.stl");
  write_case("59", test::one_rooted());
  EXPECT_THROW(find_evaluation_cases(folder_), InputError);
}

TEST_F(EvaluateCases, FailuresAreRowsWithAReason) {
  write_case("11", test::one_rooted());
  write_case("36", test::two_rooted());
  std::ofstream(folder_ / "crown_21.ply") << "ply\nformat nonsense";
  write("tooth_21.ply", test::one_rooted());
  const NamedPredictor picky{"picky", [](const TriangleMesh&, int fdi) -> ToothPrediction {
                               if (fdi == 36) throw NoResultError("molars are too hard");
                               return {test::one_rooted(), {}, 0, {}};
                             }};
  std::vector<std::string> progress;
  const Evaluation evaluation =
      evaluate_cases(find_evaluation_cases(folder_), {picky, always(test::two_rooted())}, {},
                     [&](const EvaluationCase& files, std::size_t place, const std::string& name) {
                       progress.push_back(std::to_string(place) + " " + std::to_string(files.fdi) + " " + name);
                     });
  ASSERT_EQ(evaluation.cases.size(), 3u);
  EXPECT_TRUE(evaluation.has_failures());
  EXPECT_TRUE(evaluation.cases[0].outcomes[0].figures);
  EXPECT_FALSE(evaluation.cases[1].outcomes[0].figures);
  EXPECT_FALSE(evaluation.cases[1].outcomes[0].failure.empty());
  EXPECT_EQ(evaluation.cases[2].outcomes[0].failure, "molars are too hard");
  EXPECT_EQ(evaluation.cases[2].outcomes[1].figures->root_f_score > 0.99, true);
  EXPECT_EQ(progress, (std::vector<std::string>{"0 11 picky", "0 11 always", "2 36 picky", "2 36 always"}));

  EXPECT_EQ(mean_figures(evaluation, 0).teeth, 1);
  EXPECT_EQ(mean_figures(evaluation, 1).teeth, 2);
  EXPECT_EQ(mean_figures(evaluation, 1, MeanOver::completed_by_all).teeth, 1);
  EXPECT_EQ(mean_figures(evaluation, 1, MeanOver::completed_by_all).apex_distance_mm,
            evaluation.cases[0].outcomes[1].figures->apex_distance_mm);
  const std::string csv = evaluation_csv(evaluation);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  EXPECT_NE(csv.find("36,\"\",\"picky\",,,,,,,,,,,,,,,\"molars are too hard\""), std::string::npos);
  const std::string header = csv.substr(0, csv.find('\n')),
                    row = csv.substr(header.size() + 1, csv.find('\n', header.size() + 1) - header.size() - 1);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));

  const nlohmann::ordered_json json(evaluation);
  EXPECT_TRUE(json["cases"][2]["outcomes"]["picky"]["figures"].is_null());
  EXPECT_EQ(json["cases"][2]["outcomes"]["always"]["figures"]["true_roots"], 2);
  EXPECT_EQ(json["means"]["picky"]["teeth"], 1);
  EXPECT_EQ(json["cases"][0]["crown"], "crown_11.ply");
}

TEST_F(EvaluateCases, WrongUsageIsNotARow) {
  write_case("11", test::one_rooted());
  const NamedPredictor misused{
      "misused", [](const TriangleMesh&, int) -> ToothPrediction { throw UsageError("e is out of range"); }};
  EXPECT_THROW(evaluate_cases(find_evaluation_cases(folder_), {misused}), UsageError);
}

TEST_F(EvaluateCases, MeansTakeAbsoluteLengthErrors) {
  Evaluation evaluation;
  evaluation.predictors = {"made up"};
  for (const double error : {-1.0, 3.0}) {
    RootFigures figures;
    figures.root_length_error_mm = error;
    figures.apex_distance_mm = 2 + error;
    figures.true_apices.resize(2);
    figures.predicted_apices.resize(error > 0 ? 2 : 1);
    evaluation.cases.push_back({{}, {{figures, std::nullopt, "", 0}}});
  }
  const MeanFigures means = mean_figures(evaluation, 0);
  EXPECT_EQ(means.teeth, 2);
  EXPECT_EQ(means.root_length_abs_error_mm, 2);
  EXPECT_EQ(means.root_length_bias_mm, 1);
  EXPECT_EQ(means.apex_distance_mm, 3);
  EXPECT_EQ(means.right_root_counts, 1);
  EXPECT_FALSE(evaluation.has_failures());
}

TEST(CbctNoiseText, NamesLimitsAndSource) {
  const std::string line = describe(CbctNoise{});
  EXPECT_NE(line.find("-1.23 to +1.18 mm"), std::string::npos);
  EXPECT_NE(line.find("synapse.koreamed.org/articles/1081059"), std::string::npos);
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace rhizodont
