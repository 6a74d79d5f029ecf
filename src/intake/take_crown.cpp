// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "intake/take_crown.hpp"

#include "intake/closed_crown.hpp"
#include "intake/crown_input.hpp"
#include "intake/part_of_mesh.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/pieces.hpp"
#include "mesh/repair.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"
#include "skirt/made_cap.hpp"
#include "skirt/ragged_part.hpp"
#include "skirt/skirt_border.hpp"
#include "skirt/skirt_network.hpp"
#include "skirt/spikes.hpp"

#include <algorithm>
#include <functional>
#include <optional>

namespace rhizodont {
namespace {

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  if (factor != 1)
    for (Point& p : mesh.vertices) p *= factor;
  return mesh;
}

/// What crowns are judged by.
struct Tools {
  const Atlas& atlas;
  const SurfaceNetwork* skirt;  // null: none
};

/// The part of the crown that is kept so far: open at the base, its border made of simple loops.
KeptCrown open_crown(const TriangleMesh& crown, bool closed, const Atlas& atlas, const CompleteOptions& options,
                     IntakeRecord& record) {
  std::vector<bool> keep(crown.triangles.size(), true), never;
  if (closed) {
    if (options.cap == CapHandling::keep)
      throw InputError("The crown is closed and its cap was to be kept: there is no place for a root.");
    const Cap cap = recognise_cap(crown, atlas, options.fdi);
    for (std::size_t t = 0; t < keep.size(); ++t) keep[t] = !cap.is_cap[t];
    if (cap.made) never = cap.is_cap;
    record.cap_dropped = true;
  }
  return keep_crown(crown, keep, closed ? DropReason::cap : DropReason::skirt, never);
}

/// Lists those of a cap's triangles that are not kept although all their corners, on the border, are.
void list_dropped_cap(const TriangleMesh& crown, const std::vector<bool>& may_be_cap, const KeptCrown& kept,
                      IntakeRecord& record) {
  std::vector<bool> is_left(crown.vertices.size(), false), is_kept(crown.triangles.size(), false);
  for (const int v : kept.old_vertices) is_left[static_cast<std::size_t>(v)] = true;
  for (const int t : kept.old_triangles) is_kept[static_cast<std::size_t>(t)] = true;
  RepairStep step{RepairAction::cap_at_border_dropped, {}, {}};
  for (std::size_t t = 0; t < crown.triangles.size(); ++t) {
    const Triangle& c = crown.triangles[t];
    if (may_be_cap[t] && !is_kept[t] &&
        std::all_of(c.begin(), c.end(), [&](int v) { return is_left[static_cast<std::size_t>(v)]; }))
      step.triangles.push_back(static_cast<int>(t));
  }
  if (!step.triangles.empty()) record.repairs.push_back(std::move(step));
}

/// Reduces what is kept further, to what was kept of kept.mesh.
void reduce_to(KeptCrown& kept, KeptCrown rest) {
  for (const DroppedCrownVertex& d : rest.dropped)
    kept.dropped.push_back({kept.old_vertices[static_cast<std::size_t>(d.vertex)], d.reason});
  std::sort(kept.dropped.begin(), kept.dropped.end(),
            [](const DroppedCrownVertex& a, const DroppedCrownVertex& b) { return a.vertex < b.vertex; });
  for (int& v : rest.old_vertices) v = kept.old_vertices[static_cast<std::size_t>(v)];
  for (int& t : rest.old_triangles) t = kept.old_triangles[static_cast<std::size_t>(t)];
  kept.mesh = std::move(rest.mesh);
  kept.old_vertices = std::move(rest.old_vertices);
  kept.old_triangles = std::move(rest.old_triangles);
}

/// Reduces what is kept further, to the triangles of kept.mesh with a true entry in `keep`.
void keep_only(KeptCrown& kept, const std::vector<bool>& keep, DropReason reason) {
  reduce_to(kept, keep_crown(kept.mesh, keep, reason));
}

/// Confidences of a part's vertices put at their numbers in the whole; -1 for the others.
std::vector<float> numbered_as_before(const std::vector<float>& of_part, const std::vector<int>& old_vertices,
                                      std::size_t vertices) {
  std::vector<float> confidence(vertices, -1);
  for (std::size_t v = 0; v < of_part.size(); ++v) confidence[static_cast<std::size_t>(old_vertices[v])] = of_part[v];
  return confidence;
}

/// What is kept of a part of the crown, with all triangles of the whole crown between its vertices but those that were
/// left out of the part on purpose (a cap between them). Vertices outside of the part are dropped as its ragged border.
KeptCrown all_between(const TriangleMesh& crown, const Submesh& part, const KeptCrown& kept) {
  std::vector<bool> is_kept(crown.vertices.size(), false), never(crown.triangles.size(), false);
  for (const int v : kept.old_vertices)
    is_kept[static_cast<std::size_t>(part.old_vertices[static_cast<std::size_t>(v)])] = true;
  for (const int t : part.old_triangles) never[static_cast<std::size_t>(t)] = true;
  for (const int t : kept.old_triangles)
    never[static_cast<std::size_t>(part.old_triangles[static_cast<std::size_t>(t)])] = false;
  std::vector<bool> keep;
  for (const Triangle& t : crown.triangles)
    keep.push_back(std::all_of(t.begin(), t.end(), [&](int v) { return is_kept[static_cast<std::size_t>(v)]; }));
  for (std::size_t t = 0; t < keep.size(); ++t) keep[t] = keep[t] && !never[t];
  KeptCrown whole = keep_crown(crown, keep, DropReason::ragged_border, never);
  std::vector<std::optional<DropReason>> reason(crown.vertices.size());
  for (const DroppedCrownVertex& d : kept.dropped)
    reason[static_cast<std::size_t>(part.old_vertices[static_cast<std::size_t>(d.vertex)])] = d.reason;
  for (DroppedCrownVertex& d : whole.dropped)
    if (const auto earlier = reason[static_cast<std::size_t>(d.vertex)]) d.reason = *earlier;
  return whole;
}

/// Takes off what the network judges to be skirt, and the spikes on what is left.
void drop_skirt(const TriangleMesh& crown, KeptCrown& kept, const SurfaceNetwork& network, double threshold,
                IntakeRecord& record) {
  const std::vector<float> confidence =
      on_part(kept.old_vertices, kept.old_triangles, [&] { return skirt_confidence(kept.mesh, network); });
  record.skirt_model = network.metadata();
  record.tooth_confidence.assign(crown.vertices.size(), -1);
  for (std::size_t v = 0; v < confidence.size(); ++v)
    record.tooth_confidence[static_cast<std::size_t>(kept.old_vertices[v])] = confidence[v];
  SkirtBorderOptions border;
  border.threshold = threshold;
  keep_only(kept, tooth_triangles(kept.mesh, confidence, border), DropReason::skirt);
  keep_only(kept, triangles_without_spikes(kept.mesh), DropReason::spike);
}

/// The crown without its cap, of the size of a tooth before and after: what is left of a plinth is smaller.
KeptCrown open_part(const TriangleMesh& crown, bool closed, const Tools& tools, const CompleteOptions& options,
                    IntakeRecord& record) {
  require_tooth_size(crown, options.millimetres_per_unit, closed);
  KeptCrown kept = open_crown(crown, closed, tools.atlas, options, record);
  if (!closed) return kept;
  try {
    require_tooth_size(kept.mesh, options.millimetres_per_unit);
  } catch (const InputError&) {
    require_no_root(crown);  // a better reason
    throw;
  }
  return kept;
}

void require_tooth_surface(const KeptCrown& kept) {
  on_part(kept.old_vertices, kept.old_triangles, [&] {
    require_usable_crown(kept.mesh);
    require_outward_and_uncut(kept.mesh);
  });
}

bool is_tooth_surface(const KeptCrown& kept) {
  try {
    require_tooth_surface(kept);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// The tooth's own surface in a mesh as a segmentation leaves it: judged on its sound part, then all between the
/// vertices that are kept. What is no surface near its border is dropped, what is none elsewhere refused.
KeptCrown tooth_of_raw_crown(const TriangleMesh& crown, const Tools& tools, const CompleteOptions& options,
                             IntakeRecord& record) {
  require_readable_crown(crown);
  require_one_crown(crown);  // gum beside it is smaller
  const Submesh part = submesh(crown, sound_triangles(crown));
  if (part.mesh.triangles.empty())
    throw InputError("No part of the mesh is a surface: more than two triangles meet at the edges of all of them.");
  const bool closed = diagnose(part.mesh).border_edges.empty();
  KeptCrown kept = on_part(part.old_vertices, part.old_triangles, [&] {
    KeptCrown opened = open_part(part.mesh, closed, tools, options, record);
    drop_skirt(part.mesh, opened, *tools.skirt, *options.skirt, record);
    return opened;
  });
  record.tooth_confidence = numbered_as_before(record.tooth_confidence, part.old_vertices, crown.vertices.size());
  if (part.old_triangles.size() < crown.triangles.size()) kept = all_between(crown, part, kept);
  if (const std::vector<bool> open = triangles_without_slits(kept.mesh);
      std::find(open.begin(), open.end(), false) != open.end())
    keep_only(kept, open, DropReason::ragged_border);
  if (is_tooth_surface(kept)) return kept;
  keep_only(kept, triangles_without_ragged_defects(kept.mesh), DropReason::ragged_border);
  keep_only(kept, triangles_without_spikes(kept.mesh), DropReason::spike);
  require_tooth_surface(kept);
  return kept;
}

KeptCrown usable_part(const TriangleMesh& crown, const Tools& tools, const CompleteOptions& options,
                      IntakeRecord& record) {
  KeptCrown kept;
  if (options.skirt) {
    kept = tooth_of_raw_crown(crown, tools, options, record);
  } else {
    const bool closed = require_usable_crown(crown).border_edges.empty();
    kept = open_part(crown, closed, tools, options, record);
    on_part(kept.old_vertices, kept.old_triangles, [&] { require_outward_and_uncut(kept.mesh); });
  }
  if (record.cap_dropped) list_dropped_cap(crown, std::vector<bool>(crown.triangles.size(), true), kept, record);
  return kept;
}

/// Puts the input's numbers in the place of the repaired crown's; what the repair dropped is dropped for that reason.
void number_as_input(KeptCrown& kept, const RepairedMesh& repaired, std::size_t input_vertices) {
  std::vector<std::optional<DropReason>> reason(input_vertices, DropReason::unreferenced);
  const auto in_input = [&](int v) { return repaired.old_vertices[static_cast<std::size_t>(v)]; };
  for (const RepairStep& step : repaired.steps)
    for (const int v : step.vertices) reason[static_cast<std::size_t>(v)] = DropReason::repair;
  for (const DroppedCrownVertex& d : kept.dropped) reason[static_cast<std::size_t>(in_input(d.vertex))] = d.reason;
  for (int& v : kept.old_vertices) {
    v = in_input(v);
    reason[static_cast<std::size_t>(v)].reset();
  }
  for (int& t : kept.old_triangles) t = repaired.old_triangles[static_cast<std::size_t>(t)];
  kept.dropped.clear();
  for (std::size_t v = 0; v < reason.size(); ++v)
    if (reason[v]) kept.dropped.push_back({static_cast<int>(v), *reason[v]});
}

/// Puts a whole's numbers in the place of a part's in what was noted of the part.
void number_record_as_whole(IntakeRecord& record, const std::vector<int>& old_vertices,
                            const std::vector<int>& old_triangles, std::size_t vertices) {
  if (!record.tooth_confidence.empty())
    record.tooth_confidence = numbered_as_before(record.tooth_confidence, old_vertices, vertices);
  for (RepairStep& step : record.repairs) {
    for (std::vector<int>* ids : {&step.vertices, &step.merged_into})
      for (int& v : *ids) v = old_vertices[static_cast<std::size_t>(v)];
    for (int& t : step.triangles) t = old_triangles[static_cast<std::size_t>(t)];
  }
}

/// What `take` keeps of the repaired crown, in the crown's numbers.
KeptCrown part_of_repaired(const TriangleMesh& crown, RepairedMesh repaired, IntakeRecord& record,
                           const std::function<KeptCrown(const TriangleMesh&)>& take) {
  KeptCrown kept = on_part(repaired.old_vertices, repaired.old_triangles, [&] { return take(repaired.mesh); });
  number_as_input(kept, repaired, crown.vertices.size());
  number_record_as_whole(record, repaired.old_vertices, repaired.old_triangles, crown.vertices.size());
  for (RepairStep& step : record.repairs) repaired.steps.push_back(std::move(step));
  record.repairs = std::move(repaired.steps);
  return kept;
}

KeptCrown mended_part(const TriangleMesh& crown, const Tools& tools, const CompleteOptions& options,
                      IntakeRecord& record);

/// Triangles of a cap that is to be dropped and betrays itself by the way in which a program made it.
std::optional<std::vector<bool>> droppable_made_cap(const TriangleMesh& crown, const CompleteOptions& options) {
  if (options.cap == CapHandling::keep || !diagnose(crown).is_closed_manifold()) return std::nullopt;
  return find_made_cap(crown);
}

KeptCrown part_without_cap(const TriangleMesh& closed, const std::vector<bool>& is_cap, const Tools& tools,
                           const CompleteOptions& options, IntakeRecord& record) {
  require_tooth_size(closed, options.millimetres_per_unit, true);
  std::vector<bool> keep = is_cap;
  keep.flip();
  KeptCrown kept = keep_crown(closed, keep, DropReason::cap, is_cap);
  require_tooth_size(kept.mesh, options.millimetres_per_unit);
  KeptCrown rest =
      on_part(kept.old_vertices, kept.old_triangles, [&] { return mended_part(kept.mesh, tools, options, record); });
  number_record_as_whole(record, kept.old_vertices, kept.old_triangles, closed.vertices.size());
  reduce_to(kept, std::move(rest));
  record.cap_dropped = true;
  list_dropped_cap(closed, is_cap, kept, record);
  return kept;
}

/// Nothing of it is to be repaired: a spike taken off would open it in a place that is no base.
bool is_sound_and_closed(const TriangleMesh& crown) {
  return diagnose(crown).is_closed_solid() && self_intersecting_triangles(crown).empty();
}

/// The usable part of the crown, repaired if asked for; without it specks alone are taken off, unless a skirt is: all
/// that is beside the tooth goes with it. A made cap goes before anything is cut: it may cut itself or the crown, and
/// what a cut leaves of it is no longer known for a cap.
KeptCrown mended_part(const TriangleMesh& crown, const Tools& tools, const CompleteOptions& options,
                      IntakeRecord& record) {
  const auto take = [&](const TriangleMesh& mesh) { return usable_part(mesh, tools, options, record); };
  if (options.repair) {
    RepairOptions first;
    first.connections_only = true;
    RepairedMesh connected = repair(crown, first);
    if (const auto is_cap = droppable_made_cap(connected.mesh, options))
      return part_of_repaired(crown, std::move(connected), record, [&](const TriangleMesh& closed) {
        return part_without_cap(closed, *is_cap, tools, options, record);
      });
    const bool sound = options.cap != CapHandling::keep && is_sound_and_closed(connected.mesh);
    return part_of_repaired(crown, sound ? std::move(connected) : repair(crown), record, take);
  }
  if (options.skirt) {
    if (const auto is_cap = droppable_made_cap(crown, options))
      return part_without_cap(crown, *is_cap, tools, options, record);
    return take(crown);
  }
  RepairedMesh without_specks = drop_specks(crown);
  if (without_specks.steps.empty()) return take(crown);
  return part_of_repaired(crown, std::move(without_specks), record, take);
}

}  // namespace

TakenCrown take_crown(const TriangleMesh& input, const Atlas& atlas, const std::optional<SurfaceNetwork>& skirt,
                      const CompleteOptions& options) {
  if (options.skirt && !skirt)
    throw UsageError("The models' folder has no weights to find a skirt with (skirt.safetensors): use --skirt keep.");
  const Tools tools{atlas, skirt ? &*skirt : nullptr};
  TakenCrown taken;
  taken.kept = mended_part(scaled(input, options.millimetres_per_unit), tools, options, taken.record);
  return taken;
}

}  // namespace rhizodont
