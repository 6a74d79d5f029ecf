// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// How the roots of labelled scans stand, whether a scan's pose has a say in them, and how long arches take: bench_arch
// axes|pose|time|large SCAN.ply... (labels beside each, as SCAN.json in the form of Teeth3DS). `axes` lays each tooth's
// root axis beside its neighbours' mean, for crowns alone and for the arch, and the means of each type beside those of
// Tong et al., Am J Orthod Dentofacial Orthop 2012;141:604. `pose` completes each scan three times: as it is, with its
// elements in another order, and turned, moved and rounded to float. `time` takes arches beside their teeth one after
// the other; `large` refines each scan to 150,000 vertices and takes it from its files on.
#include "base/float_bits.hpp"
#include "base/peak_memory.hpp"
#include "common/hostile_crowns.hpp"
#include "common/timing.hpp"
#include "io/scan_labels.hpp"
#include "io/write_labels.hpp"
#include "mesh/closest_point.hpp"
#include "report/scan_input.hpp"
#include "rhizodont/arch.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "segment/arch_pose.hpp"
#include "teeth/fdi.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace rhizodont;

constexpr double degrees = 180 / std::numbers::pi;

LabelledScan read_scan(std::filesystem::path path) {
  LabelledScan scan;
  scan.mesh = load_mesh(path).mesh;
  scan.fdi = nlohmann::json::parse(read_file_bytes(path.replace_extension(".json")))["labels"].get<std::vector<int>>();
  return scan;
}

/// Root axes by FDI number.
using Axes = std::map<int, Eigen::Vector3d>;

Axes root_axes(const CompletedArch& arch) {
  Axes axes;
  for (const ToothOfArch& tooth : arch.teeth)
    if (tooth.tooth) axes[tooth.fdi] = long_axes(*tooth.tooth).root.direction;
  return axes;
}

Axes axes_alone(const CompletedArch& arch, const CompletionModels& models) {
  Axes axes;
  for (const ToothOfArch& tooth : arch.teeth) {
    CompleteOptions options = ArchOptions::skirt_and_repair();
    options.fdi = tooth.fdi;
    try {
      axes[tooth.fdi] = long_axes(complete_tooth(tooth.crown, models, options)).root.direction;
    } catch (const Error&) {
    }
  }
  return axes;
}

/// Place from the patient's right to the left, without gaps for missing teeth.
std::vector<int> along(const Axes& axes) {
  std::vector<int> teeth;
  for (const auto& [fdi, axis] : axes) teeth.push_back(fdi);
  const auto place = [](int fdi) { return is_right_side(fdi) ? -(fdi % 10) : fdi % 10; };
  std::sort(teeth.begin(), teeth.end(), [&](int a, int b) { return place(a) < place(b); });
  return teeth;
}

/// Angle between each tooth's axis and the mean of its two neighbours', degrees.
std::vector<std::pair<int, double>> off_neighbours(const Axes& axes) {
  std::vector<std::pair<int, double>> angles;
  const std::vector<int> teeth = along(axes);
  for (std::size_t i = 1; i + 1 < teeth.size(); ++i) {
    const Eigen::Vector3d mean = (axes.at(teeth[i - 1]) + axes.at(teeth[i + 1])).normalized();
    angles.emplace_back(teeth[i], degrees * std::acos(std::clamp(mean.dot(axes.at(teeth[i])), -1.0, 1.0)));
  }
  return angles;
}

void print_shares(const char* name, const std::vector<std::pair<int, double>>& angles) {
  const auto wide = std::count_if(angles.begin(), angles.end(), [](const auto& a) { return a.second > 25; });
  double sum = 0;
  for (const auto& a : angles) sum += a.second;
  fmt::print("{}: {} teeth, mean {:.1f} degrees off their neighbours, {} ({:.1f} %) above 25:", name, angles.size(),
             sum / static_cast<double>(angles.size()), wide,
             100.0 * static_cast<double>(wide) / static_cast<double>(angles.size()));
  for (const auto& [fdi, angle] : angles)
    if (angle > 25) fmt::print(" {} {:.0f}", fdi, angle);
  fmt::print("\n");
}

