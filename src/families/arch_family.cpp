// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/arch_family.hpp"

#include "base/float_bits.hpp"
#include "base/option_range.hpp"
#include "families/arch_crowns.hpp"
#include "families/arch_fields.hpp"
#include "families/arch_scan.hpp"
#include "families/arch_source.hpp"
#include "mesh/diagnosis.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace rhizodont {
namespace {

void check_arch_options(const ArchDrawOptions& options) {
  constexpr OptionRange factor = OptionRange::at_least(0).at_most(2);
  constexpr OptionRange triangles = OptionRange::at_least(2000).at_most(400000);
  require_ranges("of generated arches", {{"triangles", options.triangles.first, triangles},
                                         {"triangles", options.triangles.second, triangles},
                                         {"grid_mm", options.grid_mm, OptionRange::at_least(0.2).at_most(0.6)},
                                         {"shape", options.shape, factor},
                                         {"arrangement", options.arrangement, factor},
                                         {"defects", options.defects, factor},
                                         {"crowding_share", options.crowding_share, share_range},
                                         {"spacing_share", options.spacing_share, share_range},
                                         {"missing_share", options.missing_share, share_range},
                                         {"wisdom_share", options.wisdom_share, share_range},
                                         {"partial_share", options.partial_share, share_range},
                                         {"milk_share", options.milk_share, share_range},
                                         {"wear_share", options.wear_share, share_range},
                                         {"stump_share", options.stump_share, share_range},
                                         {"bracket_share", options.bracket_share, share_range},
                                         {"real_crown_share", options.real_crown_share, share_range},
                                         {"model_share", options.model_share, share_range}});
  if (options.triangles.first > options.triangles.second)
    throw UsageError("The least number of a generated arch's triangles is above the most.");
}

/// The scan's frame: where the work frame's axes end, and a shift.
struct ScanPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

/// Any turn is as likely as any other (K. Shoemake, "Uniform random rotations", 1992).
ScanPose draw_pose(RandomStream& random) {
  const double u = random.uniform(), a = 2 * std::numbers::pi * random.uniform(),
               b = 2 * std::numbers::pi * random.uniform();
  const Eigen::Quaterniond turn(std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a),
                                std::sqrt(1 - u) * std::cos(a), std::sqrt(u) * std::sin(b));
  ScanPose pose;
  pose.rotation = turn.normalized().toRotationMatrix();
  pose.shift = Eigen::Vector3d(random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(-60, 60));
  return pose;
}

std::vector<GeneratedTooth> teeth_of(const ArchCrowns& arch, const ScanSurface& scan, const Eigen::Matrix3d& to_scan) {
  std::map<int, std::pair<Point, std::size_t>> sums;
  for (std::size_t v = 0; v < scan.fdi.size(); ++v) {
    if (scan.fdi[v] == 0) continue;
    auto& [sum, vertices] = sums.try_emplace(scan.fdi[v], Point::Zero(), 0).first->second;
    sum += scan.mesh.vertices[v];
    ++vertices;
  }
  std::vector<GeneratedTooth> teeth;
  for (const ArchCrown& crown : arch.crowns) {
    const auto found = sums.find(crown.fdi);
    if (crown.ghost || found == sums.end()) continue;
    GeneratedTooth tooth;
    tooth.fdi = crown.fdi;
    tooth.vertices = found->second.second;
    tooth.middle = found->second.first / static_cast<double>(tooth.vertices);
    tooth.directions = {to_scan * crown.to_work.linear().col(2), to_scan * crown.to_work.linear().col(1)};
    tooth.worn = crown.wear_mm > 0.3;
    tooth.stump = crown.stump;
    tooth.bracket = crown.bracket;
    tooth.attachment = crown.attachment;
    tooth.half_erupted = crown.hood_mm > 0;
    teeth.push_back(tooth);
  }
  return teeth;
}

GeneratedArch attempt(const ArchSource& source, std::uint64_t seed, std::uint64_t trial,
                      const ArchDrawOptions& options) {
  RandomStream random(seed, 510 + trial);
  const Jaw drawn_jaw = random.chance(0.5) ? Jaw::upper : Jaw::lower;
  const Jaw jaw = options.jaw.value_or(drawn_jaw);
  const ArchPerson person = draw_arch_person(source, seed, options);
  const ArchCrowns arch = draw_crowns(source, person, jaw, seed + (trial << 32), options);
  const double share = random.uniform();
  const auto triangles = static_cast<std::size_t>(std::lround(
      static_cast<double>(options.triangles.first) *
      std::pow(static_cast<double>(options.triangles.second) / static_cast<double>(options.triangles.first), share)));
  ArchFields fields;
  fields.lattice = lattice_around(arch, options.grid_mm);
  add_teeth(arch, random, fields);
  add_gum(arch, draw_gum_form(jaw, random), fields);
  const ScanExtent extent = draw_extent(arch, random, options);
  if (extent.model) add_model_base(arch, random, fields);
  ScanSurface scan = surface_of(arch, fields, random.uniform(0.1, 0.5));
  drop_crumbs(scan, scan.mesh.triangles.size() / 20);  // hollows between teeth
  form_gum(arch, fields, random, scan);
  if (!extent.model) trim(arch, fields, extent, random, scan);
  spoil(arch, options.defects, random, scan);
  thin(triangles, random, scan);
  roughen(options.defects, random, scan);
  tidy_labels(8, scan);

  GeneratedArch result;
  result.jaw = jaw;
  const ScanPose pose = options.any_pose ? draw_pose(random) : ScanPose{};
  const double sense = jaw == Jaw::upper ? -1 : 1;
  const Eigen::Matrix3d work_to_arch = Eigen::Vector3d(sense, sense, 1).asDiagonal();
  result.rotation = pose.rotation;
  result.shift = pose.shift;
  const Eigen::Matrix3d to_scan = pose.rotation * work_to_arch;
  for (Point& p : scan.mesh.vertices) p = nearest_float(Point(to_scan * p + pose.shift));
  result.teeth = teeth_of(arch, scan, to_scan);
  result.missing = arch.missing;
  result.size = arch.size;
  result.drawn = arch.drawn;
  if (extent.model) result.drawn.emplace_back("model base");
  if (extent.partial) result.drawn.emplace_back("part of an arch");
  result.scan = std::move(scan.mesh);
  result.fdi = std::move(scan.fdi);
  return result;
}

}  // namespace

ArchFamily load_arch_family(const std::filesystem::path& folder) {
  return {std::make_shared<const ArchSource>(load_arch_source(folder / "crowns"))};
}

GeneratedArch sample_arch(const ArchFamily& family, std::uint64_t seed, const ArchDrawOptions& options) {
  check_arch_options(options);
  constexpr std::uint64_t trials = 3;
  for (std::uint64_t trial = 0;; ++trial) {
    try {
      GeneratedArch arch = attempt(*family.source, seed, trial, options);
      if (arch.teeth.size() < 2 || !diagnose(arch.scan).is_oriented_manifold())
        throw NoResultError("A generated arch came out without teeth or with a surface that is no manifold.");
      return arch;
    } catch (const NoResultError&) {
      if (trial + 1 == trials) throw;
    }
  }
}

}  // namespace rhizodont
