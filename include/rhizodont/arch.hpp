// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"
#include "rhizodont/export.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/models.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

/// A scan of one or both jaws whose teeth are known.
struct LabelledScan {
  TriangleMesh mesh;
  std::vector<int> fdi;  ///< per vertex the number of its tooth, 11-48 or 51-85 (milk); 0 is gum
};

struct ArchOptions {
  /// For every tooth. Number, directions and length are the arch's to say and must be unset here.
  CompleteOptions tooth = skirt_and_repair();
  /// FDI number -> mm, [shortest_root_mm, longest_root_mm]: lengths measured on X-rays. Those teeth get them, and what
  /// is expected of the others moves with them.
  std::map<int, double> root_lengths;

  bool resolve_collisions = false;  ///< turn, bend or shorten roots that come nearer to other teeth than `clearance`
  double clearance_mm = 0.5;        ///< [0, 3]

  /// What crowns cut from a scan by their labels need: skirts dropped, defects mended.
  RHIZODONT_EXPORT static CompleteOptions skirt_and_repair();
};

/// One tooth of a scan.
struct ToothOfArch {
  int fdi = 0;
  TriangleMesh crown;              ///< as cut from the scan
  std::vector<int> scan_vertices;  ///< of the scan, for each vertex of `crown`
  /// Its record refers to `crown`; not there if it was refused. What closes the crown where the scan hides it at its
  /// neighbours is transition.
  std::optional<CompletedTooth> tooth;
  /// mm, per vertex of the tooth: signed distance from the nearest other tooth of its jaw, at most 3; negative inside
  /// of one
  std::vector<double> clearance;
  std::string refusal;  ///< why there is no tooth; empty if there is one
};

/// A line through a part of a tooth, in the input's frame and unit.
struct LongAxis {
  Point from, to;  ///< from the neck: of the crown to its top, of the root to its end
  /// Unit, towards the crown's top in both.
  Eigen::Vector3d direction;
};

/// Long axes of a tooth's crown and root, from the middle of the crown's border.
struct LongAxes {
  LongAxis crown, root;
};

/// The crown's axis is its growth axis, up to its highest point; the root's goes to the mean of what lies in the lowest
/// third of the root, so that several roots count together.
RHIZODONT_EXPORT LongAxes long_axes(const CompletedTooth& tooth);

/// How near two teeth come, mm: exact distances of their triangles, negative (minus a depth) where they run into each
/// other. A root begins at the crown's lowest point, as its length does; what closes a crown above that, where the scan
/// hides it at its neighbours, is the crown's, and may run into the neighbour's a little. Nothing beyond what was
/// asked.
struct ToothClearance {
  int first = 0, second = 0;  ///< FDI numbers
  std::optional<double> crown_crown;
  std::optional<double> root_root;
  std::optional<double> root_crown, crown_root;  ///< the first's root and the second's crown, and the other way

  /// The smallest in which a root has a part.
  RHIZODONT_EXPORT std::optional<double> of_roots() const;
};

struct CompletedArch {
  std::vector<ToothOfArch> teeth;          ///< by FDI number
  std::vector<ToothClearance> clearances;  ///< of all pairs of a jaw that come nearer than 10 mm
  TriangleMesh gum;                        ///< what is no tooth's in the scan
  /// Directions of the scan to those of the patient: x to the left, y up, z to the front. Not there where the teeth
  /// leave it open; of a scan of both jaws the lower jaw's.
  std::optional<Eigen::Matrix3d> upright;
  std::vector<std::string> notes;  ///< sentences on the arch as a whole

  /// How many teeth have a root.
  RHIZODONT_EXPORT int rooted() const;
};

/// Whether so many labelled teeth, so far across from the first to the last, can be an arch or a part of one.
RHIZODONT_EXPORT bool has_size_of_arch(double millimetres_across, std::size_t teeth);

/// Called after each tooth: how many are done, of how many, and the last one's number.
using ArchProgress = std::function<void(int done, int teeth, int fdi)>;

/// Every tooth of a labelled scan with its root. Each stands as its place among the others tells where at least two
/// teeth of its jaw are there. A tooth that is refused (milk teeth always are: no model knows them) does not stop the
/// others. The same for any number of threads.
/// The same teeth, but for rounding, in any pose of the scan; with its elements in another order the very same.
/// @param progress  never called by two threads at once; what it throws stops the work and comes through
/// Throws InputError for a scan without teeth, with numbers of no tooth or of another size than an arch, and where the
/// models' folder lacks what is needed; UsageError for options out of range and for lengths of teeth that are not
/// there.
RHIZODONT_EXPORT CompletedArch complete_arch(const LabelledScan& scan, const CompletionModels& models,
                                             const ArchOptions& options = {}, const ArchProgress& progress = {});

}  // namespace rhizodont
