// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"
#include "rhizodont/jaw.hpp"
#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace rhizodont {

/// What teeth are found by: a network and the mean arch, loaded once and used for many scans, from several threads.
class RHIZODONT_EXPORT SegmentModels {
 public:
  /// Reads segment.safetensors and arch.safetensors from a folder. Throws InputError if one is missing or damaged.
  static SegmentModels load(const std::filesystem::path& folder);
  /// Whether a folder holds such a network.
  static bool are_in(const std::filesystem::path& folder);
  SegmentModels(SegmentModels&&) noexcept;
  SegmentModels& operator=(SegmentModels&&) noexcept;
  ~SegmentModels();

  struct Content;
  const Content& content() const { return *content_; }

 private:
  explicit SegmentModels(std::shared_ptr<const Content> content);
  std::shared_ptr<const Content> content_;
};

/// The files that `SegmentModels::load` reads from a folder.
RHIZODONT_EXPORT std::vector<std::filesystem::path> segment_model_files(const std::filesystem::path& folder);

struct SegmentOptions {
  double millimetres_per_unit = 1;  ///< of the scan, > 0
  std::optional<Jaw> jaw;           ///< nothing: found
  std::set<int> missing;            ///< FDI numbers of permanent teeth that are not there
  std::map<int, Point> teeth;       ///< FDI number and a place on that tooth, in the scan's frame and unit
  int threads = 0;                  ///< at most so many; 0: all
};

/// A tooth in a scan.
struct FoundTooth {
  int fdi = 0;
  double confidence = 0;         ///< 0..1: that there is a tooth and this is its number
  std::optional<int> second;     ///< the number that is next likely; nothing: that it is no tooth
  double second_confidence = 0;  ///< 0..1
  Point middle = Point::Zero();  ///< of its vertices, in the scan's frame and unit
  std::size_t vertices = 0;      ///< that bear its number
};

struct SegmentedScan {
  std::vector<int> fdi;           ///< per vertex of the scan, 0 for gum and everything else
  std::vector<FoundTooth> teeth;  ///< by number
  Jaw jaw = Jaw::lower;
  double jaw_confidence = 0;       ///< 0..1
  std::string jaw_reason;          ///< a sentence
  std::vector<std::string> notes;  ///< what is doubtful, a sentence each
};

/// Finds the permanent teeth of one jaw in a scan of gum and teeth, in any pose, and numbers them. The same labels
/// for any number of threads. Throws UsageError for an option out of range or numbers that contradict each other;
/// InputError, with the reason, for what is no scan of an arch.
RHIZODONT_EXPORT SegmentedScan segment_scan(const TriangleMesh& scan, const SegmentModels& models,
                                            const SegmentOptions& options = {});

}  // namespace rhizodont