struct Lean {
  double angulation = 0, inclination = 0;
  int teeth = 0;
};

/// Crown towards mesial and towards the cheek of a root's axis, degrees, against the occlusal direction.
void add_leans(const Axes& axes, const LabelledScan& scan, const CompletedArch& arch, std::map<int, Lean>& leans) {
  (void)scan;
  static const ArchModel model = load_arch_model(default_models_folder() / "arch.safetensors");
  std::map<int, CrownPlace> places;
  for (const ToothOfArch& tooth : arch.teeth)
    if (is_permanent_tooth(tooth.fdi)) places.emplace(tooth.fdi, place_of_crown(tooth.crown));
  const ArchPose pose = fit_arch(model, places).value();
  const auto directions = directions_in_arch(model, pose, places);
  for (const auto& [fdi, axis] : axes) {
    const Eigen::Vector3d up = (fdi / 10 <= 2 ? -1 : 1) * pose.rotation.col(1);
    const auto teeth = along(axes);
    const auto at = std::find(teeth.begin(), teeth.end(), fdi) - teeth.begin();
    const int before = teeth[static_cast<std::size_t>(std::max<std::ptrdiff_t>(at - 1, 0))];
    const int after = teeth[std::min(static_cast<std::size_t>(at) + 1, teeth.size() - 1)];
    Eigen::Vector3d left = places.at(after).middle - places.at(before).middle;
    left = (left - up.dot(left) * up).normalized();
    const Eigen::Vector3d mesial = is_right_side(fdi) ? left : Eigen::Vector3d(-left);
    Eigen::Vector3d buccal = mesial.cross(up);
    if (buccal.dot(directions.at(fdi).buccal) < 0) buccal = -buccal;
    Lean& lean = leans[10 * (fdi / 10 <= 2 ? 1 : 3) + fdi % 10];
    lean.angulation += degrees * std::atan2(axis.dot(mesial), axis.dot(up));
    lean.inclination += degrees * std::atan2(axis.dot(buccal), axis.dot(up));
    ++lean.teeth;
  }
}

void axes(const std::vector<std::filesystem::path>& scans, const CompletionModels& models) {
  std::vector<std::pair<int, double>> alone, together;
  std::map<int, Lean> leans, leans_alone;
  int teeth = 0, rooted = 0;
  for (const auto& path : scans) {
    const LabelledScan scan = read_scan(path);
    const CompletedArch arch = complete_arch(scan, models);
    for (const ToothOfArch& tooth : arch.teeth) {
      ++teeth;
      rooted += tooth.tooth.has_value();
      if (!tooth.tooth)
        fmt::print("{}: {}: {}\n", path.stem().string(), tooth.fdi, tooth.refusal);
      else if (tooth.tooth->record.root.source != RootSource::network)
        fmt::print("{}: {}: root {}\n", path.stem().string(), tooth.fdi,
                   static_cast<int>(tooth.tooth->record.root.source));
    }
    const Axes in_arch = root_axes(arch), on_their_own = axes_alone(arch, models);
    const auto a = off_neighbours(on_their_own), t = off_neighbours(in_arch);
    alone.insert(alone.end(), a.begin(), a.end());
    together.insert(together.end(), t.begin(), t.end());
    add_leans(in_arch, scan, arch, leans);
    add_leans(on_their_own, scan, arch, leans_alone);
    print_shares((path.stem().string() + " alone").c_str(), a);
    print_shares((path.stem().string() + " arch ").c_str(), t);
  }
  fmt::print("{} of {} teeth rooted\n", rooted, teeth);
  print_shares("all, crowns alone", alone);
  print_shares("all, in the arch ", together);
  fmt::print("type  teeth  angulation (alone)  inclination (alone)\n");
  for (const auto& [type, lean] : leans) {
    const Lean& other = leans_alone[type];
    fmt::print("{:>4}  {:>5}  {:>8.1f} ({:>5.1f})  {:>8.1f} ({:>5.1f})\n", type, lean.teeth,
               lean.angulation / lean.teeth, other.angulation / other.teeth, lean.inclination / lean.teeth,
               other.inclination / other.teeth);
  }
}

