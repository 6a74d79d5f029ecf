// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/segmentation_figures.hpp"

#include "io/scan_labels.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rhizodont {
namespace {

/// What bears one number.
struct Labelled {
  std::size_t vertices = 0;
  Point sum = Point::Zero();
  Eigen::AlignedBox3d box;

  Point middle() const { return sum / static_cast<double>(vertices); }
  double size() const { return box.sizes().mean(); }
};

std::map<int, Labelled> labelled(const TriangleMesh& scan, const std::vector<int>& labels) {
  std::map<int, Labelled> teeth;
  for (std::size_t v = 0; v < labels.size(); ++v) {
    if (labels[v] == 0) continue;
    Labelled& tooth = teeth[labels[v]];
    ++tooth.vertices;
    tooth.sum += scan.vertices[v];
    tooth.box.extend(scan.vertices[v]);
  }
  return teeth;
}

void compare_teeth(const std::map<int, Labelled>& truth, const std::map<int, Labelled>& found,
                   const std::map<std::pair<int, int>, std::size_t>& common, SegmentationFigures& figures) {
  const auto overlap = [&](int is, int said) {
    const auto both = common.find({is, said});
    if (both == common.end()) return 0.0;
    const auto n = static_cast<double>(both->second);
    return n / (static_cast<double>(truth.at(is).vertices + found.at(said).vertices) - n);
  };
  for (const auto& [fdi, tooth] : truth) {
    FoundToothFigures f;
    f.fdi = fdi;
    f.overlap = overlap(fdi, fdi);
    for (const auto& [said, other] : found)
      if (const double o = overlap(fdi, said); o > f.most_overlap) {
        f.most_overlap = o;
        f.most_like = said;
      }
    figures.teeth.push_back(f);
  }
  for (const auto& [said, other] : found)
    if (std::none_of(truth.begin(), truth.end(), [&](const auto& is) { return overlap(is.first, said) > 0.5; }))
      figures.extra.push_back(said);
}

void compare_places(const std::map<int, Labelled>& truth, const std::map<int, Labelled>& found,
                    SegmentationFigures& figures) {
  constexpr double not_found = 5;
  double sum = 0;
  std::size_t matched = 0, right = 0;
  for (const auto& [fdi, tooth] : truth) {
    double nearest = std::numeric_limits<double>::infinity();
    int said = 0;
    for (const auto& [number, other] : found)
      if (const double d = (other.middle() - tooth.middle()).norm(); d < nearest) {
        nearest = d;
        said = number;
      }
    const double extent = std::max(tooth.size(), 1e-9);
    if (nearest > extent / 2) {
      sum += not_found;
      continue;
    }
    ++matched;
    right += said == fdi ? 1 : 0;
    sum += nearest / extent;
  }
  figures.tla = truth.empty() ? 1 : std::exp(-sum / static_cast<double>(truth.size()));
  figures.tir = matched == 0 ? (truth.empty() ? 1 : 0) : static_cast<double>(right) / static_cast<double>(matched);
}

bool is_upper_number(int fdi) { return fdi / 10 == 1 || fdi / 10 == 2 || fdi / 10 == 5 || fdi / 10 == 6; }

std::ptrdiff_t uppers_over_lowers(const std::map<int, Labelled>& teeth) {
  std::ptrdiff_t sum = 0;
  for (const auto& [fdi, tooth] : teeth)
    sum += is_upper_number(fdi) ? static_cast<std::ptrdiff_t>(tooth.vertices)
                                : -static_cast<std::ptrdiff_t>(tooth.vertices);
  return sum;
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 1 : static_cast<double>(part) / static_cast<double>(whole);
}

/// Milk teeth as the permanent ones of their places.
std::vector<int> by_place(std::vector<int> fdi) {
  for (int& number : fdi)
    if (is_milk_tooth(number)) number -= 40;
  return fdi;
}

}  // namespace

std::size_t SegmentationFigures::right() const {
  return static_cast<std::size_t>(
      std::count_if(teeth.begin(), teeth.end(), [](const auto& t) { return t.is_right(); }));
}

double SegmentationFigures::mean_overlap() const {
  double sum = 0;
  for (const FoundToothFigures& tooth : teeth) sum += tooth.overlap;
  return teeth.empty() ? 1 : sum / static_cast<double>(teeth.size());
}

