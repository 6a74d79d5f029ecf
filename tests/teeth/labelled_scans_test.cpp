// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Real scans with labels: in and out again in every dialect, in any pose.
#include "io/scan_labels.hpp"
#include "io/write_labels.hpp"
#include "mesh/adjacency.hpp"
#include "teeth/clean_labels.hpp"
#include "teeth/label_numbers.hpp"
#include "teeth/made_arch.hpp"

#include <filesystem>
#include <set>

namespace rhizodont {
namespace {

using enum LabelNumbers;

struct LabelledScan {
  std::string name;
  MeshFile file;
  RawLabels raw;
};

std::vector<LabelledScan> real_scans() {
  const std::filesystem::path folder = std::filesystem::path(RHIZODONT_SOURCE_DIR) / "../shared/data/arches";
  std::vector<LabelledScan> scans;
  if (!std::filesystem::exists(folder)) return scans;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".ply") continue;
    std::filesystem::path labels = entry.path();
    labels.replace_extension(".json");
    LabelledScan scan{entry.path().stem().string(), load_mesh(entry.path()), {}};
    scan.raw = labels_from_teeth3ds(read_file_bytes(labels), scan.file);
    scans.push_back(std::move(scan));
  }
  std::sort(scans.begin(), scans.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return scans;
}

class LabelledScans : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::vector<LabelledScan> loaded = real_scans();
    scans_ = &loaded;
    if (loaded.empty()) GTEST_SKIP() << "no labelled scans at ../shared/data/arches";
  }
  const std::vector<LabelledScan>& scans() const { return *scans_; }

 private:
  const std::vector<LabelledScan>* scans_ = nullptr;
};

bool has_wisdom_tooth(const std::vector<int>& fdi) {
  return std::any_of(fdi.begin(), fdi.end(), [](int n) { return n % 10 == 8; });
}

LabelNumberOptions options_for(const RawLabels& raw) {
  LabelNumberOptions options;
  options.jaw = raw.stated_jaw;
  return options;
}

TEST_F(LabelledScans, AreFdiByTheirNumbersAlone) {
  for (const LabelledScan& scan : scans()) {
    ASSERT_TRUE(scan.raw.stated_jaw) << scan.name;
    const ScanLabels labels = decide_label_numbers(scan.file.mesh, scan.raw.per_vertex);
    EXPECT_EQ(labels.numbers, fdi) << scan.name << ": " << labels.decided;
    EXPECT_EQ(labels.fdi, scan.raw.per_vertex) << scan.name;
  }
}

TEST_F(LabelledScans, ComeBackFromEveryNumberingInAnyPose) {
  int seed = 0;
  for (const LabelledScan& scan : scans()) {
    TriangleMesh mesh = scan.file.mesh;
    test::pose(mesh, seed++);
    for (const LabelNumbers numbers : {universal, arch14, arch16}) {
      if (numbers == arch14 && has_wisdom_tooth(scan.raw.per_vertex)) continue;
      const std::vector<int> numbered = numbered_as(scan.raw.per_vertex, numbers);
      LabelNumberOptions options = options_for(scan.raw);
      // a missing second molar, or no wisdom tooth, hides how long the count is
      if (numbers == arch16) options.forced = arch16;
      const ScanLabels labels = decide_label_numbers(mesh, numbered, options);
      EXPECT_EQ(labels.numbers, numbers) << scan.name << ": " << labels.decided;
      EXPECT_EQ(labels.fdi, scan.raw.per_vertex) << scan.name << ": " << labels.decided;
      if (numbers == universal) continue;
      const int last = numbers == arch14 ? 15 : 17;
      options.forced = numbers;
      const auto turned = test::renumbered(numbered, [&](int n) { return n == 0 ? 0 : last - n; });
      EXPECT_EQ(decide_label_numbers(mesh, turned, options).fdi, scan.raw.per_vertex) << scan.name;
    }
  }
}