/// The same scan with vertices and triangles in another order, and triangles beginning elsewhere.
LabelledScan shuffled(const LabelledScan& scan) {
  std::mt19937 random(7);
  std::vector<int> vertices(scan.mesh.vertices.size()), triangles(scan.mesh.triangles.size());
  std::iota(vertices.begin(), vertices.end(), 0);
  std::iota(triangles.begin(), triangles.end(), 0);
  std::shuffle(vertices.begin(), vertices.end(), random);
  std::shuffle(triangles.begin(), triangles.end(), random);
  LabelledScan result;
  std::vector<std::int32_t> place(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto from = static_cast<std::size_t>(vertices[v]);
    place[from] = static_cast<std::int32_t>(v);
    result.mesh.vertices.push_back(scan.mesh.vertices[from]);
    result.fdi.push_back(scan.fdi[from]);
  }
  for (const int t : triangles) {
    Triangle corners = scan.mesh.triangles[static_cast<std::size_t>(t)];
    for (std::int32_t& v : corners) v = place[static_cast<std::size_t>(v)];
    std::rotate(corners.begin(), corners.begin() + t % 3, corners.end());
    result.mesh.triangles.push_back(corners);
  }
  return result;
}

LabelledScan moved(LabelledScan scan, const Eigen::Isometry3d& move) {
  for (Point& p : scan.mesh.vertices) p = nearest_float(move * p);
  return scan;
}

std::vector<std::array<double, 3>> sorted_vertices(const TriangleMesh& mesh) {
  std::vector<std::array<double, 3>> vertices;
  for (const Point& p : mesh.vertices) vertices.push_back({p.x(), p.y(), p.z()});
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

void pose(const std::vector<std::filesystem::path>& scans, const CompletionModels& models) {
  int teeth = 0, identical = 0, turned_teeth = 0;
  std::vector<double> means, largest;
  for (const auto& path : scans) {
    const LabelledScan scan = read_scan(path);
    Eigen::Isometry3d move =
        Eigen::Translation3d(31, -12, 55) * Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized());
    const CompletedArch first = complete_arch(scan, models), other = complete_arch(shuffled(scan), models),
                        turned = complete_arch(moved(scan, move), models);
    for (std::size_t i = 0; i < first.teeth.size(); ++i) {
      const ToothOfArch &a = first.teeth[i], &b = other.teeth.at(i), &c = turned.teeth.at(i);
      ++teeth;
      identical += a.tooth.has_value() == b.tooth.has_value() &&
                   (!a.tooth || sorted_vertices(a.tooth->mesh) == sorted_vertices(b.tooth->mesh));
      if (a.tooth.has_value() != c.tooth.has_value())
        fmt::print("{} {}: with a root in one pose alone\n", path.stem().string(), a.fdi);
      if (!a.tooth || !c.tooth) continue;
      ++turned_teeth;
      const ClosestPointIndex index(a.tooth->mesh);
      double sum = 0, most = 0;
      for (const Point& p : c.tooth->mesh.vertices) {
        const double mm = index.closest(move.inverse() * p).distance;
        sum += mm;
        most = std::max(most, mm);
      }
      means.push_back(sum / static_cast<double>(c.tooth->mesh.vertices.size()));
      largest.push_back(most);
      if (most > 0.05) fmt::print("{} {}: up to {:.3f} mm\n", path.stem().string(), a.fdi, most);
    }
  }
  fmt::print("another order: {} of {} teeth identical\n", identical, teeth);
  if (largest.empty()) return;
  std::sort(largest.begin(), largest.end());
  fmt::print(
      "another pose: {} teeth, {:.5f} mm off in the mean; farthest places: median {:.5f}, 90 % {:.5f}, all "
      "{:.3f} mm\n",
      turned_teeth, std::accumulate(means.begin(), means.end(), 0.0) / static_cast<double>(means.size()),
      largest[largest.size() / 2], largest[largest.size() * 9 / 10], largest.back());
}