SegmentationFigures segmentation_figures(const TriangleMesh& scan, const std::vector<int>& true_labels,
                                         const std::vector<int>& found_labels) {
  const std::size_t n = scan.vertices.size();
  if (true_labels.size() != n || found_labels.size() != n)
    throw UsageError("There must be as many labels as the scan has vertices.");
  const std::vector<int> truth = by_place(true_labels), found = by_place(found_labels);
  SegmentationFigures figures;
  std::map<std::pair<int, int>, std::size_t> common;
  std::size_t tooth_or_gum = 0;
  for (std::size_t v = 0; v < n; ++v) {
    tooth_or_gum += (truth[v] == 0) == (found[v] == 0) ? 1 : 0;
    if (truth[v] != 0 && found[v] != 0) ++common[{truth[v], found[v]}];
  }
  figures.tsa = share(tooth_or_gum, n);
  const std::vector<int> faces = triangle_labels_from_vertices(scan, truth),
                         said_faces = triangle_labels_from_vertices(scan, found);
  std::size_t right = 0, wholly = 0;
  for (std::size_t t = 0; t < faces.size(); ++t) {
    right += faces[t] == said_faces[t] ? 1 : 0;
    wholly += std::all_of(scan.triangles[t].begin(), scan.triangles[t].end(), [&](int v) {
      return truth[static_cast<std::size_t>(v)] == found[static_cast<std::size_t>(v)];
    });
  }
  figures.faces_right = share(right, faces.size());
  figures.faces_wholly_right = share(wholly, faces.size());
  const auto teeth = labelled(scan, truth), said = labelled(scan, found);
  compare_teeth(teeth, said, common, figures);
  compare_places(teeth, said, figures);
  figures.jaw_right = (uppers_over_lowers(teeth) > 0) == (uppers_over_lowers(said) > 0) && !said.empty();
  return figures;
}

SegmentationSummary summary_of(const std::vector<SegmentationFigures>& scans) {
  SegmentationSummary sum;
  sum.scans = scans.size();
  for (const SegmentationFigures& f : scans) {
    const auto each = 1 / static_cast<double>(scans.size());
    sum.without_error += f.is_without_error() ? 1 : 0;
    sum.jaws_right += f.jaw_right ? 1 : 0;
    sum.extra += f.extra.size();
    sum.tsa += each * f.tsa;
    sum.tla += each * f.tla;
    sum.tir += each * f.tir;
    sum.faces_right += each * f.faces_right;
    sum.faces_wholly_right += each * f.faces_wholly_right;
    for (const FoundToothFigures& tooth : f.teeth) {
      ++sum.teeth;
      sum.right += tooth.is_right() ? 1 : 0;
      sum.located += tooth.is_found() ? 1 : 0;
      sum.mean_overlap += tooth.overlap;
      auto& [all, good] = sum.by_type[tooth.fdi % 10];
      ++all;
      good += tooth.is_right() ? 1 : 0;
    }
  }
  if (sum.teeth > 0) sum.mean_overlap /= static_cast<double>(sum.teeth);
  return sum;
}

std::string describe(const SegmentationSummary& s) {
  std::string text = fmt::format(
      "{} scans: TSA {:.4f}  TLA {:.4f}  TIR {:.4f}  mean {:.4f}\n"
      "strict: {} of {} teeth right ({:.4f}), {} found under any number ({:.4f}), {} extra; mean IoU {:.4f}\n"
      "faces right {:.4f} (at all three corners {:.4f}); jaw right {} of {}; scans without error {} of {}\n",
      s.scans, s.tsa, s.tla, s.tir, (s.tsa + s.tla + s.tir) / 3, s.right, s.teeth, share(s.right, s.teeth), s.located,
      share(s.located, s.teeth), s.extra, s.mean_overlap, s.faces_right, s.faces_wholly_right, s.jaws_right, s.scans,
      s.without_error, s.scans);
  text += "by place from the middle:";
  for (const auto& [type, counts] : s.by_type) text += fmt::format("  {}: {}/{}", type, counts.second, counts.first);
  return text + "\n";
}

void to_json(nlohmann::ordered_json& json, const SegmentationFigures& figures) {
  nlohmann::ordered_json teeth = nlohmann::ordered_json::array();
  for (const FoundToothFigures& tooth : figures.teeth)
    teeth.push_back({{"fdi", tooth.fdi},
                     {"right", tooth.is_right()},
                     {"overlap", tooth.overlap},
                     {"most_like", tooth.most_like},
                     {"most_overlap", tooth.most_overlap}});
  json = {{"tsa", figures.tsa},
          {"tla", figures.tla},
          {"tir", figures.tir},
          {"faces_right", figures.faces_right},
          {"faces_wholly_right", figures.faces_wholly_right},
          {"mean_overlap", figures.mean_overlap()},
          {"jaw_right", figures.jaw_right},
          {"teeth", teeth},
          {"extra", figures.extra}};
}

void to_json(nlohmann::ordered_json& json, const SegmentationSummary& s) {
  nlohmann::ordered_json types = nlohmann::ordered_json::object();
  for (const auto& [type, counts] : s.by_type)
    types[std::to_string(type)] = {{"teeth", counts.first}, {"right", counts.second}};
  json = {{"scans", s.scans},
          {"without_error", s.without_error},
          {"jaws_right", s.jaws_right},
          {"teeth", s.teeth},
          {"right", s.right},
          {"located", s.located},
          {"extra", s.extra},
          {"tsa", s.tsa},
          {"tla", s.tla},
          {"tir", s.tir},
          {"faces_right", s.faces_right},
          {"faces_wholly_right", s.faces_wholly_right},
          {"mean_overlap", s.mean_overlap},
          {"by_type", types}};
}

}  // namespace rhizodont
