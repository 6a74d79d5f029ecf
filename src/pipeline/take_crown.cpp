// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/take_crown.hpp"

#include "mesh/repair.hpp"
#include "pipeline/closed_crown.hpp"
#include "pipeline/crown_input.hpp"
#include "rhizodont/error.hpp"
#include "skirt/skirt_border.hpp"
#include "skirt/skirt_network.hpp"
#include "skirt/spikes.hpp"

#include <algorithm>

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

/// The part of the crown that the tooth will keep: open at the base, its border made of simple loops.
KeptCrown open_crown(const TriangleMesh& crown, bool closed, const Atlas& atlas, const CompleteOptions& options,
                     CompletionRecord& record) {
  std::vector<bool> keep(crown.triangles.size(), true);
  if (closed) {
    if (options.cap == CapHandling::keep)
      throw InputError("The crown is closed and its cap was to be kept: there is no place for a root.");
    const Cap cap = recognise_cap(crown, atlas, options.fdi);
    for (std::size_t t = 0; t < keep.size(); ++t) keep[t] = !cap.is_cap[t];
    record.cap_dropped = true;
  }
  return keep_crown(crown, keep, closed ? "cap" : "skirt");
}

/// Reduces what is kept further, to the triangles of kept.mesh with a true entry in `keep`.
void keep_only(KeptCrown& kept, const std::vector<bool>& keep, const std::string& reason) {
  KeptCrown rest = keep_crown(kept.mesh, keep, reason);
  for (DroppedVertex& d : rest.dropped)
    kept.dropped.push_back({kept.old_vertices[static_cast<std::size_t>(d.vertex)], std::move(d.reason)});
  std::sort(kept.dropped.begin(), kept.dropped.end(),
            [](const DroppedVertex& a, const DroppedVertex& b) { return a.vertex < b.vertex; });
  for (int& v : rest.old_vertices) v = kept.old_vertices[static_cast<std::size_t>(v)];
  for (int& t : rest.old_triangles) t = kept.old_triangles[static_cast<std::size_t>(t)];
  kept.mesh = std::move(rest.mesh);
  kept.old_vertices = std::move(rest.old_vertices);
  kept.old_triangles = std::move(rest.old_triangles);
}

/// Takes off what the network judges to be skirt, and the spikes on what is left.
void drop_skirt(const TriangleMesh& crown, KeptCrown& kept, const SurfaceNetwork& network, double threshold,
                CompletionRecord& record) {
  const std::vector<float> confidence = skirt_confidence(kept.mesh, network);
  record.skirt_model = network.metadata();
  record.tooth_confidence.assign(crown.vertices.size(), -1);
  for (std::size_t v = 0; v < confidence.size(); ++v)
    record.tooth_confidence[static_cast<std::size_t>(kept.old_vertices[v])] = confidence[v];
  SkirtBorderOptions border;
  border.threshold = threshold;
  keep_only(kept, tooth_triangles(kept.mesh, confidence, border), "skirt");
  keep_only(kept, triangles_without_spikes(kept.mesh), "spike");
}

KeptCrown usable_part(const TriangleMesh& crown, const Tools& tools, const CompleteOptions& options,
                      CompletionRecord& record) {
  const Diagnosis diagnosis = require_usable_crown(crown);
  require_tooth_size(crown, options.millimetres_per_unit);
  KeptCrown kept = open_crown(crown, diagnosis.border_edges.empty(), tools.atlas, options, record);
  if (options.skirt) drop_skirt(crown, kept, *tools.skirt, *options.skirt, record);
  require_outward_and_uncut(kept.mesh);
  return kept;
}

/// Puts the input's numbers in the place of the repaired crown's; what the repair dropped is dropped for that reason.
void number_as_input(KeptCrown& kept, const RepairedMesh& repaired, std::size_t input_vertices) {
  std::vector<std::string> reason(input_vertices, "unreferenced");
  const auto in_input = [&](int v) { return repaired.old_vertices[static_cast<std::size_t>(v)]; };
  for (const RepairStep& step : repaired.steps)
    for (const int v : step.vertices) reason[static_cast<std::size_t>(v)] = step.action;
  for (const DroppedVertex& d : kept.dropped) reason[static_cast<std::size_t>(in_input(d.vertex))] = d.reason;
  for (int& v : kept.old_vertices) {
    v = in_input(v);
    reason[static_cast<std::size_t>(v)].clear();
  }
  kept.dropped.clear();
  for (std::size_t v = 0; v < reason.size(); ++v)
    if (!reason[v].empty()) kept.dropped.push_back({static_cast<int>(v), reason[v]});
}

KeptCrown repaired_part(const TriangleMesh& crown, const Tools& tools, const CompleteOptions& options,
                        CompletionRecord& record) {
  RepairedMesh repaired = repair(crown);
  KeptCrown kept = usable_part(repaired.mesh, tools, options, record);
  number_as_input(kept, repaired, crown.vertices.size());
  if (!record.tooth_confidence.empty()) {
    std::vector<float> confidence(crown.vertices.size(), -1);
    for (std::size_t v = 0; v < record.tooth_confidence.size(); ++v)
      confidence[static_cast<std::size_t>(repaired.old_vertices[v])] = record.tooth_confidence[v];
    record.tooth_confidence = std::move(confidence);
  }
  record.repairs = std::move(repaired.steps);
  return kept;
}

/// Whether a repair finds anything to do.
bool has_repairable_defects(const TriangleMesh& crown) {
  try {
    return !repair(crown).steps.empty();
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

KeptCrown take_crown(const TriangleMesh& input, const Atlas& atlas, const std::optional<SurfaceNetwork>& skirt,
                     const CompleteOptions& options, CompletionRecord& record) {
  if (options.skirt && !skirt)
    throw UsageError("The models' folder has no weights to find a skirt with (skirt.safetensors): use --skirt keep.");
  const Tools tools{atlas, skirt ? &*skirt : nullptr};
  const TriangleMesh crown = scaled(input, options.millimetres_per_unit);
  KeptCrown kept;
  try {
    kept = options.repair ? repaired_part(crown, tools, options, record) : usable_part(crown, tools, options, record);
  } catch (const InputError& error) {
    if (options.repair || !has_repairable_defects(crown)) throw;
    throw InputError(std::string(error.what()) + " The option --repair may help.", error.elements());
  }
  record.crown_triangles = static_cast<int>(input.triangles.size());
  record.kept_triangles = static_cast<int>(kept.mesh.triangles.size());
  record.kept_vertices = kept.old_vertices;
  for (const DroppedVertex& d : kept.dropped) record.dropped_vertices.push_back({d.vertex, d.reason});
  return kept;
}

}  // namespace rhizodont