void time(const std::vector<std::filesystem::path>& scans, const CompletionModels& models) {
  fmt::print("scan  triangles  teeth  read s  arch s  teeth one by one s  ratio\n");
  for (const auto& path : scans) {
    LabelledScan scan;
    CompletedArch arch;
    const double read = median_seconds([&] { scan = read_scan(path); }, 1);
    const double together = median_seconds([&] { arch = complete_arch(scan, models); }, 3);
    const double alone = median_seconds([&] { axes_alone(arch, models); }, 1);
    fmt::print("{:>16}  {:>7}  {:>2}  {:.2f}  {:.2f}  {:.2f}  {:.2f}\n", path.stem().string(),
               scan.mesh.triangles.size(), arch.teeth.size(), read, together, alone, together / alone);
  }
  fmt::print("peak memory {:.0f} MB\n", peak_memory_mb());
}

/// The same surface with the same labels on `vertices` vertices.
LabelledScan refined_scan(const LabelledScan& scan, std::size_t vertices) {
  LabelledScan fine{test::refined_to(scan.mesh, vertices), {}};
  const ClosestPointIndex index(scan.mesh);
  const std::vector<int> labels = triangle_labels_from_vertices(scan.mesh, scan.fdi);
  for (const Point& p : fine.mesh.vertices)
    fine.fdi.push_back(labels[static_cast<std::size_t>(index.closest(p).triangle)]);
  return fine;
}

void large(const std::vector<std::filesystem::path>& scans, const CompletionModels& models) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("bench_arch_{}", getpid());
  std::filesystem::create_directory(folder);
  fmt::print("scan  vertices  teeth  with roots  read, labels cleaned s  arch s  together s\n");
  for (const auto& path : scans) {
    MeshFile file;
    const LabelledScan fine = refined_scan(read_scan(path), 150000);
    file.mesh = fine.mesh;
    round_to_float(file.mesh);
    save_mesh(folder / "scan.ply", file);
    std::ofstream(folder / "scan.json") << teeth3ds_json(
        fine.fdi, jaw_of_fdi(*std::max_element(fine.fdi.begin(), fine.fdi.end())), file);
    ScanInput input;
    CompletedArch arch;
    const double read =
        median_seconds([&] { input = rhizodont::read_scan(folder / "scan.ply", ScanLabelSource{}); }, 1);
    const double completed = median_seconds([&] { arch = complete_arch(input.scan, models); }, 1);
    fmt::print("{:>16}  {}  {:>2}  {:>2}  {:.2f}  {:.2f}  {:.2f}\n", path.stem().string(), fine.mesh.vertices.size(),
               arch.teeth.size(), arch.rooted(), read, completed, read + completed);
  }
  std::filesystem::remove_all(folder);
  fmt::print("peak memory {:.0f} MB\n", peak_memory_mb());
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::filesystem::path> scans(words + std::min(count, 2), words + count);
  const std::map<std::string, void (*)(const std::vector<std::filesystem::path>&, const CompletionModels&)> modes{
      {"axes", axes}, {"pose", pose}, {"time", time}, {"large", large}};
  const auto mode = modes.find(count > 1 ? words[1] : "");
  if (mode == modes.end() || scans.empty()) {
    fmt::print(stderr, "usage: bench_arch axes|pose|time|large SCAN.ply...\n");
    return 2;
  }
  mode->second(scans, CompletionModels::load(default_models_folder()));
  return 0;
}