TEST_F(LabelledScans, AreWrittenAndReadAgain) {
  for (const LabelledScan& scan : scans()) {
    const std::vector<int>& fdi_labels = scan.raw.per_vertex;
    const RawLabels json = labels_from_teeth3ds(teeth3ds_json(fdi_labels, scan.raw.stated_jaw, scan.file), scan.file);
    EXPECT_EQ(json.per_vertex, fdi_labels) << scan.name;
    EXPECT_EQ(json.stated_jaw, scan.raw.stated_jaw) << scan.name;
    for (const VtkEncoding encoding : {VtkEncoding::ascii, VtkEncoding::binary}) {
      const MeshFile vtk =
          read_mesh(vtk_with_point_labels(scan.file.mesh, numbered_as(fdi_labels, universal), encoding), ".vtk");
      EXPECT_EQ(vtk.mesh.vertices, scan.file.mesh.vertices) << scan.name;
      const RawLabels raw = labels_from_array(vtk);
      EXPECT_EQ(raw.origin, "the point array Universal_ID");
      LabelNumberOptions options;
      options.stated = raw.stated_numbers;
      EXPECT_EQ(decide_label_numbers(vtk.mesh, raw.per_vertex, options).fdi, fdi_labels) << scan.name;
    }
    const std::vector<int> cells = triangle_labels_from_vertices(scan.file.mesh, fdi_labels);
    const MeshFile vtp = read_mesh(vtp_with_cell_labels(scan.file.mesh, cells), ".vtp");
    EXPECT_EQ(vtp.mesh.vertices, scan.file.mesh.vertices) << scan.name;
    const std::vector<double>& label = vtp.triangle_attributes.at("Label").values;
    EXPECT_EQ(std::vector<int>(label.begin(), label.end()), cells) << scan.name;
    const std::vector<int> back = labels_from_array(vtp).per_vertex;
    std::size_t changed = 0;
    for (std::size_t v = 0; v < back.size(); ++v) changed += back[v] != fdi_labels[v];
    EXPECT_LT(static_cast<double>(changed), 0.03 * static_cast<double>(back.size())) << scan.name;
  }
}

TEST_F(LabelledScans, KeepTheirTeethWhenCleaned) {
  for (const LabelledScan& scan : scans()) {
    const CleanedLabels cleaned = clean_labels(scan.file.mesh, scan.raw.per_vertex);
    EXPECT_EQ(std::set<int>(cleaned.fdi.begin(), cleaned.fdi.end()),
              std::set<int>(scan.raw.per_vertex.begin(), scan.raw.per_vertex.end()))
        << scan.name;
    std::size_t vertices = 0;
    for (const LabelChange& change : cleaned.changes) vertices += change.became ? change.vertices : 0;
    std::size_t changed = 0;
    for (std::size_t v = 0; v < cleaned.fdi.size(); ++v) changed += cleaned.fdi[v] != scan.raw.per_vertex[v];
    EXPECT_GE(vertices, changed) << scan.name;
    EXPECT_LT(changed, scan.raw.per_vertex.size() / 100) << scan.name;
    EXPECT_TRUE(clean_labels(scan.file.mesh, cleaned.fdi).fdi == cleaned.fdi) << scan.name;
  }
}

TEST_F(LabelledScans, StrayNumbersOnThemAreTakenOut) {
  for (const LabelledScan& scan : scans()) {
    const std::vector<int>& labels = scan.raw.per_vertex;
    const VertexTriangles around = vertex_triangles(scan.file.mesh);
    // within one tooth or the gum, not at the scan's border
    const auto is_inside = [&](std::size_t v) {
      std::set<int> neighbours;
      for (int k = around.first[v]; k < around.first[v + 1]; ++k)
        for (const std::int32_t n :
             scan.file.mesh.triangles[static_cast<std::size_t>(around.triangles[static_cast<std::size_t>(k)])])
          neighbours.insert(n);
      const int triangles = around.first[v + 1] - around.first[v];
      return static_cast<int>(neighbours.size()) == triangles + 1 &&
             std::all_of(neighbours.begin(), neighbours.end(),
                         [&](int n) { return labels[static_cast<std::size_t>(n)] == labels[v]; });
    };
    const int tooth = *std::max_element(labels.begin(), labels.end());
    std::vector<int> noisy = labels;
    for (std::size_t v = 7; v < noisy.size(); v += 211)
      if (is_inside(v)) noisy[v] = labels[v] == 0 ? tooth : 0;
    EXPECT_NE(noisy, labels) << scan.name;
    EXPECT_EQ(clean_labels(scan.file.mesh, noisy).fdi, labels) << scan.name;
  }
}

}  // namespace
}  // namespace rhizodont
