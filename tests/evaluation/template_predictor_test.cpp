// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/template_predictor.hpp"

#include "evaluation/made_teeth.hpp"
#include "evaluation/predictors.hpp"
#include "evaluation/root_figures.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.2, Eigen::Vector3d(3, -1, 2).normalized()).toRotationMatrix();

Point moved(const Point& p) { return turn * (1.13 * p) + Point(20, -30, 5); }

double largest_distance(const TriangleMesh& a, const TriangleMesh& b) {
  double largest = 0;
  for (std::size_t v = 0; v < a.vertices.size(); ++v)
    largest = std::max(largest, (a.vertices[v] - b.vertices[v]).norm());
  return largest;
}

/// A crown that no turn but the full one maps to itself.
TriangleMesh lopsided_tooth() {
  return test::changed(test::two_rooted(), [](Point p) {
    if (p.z() > 0) p.z() += 0.8 * std::exp(-(p - Point(2, 1, p.z())).squaredNorm()) * (p.z() > 1 ? 1 : p.z());
    p.x() *= p.y() > 0 ? 1.15 + 0.02 * p.y() : 1.15;
    return p;
  });
}

TemplateTooth as_template(const TriangleMesh& tooth, const TriangleMesh& crown) {
  return {tooth, crown, crown_growth_axis(crown)};
}

TEST(TemplatePredictor, RecoversASimilarity) {
  const TriangleMesh tooth = lopsided_tooth(), crown = test::crown_of(test::two_rooted());
  TriangleMesh own_crown = crown;  // the same triangles of the lopsided tooth
  own_crown = test::crown_of(tooth);
  const TriangleMesh fitted = fit_template(test::changed(own_crown, moved), as_template(tooth, own_crown));
  ASSERT_EQ(fitted.triangles, tooth.triangles);
  EXPECT_LT(largest_distance(fitted, test::changed(tooth, moved)), 0.15);
}

TEST(TemplatePredictor, IsTheSameEveryTime) {
  const TriangleMesh tooth = lopsided_tooth(), crown = test::crown_of(tooth);
  TemplateFitOptions quick;
  quick.iterations = 3;
  quick.samples = 200;
  const TriangleMesh one = fit_template(test::changed(crown, moved), as_template(tooth, crown), quick);
  const TriangleMesh two = fit_template(test::changed(crown, moved), as_template(tooth, crown), quick);
  EXPECT_EQ(one.vertices, two.vertices);
}

/// Writes a template file into a folder of its own, removed at the end.
class TemplateFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("rhizodont_templates_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const TriangleMesh& tooth, bool labelled) {
    MeshFile file;
    file.mesh = test::as_float(tooth);
    if (labelled) {
      VertexAttribute crown{AttributeType::uint8, {}};
      for (const Point& p : tooth.vertices) crown.values.push_back(p.z() >= 0 ? 1 : 0);
      file.vertex_attributes["crown"] = crown;
    }
    save_mesh(folder_ / name, file);
  }

  fs::path folder_;
};

TEST_F(TemplateFolder, RightTeethAreMirroredAndStayOutward) {
  write("tooth_36.ply", lopsided_tooth(), true);
  const TemplateTooth left = load_template_tooth(folder_, 36), right = load_template_tooth(folder_, 46);
  ASSERT_EQ(left.mesh.vertices.size(), right.mesh.vertices.size());
  EXPECT_NEAR(volume(left.mesh), volume(right.mesh), 1e-9);
  EXPECT_GT(volume(right.mesh), 0);
  EXPECT_EQ(left.mesh.vertices[7].x(), -right.mesh.vertices[7].x());
  EXPECT_EQ(left.mesh.vertices[7].z(), right.mesh.vertices[7].z());
  EXPECT_GT(left.axis.z(), 0.9);
  EXPECT_GT(right.axis.z(), 0.9);
  EXPECT_EQ(left.crown.triangles.size(), right.crown.triangles.size());
  EXPECT_LT(left.crown.triangles.size(), left.mesh.triangles.size());
}

TEST_F(TemplateFolder, CrownOfAnUnlabelledToothIsItsWiderEnd) {
  write("tooth_21.ply", test::one_rooted(), false);
  const TemplateTooth tooth = load_template_tooth(folder_, 21);
  EXPECT_GT(tooth.axis.z(), 0.8);
  for (const Triangle& t : tooth.crown.triangles)
    for (const int v : t) EXPECT_GT(tooth.crown.vertices[static_cast<std::size_t>(v)].z(), -4);
}

TEST_F(TemplateFolder, BadInputIsRefused) {
  EXPECT_THROW(load_template_tooth(folder_, 36), InputError);
  EXPECT_THROW(load_template_tooth(folder_, 19), UsageError);
  EXPECT_THROW(load_template_tooth(folder_, 55), UsageError);
  const TriangleMesh tooth = lopsided_tooth(), crown = test::crown_of(tooth);
  EXPECT_THROW(fit_template(tooth, as_template(tooth, crown)), InputError);  // closed: no border
  TemplateFitOptions none;
  none.iterations = 0;
  EXPECT_THROW(fit_template(crown, as_template(tooth, crown), none), UsageError);
}

TEST(TemplatePredictor, RecoversAMovedTemplateOfARealTooth) {
  const fs::path folder = test::shared_folder() / "data/templates";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  TemplateFitOptions to_the_end;
  to_the_end.iterations = 100;
  to_the_end.samples = 800;
  for (const int fdi : {23, 46}) {
    const TemplateTooth tooth = load_template_tooth(folder, fdi);
    const TriangleMesh fitted = fit_template(test::changed(tooth.crown, moved), tooth, to_the_end);
    EXPECT_LT(largest_distance(fitted, test::changed(tooth.mesh, moved)), 0.2) << fdi;
  }
}

TEST(TemplatePredictor, AFolderThatIsNotThereIsNoticedBeforeTheFirstTooth) {
  EXPECT_THROW(template_predictor("nowhere"), InputError);
}

TEST(TemplatePredictor, IsAboutAsGoodAsKnownOnRealTeeth) {
  const fs::path data = test::shared_folder() / "data";
  if (!fs::exists(data / "templates") || !fs::exists(data / "validation")) GTEST_SKIP() << "no data in " << data;
  double length_error = 0;
  const std::vector<int> teeth{33, 36, 45};
  for (const int fdi : teeth) {
    const std::string file = std::to_string(fdi) + ".ply";
    const TriangleMesh crown = load_mesh(data / "validation" / ("crown_" + file)).mesh;
    const TriangleMesh truth = load_mesh(data / "validation" / ("tooth_" + file)).mesh;
    const TriangleMesh fitted = fit_template(crown, load_template_tooth(data / "templates", fdi));
    const RootFigures f = root_figures(crown, truth, fitted, crown_growth_axis(crown));
    EXPECT_LT(f.root_chamfer_mm, 0.9) << fdi;
    EXPECT_GT(f.f_score, 0.3) << fdi;
    length_error += std::abs(f.root_length_error_mm) / static_cast<double>(teeth.size());
  }
  EXPECT_LT(length_error, 2);
}

}  // namespace
}  // namespace rhizodont
