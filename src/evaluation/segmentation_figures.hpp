// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace rhizodont {

/// How well one true tooth was found.
struct FoundToothFigures {
  int fdi = 0;
  double overlap = 0;  ///< intersection over union with what bears its number, vertices
  /// The number of what overlaps it most, 0 if nothing does, and by how much.
  int most_like = 0;
  double most_overlap = 0;

  bool is_right() const { return overlap > 0.5; }
  bool is_found() const { return most_overlap > 0.5; }  ///< under whatever number
};

/// How well the labels of one scan are those that are true.
struct SegmentationFigures {
  /// The figures of 3DTeethSeg22 (A. Ben-Hamadou et al., 2023), as its program counts them: TSA is the share of
  /// vertices that are rightly tooth or gum; a true tooth's match is the found one whose mean vertex is nearest, if
  /// that is nearer than half of its size (of its box's sides, the mean); TLA is exp of minus the mean distance of
  /// matches over that size, 5 for a tooth without a match; TIR the share of matches that bear the right number.
  double tsa = 0, tla = 0, tir = 0;
  double score() const { return (tsa + tla + tir) / 3; }

  std::vector<FoundToothFigures> teeth;  ///< true ones, by number
  std::vector<int> extra;                ///< numbers of found teeth that overlap no true one by more than half
  /// Share of triangles that are rightly labelled, as `triangle_labels_from_vertices` labels them, and of those all of
  /// whose corners are.
  double faces_right = 0, faces_wholly_right = 0;
  bool jaw_right = false;  ///< most labelled vertices are of the right jaw

  std::size_t right() const;
  bool is_without_error() const { return right() == teeth.size() && extra.empty(); }
  double mean_overlap() const;  ///< of the true teeth; 1 without any
};

/// Strict figures: a tooth is right if it overlaps what bears its number by more than half. Labels are FDI numbers per
/// vertex, 0 gum; a milk tooth counts as the permanent one of its place (55 as 15), as what is found has it and as the
/// children's scans of 3DTeethSeg22 that are at hand are labelled. Throws UsageError for labels of another length than
/// the vertices.
SegmentationFigures segmentation_figures(const TriangleMesh& scan, const std::vector<int>& true_labels,
                                         const std::vector<int>& found_labels);

/// Figures of many scans.
struct SegmentationSummary {
  std::size_t scans = 0, without_error = 0, jaws_right = 0;
  std::size_t teeth = 0, right = 0, located = 0, extra = 0;
  double tsa = 0, tla = 0, tir = 0, faces_right = 0, faces_wholly_right = 0;  ///< means over scans
  double mean_overlap = 0;                                                    ///< over teeth
  std::map<int, std::pair<std::size_t, std::size_t>> by_type;  ///< 1..8: how many teeth, and how many right
};

SegmentationSummary summary_of(const std::vector<SegmentationFigures>& scans);

/// Some lines of text.
std::string describe(const SegmentationSummary& summary);

/// For `nlohmann::ordered_json(value)`.
void to_json(nlohmann::ordered_json& json, const SegmentationFigures& figures);
void to_json(nlohmann::ordered_json& json, const SegmentationSummary& summary);

}  // namespace rhizodont
