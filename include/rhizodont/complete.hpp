// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/completion_record.hpp"
#include "rhizodont/export.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/models.hpp"
#include "rhizodont/root_steering.hpp"
#include "rhizodont/tooth_directions.hpp"
#include "rhizodont/units.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace rhizodont {

/// What is to happen to a cap that closes the crown's base.
enum class CapHandling { drop, keep };

struct CompleteOptions {
  std::optional<int> fdi;  ///< 11-18, 21-28, 31-38, 41-48; unset: the type is guessed from shape
  double e = 0.5;          ///< mm, [0.2, 2]: side of the lattice under the guiding surface; new edges are about e / 2
  CapHandling cap = CapHandling::drop;
  /// (0, 1): vertices of which the skirt network is less sure that they are tooth are dropped as skirt, with a smooth
  /// border; 0.5 is what it was trained for. Unset: a skirt is kept.
  std::optional<double> skirt;
  bool repair = false;              ///< mend a defective crown first, where else it would be refused; all is listed
  double millimetres_per_unit = 1;  ///< > 0: of the input's coordinates; the output has the input's unit
  /// mm, [0, 5]: width of the smoothed band beside the crown; unset: from the border's edges and from how far the root
  /// misses the border.
  std::optional<double> transition;
  /// Where the neighbours are known. They set the turn about the axis, and the crown's border moves the axis a little
  /// away from theirs; unset: both come from the crown alone.
  std::optional<ToothDirections> directions;
  RootSteering steering;  ///< what the user knows or wants of the root
  int threads = 0;        ///< >= 0: at most so many threads, for this call alone; 0: all that the caller may use
};

/// A whole tooth. Its first vertices and triangles are the kept crown's, in the input's order, bit for bit.
struct CompletedTooth {
  TriangleMesh mesh;                 ///< in the input's unit and frame
  std::vector<VertexSource> source;  ///< per vertex
  std::vector<double> uncertainty;   ///< mm, per vertex: expected distance from the true surface; 0 on the crown
  CompleteOptions options;           ///< that it was made with: those given, of a further candidate with its own length
  CompletionRecord record;
};

/// Called with the name of each stage before it begins. What it throws ends the work and reaches the caller as it is:
/// so that work is cancelled.
using ProgressCallback = std::function<void(std::string_view stage)>;

/// Completes a scanned crown to a whole tooth, with the crown kept bit for bit (paper, figure 1). The result has been
/// checked: the crown's triangles are found in it and it is a solid, or nothing is returned. With `options.repair`
/// defects are taken out first; the tooth then keeps the repaired crown, which has no coordinate that the input lacks.
///
/// `crown`: open at its base, or closed by a cap that is recognised and dropped; triangles counterclockwise from
/// outside. Throws InputError where the crown cannot be used (empty, not finite, several pieces, inside out,
/// non-manifold edges, wrong size, cutting itself, closed without a cap), UsageError for options out of range,
/// NoResultError where no result keeps the promises.
RHIZODONT_EXPORT CompletedTooth complete_tooth(const TriangleMesh& crown, const CompletionModels& models,
                                               const CompleteOptions& options = {},
                                               const ProgressCallback& progress = {});

/// A crown with all that does not depend on what a user wishes of the root: what is kept of it, which tooth it is, the
/// predicted tooth, and the guiding surface. Never changes; copies share it, also among threads. Keeps the models
/// alive.
class RHIZODONT_EXPORT PreparedTooth {
 public:
  /// What is known so far: lengths, joining and promises are those of no tooth yet.
  const CompletionRecord& record() const;
  const CompleteOptions& options() const;  ///< that it was prepared with

  struct Content;

 private:
  friend PreparedTooth prepare_tooth(const TriangleMesh& crown, const CompletionModels& models,
                                     const CompleteOptions& options, const ProgressCallback& progress);
  friend CompletedTooth finish_tooth(const PreparedTooth& prepared, const RootSteering& steering,
                                     std::optional<double> transition, const ProgressCallback& progress);
  explicit PreparedTooth(std::shared_ptr<const Content> content);
  std::shared_ptr<const Content> content_;
};

/// The first half of `complete_tooth`, which takes most of the time: `options.steering` and `options.transition` are
/// checked and have no say. Throws as `complete_tooth`.
RHIZODONT_EXPORT PreparedTooth prepare_tooth(const TriangleMesh& crown, const CompletionModels& models,
                                             const CompleteOptions& options = {},
                                             const ProgressCallback& progress = {});

/// The second half: the root as wished, joined to the crown and checked. The tooth's options are those it was prepared
/// with, and these. Throws as `complete_tooth`.
RHIZODONT_EXPORT CompletedTooth finish_tooth(const PreparedTooth& prepared, const RootSteering& steering = {},
                                             std::optional<double> transition = {},
                                             const ProgressCallback& progress = {});

/// Several teeth for one crown that differ in what a crown tells least, the root's length: the expected one first, then
/// `count` - 1 whose lengths are spread evenly over the interval that holds the truth with 80 % probability, shortest
/// first. Each is as checked and as exact as that of `complete_tooth`. `count`: 1 to 9; one only where the length is
/// set by the user. Throws as `complete_tooth`; UsageError for another count or weights without calibration.
RHIZODONT_EXPORT std::vector<CompletedTooth> complete_candidates(const TriangleMesh& crown,
                                                                 const CompletionModels& models, int count,
                                                                 const CompleteOptions& options = {},
                                                                 const ProgressCallback& progress = {});

}  // namespace rhizodont
