// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/similarity.hpp"
#include "families/one_template.hpp"
#include "families/register_tooth.hpp"
#include "families/registered_templates.hpp"
#include "families/template_families.hpp"
#include "mesh/geometry.hpp"

#include <Eigen/Geometry>

#include <fstream>
#include <numeric>
#include <vector>

namespace rhizodont::test {
namespace {

/// Whatever pose a scanner's software leaves a tooth in.
TriangleMesh moved(TriangleMesh mesh) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
  for (Point& p : mesh.vertices) p = turn * p + Point(40, -12, 7);
  return mesh;
}

class Registering : public OneTemplate {
 protected:
  static constexpr int fdi = 36;

  /// Not simplified, so that a family's vertices are the file's.
  ToothFamilies whole_families(const std::filesystem::path& registered = {}) const {
    FamilyLoadOptions options;
    options.types = {molar};
    options.vertices = own_template().mesh.vertices.size();
    options.registered = registered;
    return load_tooth_families(folder.path(), options);
  }

  static SyntheticTooth person(const ToothFamilies& families, std::uint64_t seed) {
    ToothVariation variation;
    variation.decay_share = variation.bracket_share = variation.deciduous_share = variation.open_apex_share = 0;
    return generate_tooth(families, molar, seed, variation);
  }

  std::array<TemplateFile, tooth_type_count> templates() const { return load_template_files(folder.path()); }

  std::string refusal_of(const TriangleMesh& tooth) const {
    try {
      register_tooth(tooth, fdi, templates());
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }
};

/// Distances of corresponding points once they are laid on each other as they are, turned and moved alone.
std::vector<double> distances_when_laid(const std::vector<Point>& points, const std::vector<Point>& on) {
  Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(points.size())), to(3, from.cols());
  for (std::size_t v = 0; v < points.size(); ++v) {
    from.col(static_cast<Eigen::Index>(v)) = points[v];
    to.col(static_cast<Eigen::Index>(v)) = on[v];
  }
  const Similarity map = similarity_of_pairs(from, to, {1, 1});
  std::vector<double> distances;
  for (Eigen::Index v = 0; v < from.cols(); ++v)
    distances.push_back((map.rotation * from.col(v) + map.shift - to.col(v)).norm());
  return distances;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST_F(Registering, FindsWhereEachPlaceOfTheTemplateLies) {
  const ToothFamilies families = whole_families();
  const auto files = templates();
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SyntheticTooth tooth = person(families, seed);
    ASSERT_EQ(tooth.mesh.vertices.size(), files[molar].mesh.vertices.size());
    const RegisteredTooth found = register_tooth(moved(tooth.mesh), fdi, files);
    EXPECT_LT(found.mean_mm, 0.05) << seed;
    EXPECT_LT(found.percentile_95_mm, 0.2) << seed;
    EXPECT_LT(found.mean_mm, 0.5 * found.rigid_mean_mm) << "bending brings it nearer";
    // The generator moved the template's vertices, so where each went is known.
    const std::vector<double> off = distances_when_laid(found.vertices, tooth.mesh.vertices);
    const std::vector<double> unbent = distances_when_laid(files[molar].mesh.vertices, tooth.mesh.vertices);
    RecordProperty("correspondence_um_" + std::to_string(seed), static_cast<int>(1000 * mean_of(off)));
    EXPECT_LT(mean_of(off), 0.8) << seed;
    EXPECT_LT(mean_of(off), 0.85 * mean_of(unbent)) << seed;
    for (const TemplateRoot& root : families.templates[molar].roots)
      EXPECT_LT(off[root.apex], 1.5) << "a root's tip, " << seed;
  }
}

TEST_F(Registering, TakesRightTeethMirroredAndInsideOut) {
  const auto files = templates();
  const TriangleMesh tooth = moved(person(whole_families(), 4).mesh);
  TriangleMesh right = tooth;  // mirrored, so its triangles face inward
  for (Point& p : right.vertices) p.x() = -p.x();
  const RegisteredTooth of_left = register_tooth(tooth, 36, files), of_right = register_tooth(right, 46, files);
  EXPECT_NEAR(of_left.mean_mm, of_right.mean_mm, 1e-9);
  for (std::size_t v = 0; v < of_left.vertices.size(); v += 50)
    EXPECT_LT((of_left.vertices[v] - of_right.vertices[v]).norm(), 1e-6);
}

TEST_F(Registering, RefusesWhatIsNoWholeTooth) {
  const TriangleMesh tooth = person(whole_families(), 5).mesh;
  TriangleMesh open = tooth, two = tooth, small = tooth;
  open.triangles.resize(open.triangles.size() - 40);
  EXPECT_NE(refusal_of(open).find("open"), std::string::npos) << refusal_of(open);
  for (const Point& p : tooth.vertices) two.vertices.push_back(p + Point(12, 0, 0));
  for (Triangle t : tooth.triangles) {
    for (std::int32_t& v : t) v += static_cast<std::int32_t>(tooth.vertices.size());
    two.triangles.push_back(t);
  }
  EXPECT_NE(refusal_of(two).find("pieces"), std::string::npos) << refusal_of(two);
  for (Point& p : small.vertices) p /= 1000;
  EXPECT_NE(refusal_of(small).find("unit"), std::string::npos) << refusal_of(small);
  EXPECT_NE(refusal_of({}).find("no surface"), std::string::npos);
  EXPECT_THROW(register_tooth(tooth, 75, templates()), UsageError) << "a milk tooth";
  // a ball is closed and as large as a tooth
  TriangleMesh ball = tooth;
  const Point middle = area_centroid(tooth);
  for (Point& p : ball.vertices) p = middle + 8 * (p - middle).normalized();
  EXPECT_NE(refusal_of(ball), "nothing was refused");
}

TEST_F(Registering, BecomesAFurtherTemplate) {
  const ToothFamilies before = whole_families();
  const auto files = templates();
  const std::filesystem::path registered = folder.path() / "registered";
  std::filesystem::create_directory(registered);
  const ToothFile source{folder.path() / "46_anna.stl", 46, "46_anna"};
  TriangleMesh right = moved(person(before, 6).mesh);
  for (Point& p : right.vertices) p.x() = -p.x();
  const RegisteredTooth tooth = register_tooth(right, 46, files);
  EXPECT_EQ(registered_name(source), "tooth_36_46_anna.ply");
  save_mesh(registered / registered_name(source), registered_file(tooth, files[molar], source));
  const ToothFamilies after = whole_families(registered);
  ASSERT_EQ(after.further.size(), 1U);
  ASSERT_EQ(after.loans.size(), before.loans.size() + 1);
  EXPECT_NEAR(after.loans.back().share, 0.5, 1e-12) << "as likely as the type's own";
  EXPECT_EQ(after.further[0].mesh.triangles, after.templates[molar].mesh.triangles);
  EXPECT_EQ(after.further[0].roots.size(), 2U);
  int differ = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const SyntheticTooth grown = person(after, seed);
    EXPECT_TRUE(grown.own_template);
    EXPECT_EQ(grown.mesh.triangles, after.templates[molar].mesh.triangles);
    differ += grown.mesh.vertices != person(before, seed).mesh.vertices ? 1 : 0;
  }
  EXPECT_GT(differ, 0);

  EXPECT_NO_THROW(require_growable(tooth, 46, files));
  RegisteredTooth folded = tooth;  // its roots pushed up through its crown
  const double z = area_centroid(files[molar].mesh).y();
  for (Point& p : folded.vertices)
    if (p.y() < z) p.y() = z + 1.5 * (z - p.y());
  EXPECT_THROW(require_growable(folded, 46, files), InputError);
  save_mesh(registered / "tooth_36_folded.ply", registered_file(folded, files[molar], source));
  EXPECT_THROW(whole_families(registered), InputError) << "as it says, none can be grown";
  std::filesystem::remove(registered / "tooth_36_folded.ply");

  MeshFile other = registered_file(tooth, files[molar], source);
  other.mesh.triangles.pop_back();
  save_mesh(registered / "tooth_36_other.ply", other);
  EXPECT_THROW(whole_families(registered), InputError) << "registered to another template";
  EXPECT_THROW(whole_families(folder.path() / "nowhere"), InputError);
  std::filesystem::create_directory(folder.path() / "empty");
  std::ofstream(folder.path() / "empty" / "tooth_36.ply") << "not registered, for it has no name";
  EXPECT_THROW(whole_families(folder.path() / "empty"), InputError);
}

TEST(ToothFiles, AreFoundByTheirNumbers) {
  const TemporaryFolder folder;
  EXPECT_THROW(find_tooth_files(folder.path()), InputError) << "none";
  for (const char* name : {"tooth_36.ply", "11.stl", "Tooth46_anna.obj", "notes.txt", "jaw.ply"})
    std::ofstream(folder.path() / name) << "x";
  const std::vector<ToothFile> files = find_tooth_files(folder.path());
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0].fdi, 11);
  EXPECT_EQ(files[1].fdi, 46);
  EXPECT_EQ(files[1].name, "46_anna");
  EXPECT_EQ(files[2].fdi, 36);
  EXPECT_THROW(find_tooth_files(folder.path(), {LabelNumbers::universal, std::nullopt}), InputError) << "no 46";
  std::filesystem::remove(folder.path() / "Tooth46_anna.obj");
  std::filesystem::rename(folder.path() / "tooth_36.ply", folder.path() / "tooth_19.ply");
  const std::vector<ToothFile> universal = find_tooth_files(folder.path(), {LabelNumbers::universal, std::nullopt});
  EXPECT_EQ(universal[0].fdi, 23);
  EXPECT_EQ(universal[1].fdi, 36);
  EXPECT_THROW(find_tooth_files(folder.path(), {LabelNumbers::arch14, std::nullopt}), UsageError) << "which jaw?";
  std::ofstream(folder.path() / "55.ply") << "x";
  EXPECT_THROW(find_tooth_files(folder.path()), InputError) << "a milk tooth";
}

using RegisteringPeople = TemplateFamilies;

TEST_F(RegisteringPeople, BringsTeethOfAPersonOntoTheTemplates) {
  const auto files = load_template_files(shared_data);
  for (const int fdi : {31, 45, 36}) {
    const std::filesystem::path path = shared_data / "validation" / ("tooth_" + std::to_string(fdi) + ".ply");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no teeth of a person in " << shared_data;
    const RegisteredTooth found = register_tooth(load_mesh(path).mesh, fdi, files);
    EXPECT_LT(found.mean_mm, 0.05) << fdi;
    EXPECT_LT(found.mean_mm, 0.5 * found.rigid_mean_mm) << fdi;
  }
  const TriangleMesh incisor = load_mesh(shared_data / "validation" / "tooth_31.ply").mesh;
  try {
    register_tooth(incisor, 36, files);
    ADD_FAILURE() << "an incisor passes for a molar";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("not a molar"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace rhizodont::test
