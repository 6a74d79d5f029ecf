// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", figure 1 and section 4.1: from a
// segmented scan to whole teeth. What a person's lengths say of each other: person_lengths.cpp.
#include "arch/arch_memory.hpp"
#include "arch/arch_options.hpp"
#include "arch/clearance.hpp"
#include "arch/neck.hpp"
#include "arch/person_lengths.hpp"
#include "arch/resolve_collisions.hpp"
#include "base/parallel_tasks.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/space_order.hpp"
#include "pipeline/models.hpp"
#include "pipeline/moved_tooth.hpp"
#include "pipeline/prepared_tooth.hpp"
#include "rhizodont/arch.hpp"
#include "rhizodont/error.hpp"
#include "segment/arch_pose.hpp"
#include "segment/cut_crowns.hpp"
#include "teeth/fdi.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <numbers>
#include <utility>

namespace rhizodont {
namespace {

/// Half of an interval that holds 80 % of a Gaussian, in deviations.
constexpr double half_of_80_percent = 1.2816;

bool is_upper(int fdi) { return jaw_of_fdi(fdi) == Jaw::upper; }

void require_numbers_of_teeth(const std::vector<int>& fdi) {
  for (std::size_t v = 0; v < fdi.size(); ++v)
    if (fdi[v] != 0 && !is_permanent_tooth(fdi[v]) && !is_milk_tooth(fdi[v]))
      throw InputError(fmt::format("No tooth has the number {}.", fdi[v]), {static_cast<std::int64_t>(v)},
                       ElementKind::vertices);
}

void require_size_of_arch(const std::vector<ToothOfArch>& teeth, double millimetres_per_unit) {
  Eigen::AlignedBox3d box;
  for (const ToothOfArch& tooth : teeth) box.extend(bounding_box(tooth.crown.vertices));
  const double across = millimetres_per_unit * box.diagonal().norm();
  if (has_size_of_arch(across, teeth.size())) return;
  throw InputError(
      fmt::format("The {} teeth of this scan are {:.4g} mm across from the first to the last, which teeth cannot be. "
                  "Is the file in "
                  "{}? Then say so with --unit.",
                  teeth.size(), across, across < 40 ? "metres, centimetres or inches" : "micrometres"));
}

std::vector<ToothOfArch> cut(const LabelledScan& scan) {
  std::vector<ToothOfArch> teeth;
  for (auto& [fdi, part] : cut_crowns(scan.mesh, scan.fdi)) {
    ToothOfArch& tooth = teeth.emplace_back();
    tooth.fdi = fdi;
    tooth.crown = std::move(part.mesh);
    tooth.scan_vertices = std::move(part.old_vertices);
  }
  if (teeth.empty()) throw InputError("No triangle of the scan belongs to a tooth.");
  return teeth;
}

void require_lengths_of_teeth_there(const std::vector<ToothOfArch>& teeth, const ArchOptions& options) {
  for (const auto& length : options.root_lengths)
    if (std::none_of(teeth.begin(), teeth.end(), [&](const ToothOfArch& t) { return t.fdi == length.first; }))
      throw UsageError(
          fmt::format("A root length was given for tooth {}, which the scan does not have.", length.first));
}

/// How the permanent teeth stand, in jaws with enough of them; `upright`: as CompletedArch's.
std::map<int, ToothDirections> directions_of(const std::vector<ToothOfArch>& teeth, const ArchModel& model,
                                             double millimetres_per_unit, std::optional<Eigen::Matrix3d>& upright) {
  std::map<int, ToothDirections> directions;
  for (const bool upper : {true, false}) {
    std::map<int, CrownPlace> places;
    for (const ToothOfArch& tooth : teeth) {
      if (!is_permanent_tooth(tooth.fdi) || is_upper(tooth.fdi) != upper) continue;
      // In an order of its own, so that sums do not round otherwise where the scan has another one.
      CrownPlace place =
          place_of_crown(reordered(tooth.crown, space_order(tooth.crown, space_order_step_mm / millimetres_per_unit)));
      place.middle *= millimetres_per_unit;
      places.emplace(tooth.fdi, place);
    }
    if (places.size() < 2) continue;
    const std::optional<ArchPose> pose = fit_arch(model, places);
    if (!pose) continue;
    upright = pose->rotation.transpose();
    directions.merge(directions_in_arch(model, *pose, places));
  }
  return directions;
}

/// New vertices above the crown's lowest point, from which a root's length is measured: where a scan hides a crown at
/// its neighbours its border climbs, and they close it there.
std::vector<bool> closes_crown(const CompletedTooth& tooth) {
  const Eigen::Vector3d& up = tooth.record.frame.growth_axis;
  const double level = lowest_of_crown(tooth);
  std::vector<bool> closes;
  for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v)
    closes.push_back(tooth.source[v] != VertexSource::scan && up.dot(tooth.mesh.vertices[v]) > level);
  return closes;
}

/// What closes a crown at its neighbours is transition, as no scanner saw it and it is no root either.
void mark_contacts(CompletedTooth& tooth) {
  const std::vector<bool> closes = closes_crown(tooth);
  for (std::size_t v = 0; v < closes.size(); ++v)
    if (closes[v]) tooth.source[v] = VertexSource::transition;
  tooth.record.joining.transition_vertices =
      static_cast<int>(std::count(tooth.source.begin(), tooth.source.end(), VertexSource::transition));
}

/// The parts that clearances are told by: the crown with what closes it at its neighbours, and the root.
std::vector<VertexSource> crown_and_root(const CompletedTooth& tooth) {
  std::vector<VertexSource> parts = tooth.source;
  const std::vector<bool> closes = closes_crown(tooth);
  for (std::size_t v = 0; v < parts.size(); ++v)
    if (closes[v]) parts[v] = VertexSource::scan;
  return parts;
}

/// Counts teeth and tells of them, one thread at a time.
class Count {
 public:
  Count(const ArchProgress& progress, std::size_t teeth) : progress_(progress), teeth_(static_cast<int>(teeth)) {}
  void one_more(int fdi) {
    if (!progress_) return;
    const std::lock_guard<std::mutex> guard(mutex_);
    // Isolated: a callback that runs in parallel itself must not be given another tooth, which would wait for the
    // guard.
    tbb::this_task_arena::isolate([&] { progress_(++done_, teeth_, fdi); });
  }

 private:
  const ArchProgress& progress_;
  std::mutex mutex_;
  int done_ = 0, teeth_;
};

/// How a tooth is tried, one way after the other, with what the user is to know where it is not the first.
struct Attempt {
  CompleteOptions options;
  std::string warning;
};

std::vector<Attempt> attempts_for(int fdi, const std::map<int, ToothDirections>& directions,
                                  const CompleteOptions& tooth) {
  Attempt alone{tooth, ""};
  alone.options.fdi = fdi;
  alone.options.threads = 0;
  std::vector<Attempt> attempts;
  if (const auto found = directions.find(fdi); found != directions.end()) {
    attempts.push_back(alone);
    attempts.back().options.directions = found->second;
    alone.warning =
        "No root could be made with the tooth standing as its neighbours do; it stands as its border tells.";
  }
  attempts.push_back(alone);
  if (tooth.skirt) {
    alone.options.skirt.reset();
    alone.warning = "No root could be made without what seemed to be gum or web on the crown; that was kept.";
    attempts.push_back(alone);
  }
  return attempts;
}

/// Degrees between a tooth's axis and the way that its neighbours tell; 0 where they tell none.
double degrees_off(const CompletedTooth& tooth, const std::optional<ToothDirections>& place) {
  if (!place) return 0;
  return std::acos(std::clamp(tooth.record.frame.growth_axis.dot(place->occlusal), -1.0, 1.0)) * 180 / std::numbers::pi;
}

/// Who labelled the crown took all of it for tooth.
void warn_of_loss(CompletionRecord& record) {
  constexpr double most_lost = 0.25;
  const CrownRecord& crown = record.crown;
  if (crown.kept_triangles < (1 - most_lost) * crown.triangles)
    record.warnings.push_back(
        fmt::format("Only {} of the {} triangles that are labelled as this tooth were kept, the others taken for gum "
                    "or damage: look at the crown.",
                    crown.kept_triangles, crown.triangles));
}

/// The first attempt that gives a tooth. Where none does, throws that it would not stand in the arch, if a tooth was
/// made at all: what is left of a crown may be hung on its border anyhow, upside down too, and its neighbours know
/// better. Else as the first attempt that drops the skirt and finds fault with the crown itself, which tells more than
/// what came of it, or as the first.
MadeTooth complete_one(const TriangleMesh& crown, const std::vector<Attempt>& attempts,
                       const CompletionModels& models) {
  const std::optional<ToothDirections>& place = attempts.front().options.directions;
  constexpr double most_off = 60;  // degrees; borders of real scans lean by up to 40
  std::exception_ptr refused;
  bool is_of_crown = false;
  for (const Attempt& attempt : attempts) {
    try {
      const PreparedTooth prepared = prepare_tooth(crown, models, attempt.options);
      CompletedTooth tooth = finish_tooth(prepared, attempt.options.steering, attempt.options.transition);
      if (const double off = degrees_off(tooth, place); off > most_off) {
        refused = std::make_exception_ptr(NoResultError(
            fmt::format("The tooth would stand {:.0f} degrees off the way that its neighbours tell. Is enough of its "
                        "crown there, and is it erupted?",
                        off)));
        continue;
      }
      mark_contacts(tooth);
      warn_of_loss(tooth.record);
      if (!attempt.warning.empty()) tooth.record.warnings.push_back(attempt.warning);
      return {prepared, std::move(tooth), ""};
    } catch (const UsageError&) {
      throw;
    } catch (const InputError&) {
      // What is said of a crown with its gum is no fault of the crown.
      const bool tells_more = attempt.options.skirt && !is_of_crown;
      if (!refused || tells_more) refused = std::current_exception();
      is_of_crown |= attempt.options.skirt.has_value();
    } catch (const Error&) {
      if (!refused) refused = std::current_exception();
    }
  }
  std::rethrow_exception(refused);
}

/// Whether a crown gives the same tooth with both, however many threads work. Number and directions are each tooth's
/// own.
bool give_the_same(const CompleteOptions& a, const CompleteOptions& b) {
  // Named one by one: a new option that is forgotten here does not compile.
  [[maybe_unused]] const auto& [fdi, e, cap, skirt, repair, unit, transition, directions, steering, threads] = a;
  return e == b.e && cap == b.cap && skirt == b.skirt && repair == b.repair && unit == b.millimetres_per_unit &&
         transition == b.transition && steering == b.steering;
}

std::optional<ToothDirections> directions_in(const std::map<int, ToothDirections>& directions, int fdi) {
  const auto found = directions.find(fdi);
  return found == directions.end() ? std::nullopt : std::optional(found->second);
}

bool stand_the_same(const std::optional<ToothDirections>& a, const std::optional<ToothDirections>& b) {
  if (!a || !b) return !a && !b;
  return a->occlusal == b->occlusal && a->buccal == b->buccal;
}

/// Null if it is not there.
const MadeTooth* remembered(const ArchMemory* memory, const ToothOfArch& tooth,
                            const std::map<int, ToothDirections>& directions, const CompleteOptions& options) {
  if (memory == nullptr) return nullptr;
  const auto found = memory->teeth.find(tooth.fdi);
  if (found == memory->teeth.end()) return nullptr;
  const ArchMemory::Tooth& before = found->second;
  const bool is_same = give_the_same(options, before.options) &&
                       stand_the_same(directions_in(directions, tooth.fdi), before.directions) &&
                       tooth.crown.triangles == before.crown.triangles && tooth.crown.vertices == before.crown.vertices;
  return is_same ? &before.made : nullptr;
}

std::vector<MadeTooth> complete_each(const std::vector<ToothOfArch>& teeth,
                                     const std::map<int, ToothDirections>& directions, const CompletionModels& models,
                                     const ArchOptions& options, const ArchProgress& progress,
                                     const ArchMemory* memory) {
  std::vector<MadeTooth> all(teeth.size());
  Count count(progress, teeth.size());
  parallel_tasks(teeth.size(), [&](std::size_t i) {
    const ToothOfArch& tooth = teeth[i];
    try {
      if (!is_permanent_tooth(tooth.fdi))
        throw InputError(fmt::format("Tooth {} is a milk tooth, and no model knows their roots.", tooth.fdi));
      if (const MadeTooth* before = remembered(memory, tooth, directions, options.tooth))
        all[i] = *before;
      else
        all[i] = complete_one(tooth.crown, attempts_for(tooth.fdi, directions, options.tooth), models);
    } catch (const UsageError&) {
      throw;
    } catch (const Error& error) {
      all[i].refusal = error.what();
    }
    count.one_more(tooth.fdi);
  });
  return all;
}

using Prepared = std::vector<std::optional<PreparedTooth>>;

/// Puts the teeth into the arch; those that a memory will keep are copied.
Prepared take(std::vector<MadeTooth>& made, std::vector<ToothOfArch>& teeth, bool are_kept) {
  Prepared prepared;
  for (std::size_t i = 0; i < teeth.size(); ++i) {
    teeth[i].tooth = are_kept ? made[i].tooth : std::move(made[i].tooth);
    teeth[i].refusal = made[i].refusal;
    prepared.push_back(made[i].prepared);
  }
  return prepared;
}

ArchMemory memory_of(std::vector<MadeTooth> made, const std::vector<ToothOfArch>& teeth,
                     const std::map<int, ToothDirections>& directions, const CompleteOptions& options) {
  ArchMemory memory;
  for (std::size_t i = 0; i < teeth.size(); ++i)
    memory.teeth[teeth[i].fdi] = {teeth[i].crown, directions_in(directions, teeth[i].fdi), options, std::move(made[i])};
  return memory;
}

/// What was said of a tooth holds for the one that is made anew of the same crown.
void keep_warnings(CompletionRecord& record, const CompletionRecord& before) {
  for (const std::string& warning : before.warnings)
    if (std::find(record.warnings.begin(), record.warnings.end(), warning) == record.warnings.end())
      record.warnings.push_back(warning);
}

/// The tooth with its root as long as expected; it stays as it is where that gives no tooth.
void give_length(ToothOfArch& tooth, const PreparedTooth& prepared, const LengthExpectation& length, bool measured,
                 const ArchOptions& options) {
  CompletionRecord& before = tooth.tooth->record;
  try {
    RootSteering steering = options.tooth.steering;
    steering.length_mm = std::clamp(length.mm, shortest_root_mm, longest_root_mm);
    CompletedTooth made = finish_tooth(prepared, steering, options.tooth.transition);
    mark_contacts(made);
    keep_warnings(made.record, before);
    if (before.root.interval && !measured) {
      const double half = half_of_80_percent * length.deviation_mm, mm = made.record.root.length_mm;
      made.record.root.interval = {std::max(mm - half, shortest_root_mm), std::min(mm + half, longest_root_mm),
                                   before.root.interval->apex_radius_mm};
    }
    tooth.tooth = std::move(made);
  } catch (const NoResultError& error) {
    before.warnings.push_back(
        fmt::format("The root could not be given a length of {:.1f} mm: {}", length.mm, error.what()));
  }
}

/// Moves the lengths of all teeth with those that were measured.
void heed_measured(std::vector<ToothOfArch>& teeth, const Prepared& prepared, const ArchOptions& options,
                   std::vector<std::string>& notes) {
  if (options.root_lengths.empty()) return;
  std::map<int, LengthExpectation> expected;
  for (const ToothOfArch& tooth : teeth) {
    if (!tooth.tooth) continue;
    const RootRecord& root = tooth.tooth->record.root;
    // Weights that were never calibrated state no interval; roots of one type vary by 1 to 2 mm.
    const double deviation =
        root.interval ? (root.interval->length_high_mm - root.interval->length_low_mm) / (2 * half_of_80_percent) : 1.5;
    expected[tooth.fdi] = {root.length_mm, std::max(deviation, 0.1)};
  }
  std::map<int, double> measured;
  for (const auto& length : options.root_lengths) {
    const auto found =
        std::find_if(teeth.begin(), teeth.end(), [&](const ToothOfArch& t) { return t.fdi == length.first; });
    if (found->tooth) {
      measured.insert(length);
    } else {
      notes.push_back(
          fmt::format("The root length given for tooth {} tells nothing: the tooth has no root.", length.first));
    }
  }
  const std::map<int, LengthExpectation> lengths = given_measured(expected, measured);
  parallel_tasks(teeth.size(), [&](std::size_t i) {
    ToothOfArch& tooth = teeth[i];
    if (!tooth.tooth) return;
    give_length(tooth, *prepared[i], lengths.at(tooth.fdi), measured.contains(tooth.fdi), options);
  });
}

TriangleMesh in_millimetres(const CompletedTooth& tooth) {
  TriangleMesh mesh = tooth.mesh;
  for (Point& p : mesh.vertices) p *= tooth.record.millimetres_per_unit;
  return mesh;
}

SourcedTooth sourced(const CompletedTooth& tooth) {
  const CompletionRecord& record = tooth.record;
  return {in_millimetres(tooth),
          tooth.source,
          static_cast<int>(record.crown.kept_vertices.size()),
          record.crown.kept_triangles,
          record.millimetres_per_unit * lowest_of_crown(tooth),
          record.frame.growth_axis};
}

std::optional<double> millimetres(const std::optional<Approach>& approach) {
  return approach ? std::optional(approach->mm) : std::nullopt;
}

/// Of the teeth of one jaw: the jaws of a scan need not stand as they bite.
void measure_clearances(CompletedArch& arch, bool upper) {
  std::vector<std::optional<SolidSurface>> surfaces(arch.teeth.size());
  std::vector<const SolidSurface*> teeth(arch.teeth.size(), nullptr);
  parallel_tasks(arch.teeth.size(), [&](std::size_t i) {
    const ToothOfArch& tooth = arch.teeth[i];
    if (tooth.tooth && is_upper(tooth.fdi) == upper)
      teeth[i] = &surfaces[i].emplace(tooth_surface(in_millimetres(*tooth.tooth), crown_and_root(*tooth.tooth)));
  });
  for (const NeighbourClearance& pair : neighbour_clearances(teeth))
    arch.clearances.push_back({arch.teeth[pair.first].fdi, arch.teeth[pair.second].fdi,
                               millimetres(pair.clearance.crown_crown), millimetres(pair.clearance.root_root),
                               millimetres(pair.clearance.root_crown), millimetres(pair.clearance.crown_root)});
  std::vector<std::vector<double>> per_vertex = vertex_clearances(teeth);
  for (std::size_t i = 0; i < per_vertex.size(); ++i)
    if (teeth[i] != nullptr) arch.teeth[i].clearance = std::move(per_vertex[i]);
}

/// Takes the tooth's new surface back to where it is in `pressed`; it stays where that would not keep the promises.
void press(CompletedArch& arch, ToothOfArch& tooth, const TriangleMesh& pressed, double mm) {
  try {
    tooth.tooth = moved_tooth(tooth.crown, *tooth.tooth, pressed.vertices);
    mark_contacts(*tooth.tooth);
    tooth.tooth->record.warnings.push_back(
        fmt::format("Its new surface gave way by up to {:.2f} mm where it lay in a neighbour: the scan does not show "
                    "what is between them.",
                    mm));
  } catch (const NoResultError& error) {
    arch.notes.push_back(
        fmt::format("Tooth {} could not give way where it lies in a neighbour: {}", tooth.fdi, error.what()));
  }
}

/// Brings roots of one jaw apart; what cannot be is said in the arch's notes.
void resolve(CompletedArch& arch, const Prepared& prepared, const ArchOptions& options, bool upper) {
  std::vector<std::size_t> numbers;
  std::vector<SteerableRoot> roots;
  std::vector<SourcedTooth> teeth;
  for (std::size_t i = 0; i < arch.teeth.size(); ++i) {
    const ToothOfArch& tooth = arch.teeth[i];
    if (!tooth.tooth || is_upper(tooth.fdi) != upper) continue;
    const RootSteering& steering = tooth.tooth->options.steering;
    try {
      const CompletedTooth unsteered =
          steering.any() ? finish_tooth(prepared[i].value(), {}, options.tooth.transition) : *tooth.tooth;
      roots.push_back(steerable_root(unsteered, steering));
      roots.back().source = crown_and_root(unsteered);
    } catch (const Error& error) {
      arch.notes.push_back(
          fmt::format("Tooth {} was left out where roots were brought apart: {}", tooth.fdi, error.what()));
      continue;
    }
    numbers.push_back(i);
    const auto& interval = tooth.tooth->record.root.interval;
    if (interval && !options.root_lengths.contains(tooth.fdi))
      roots.back().shortest_mm = std::min(interval->length_low_mm, roots.back().length_mm);
    teeth.push_back(sourced(*tooth.tooth));
  }
  std::map<std::size_t, CompletedTooth> made;
  const auto finish = [&](std::size_t number, const RootSteering& steering) {
    const std::size_t i = numbers[number];
    CompletedTooth tooth = finish_tooth(prepared[i].value(), steering, options.tooth.transition);
    tooth.record.root.interval = arch.teeth[i].tooth->record.root.interval;
    mark_contacts(tooth);
    SourcedTooth handed_on = sourced(tooth);
    made.insert_or_assign(number, std::move(tooth));
    return handed_on;
  };
  ResolveOptions how;
  how.search.clearance = options.clearance_mm;
  const ResolvedCollisions resolved = resolve_collisions(roots, teeth, finish, how);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    ToothOfArch& tooth = arch.teeth[numbers[k]];
    if (resolved.cost_mm[k] != 0) {
      // The last that was made need not be the one that was taken.
      const auto last = made.find(k);
      if (last == made.end() || last->second.options.steering != resolved.steering[k]) finish(k, resolved.steering[k]);
      CompletedTooth& changed = made.at(k);
      keep_warnings(changed.record, tooth.tooth->record);
      tooth.tooth = std::move(changed);
      tooth.tooth->record.warnings.push_back(fmt::format(
          "The root was changed by {:.2f} mm at its end to keep clear of its neighbours.", resolved.cost_mm[k]));
    }
    if (resolved.pressed_mm[k] != 0) press(arch, tooth, resolved.teeth[k].mesh, resolved.pressed_mm[k]);
  }
  for (const UnresolvedCollision& left : resolved.unresolved) arch.notes.push_back(left.sentence);
  arch.notes.insert(arch.notes.end(), resolved.notes.begin(), resolved.notes.end());
}

CompletedArch complete(const LabelledScan& scan, const CompletionModels& models, const ArchOptions& options,
                       const ArchProgress& progress, ArchMemory* memory) {
  require_options_in_range(options);
  const CompletionModels::Content& content = *content_of(models);
  require_models_of_arch(models, options);
  return with_threads(options.tooth.threads, [&] {
    require_numbers_of_teeth(scan.fdi);
    CompletedArch arch;
    arch.teeth = cut(scan);
    require_lengths_of_teeth_there(arch.teeth, options);
    arch.gum = gum_of(scan.mesh, scan.fdi);
    require_size_of_arch(arch.teeth, options.tooth.millimetres_per_unit);
    const std::map<int, ToothDirections> directions =
        directions_of(arch.teeth, *content.arch, options.tooth.millimetres_per_unit, arch.upright);
    std::vector<MadeTooth> made = complete_each(arch.teeth, directions, models, options, progress, memory);
    const Prepared prepared = take(made, arch.teeth, memory != nullptr);
    heed_measured(arch.teeth, prepared, options, arch.notes);
    for (const bool upper : {true, false}) {
      if (options.resolve_collisions) resolve(arch, prepared, options, upper);
      measure_clearances(arch, upper);
    }
    if (memory != nullptr) *memory = memory_of(std::move(made), arch.teeth, directions, options.tooth);
    return arch;
  });
}

}  // namespace

void require_models_of_arch(const CompletionModels& models, const ArchOptions& options) {
  const CompletionModels::Content& content = *content_of(models);
  if (options.tooth.skirt && !content.skirt)
    throw InputError(
        "The models' folder has no weights to find a skirt with (skirt.safetensors), as arches need them.");
  if (!content.arch) throw InputError("The models' folder has no model of the arch (arch.safetensors).");
}

void require_options_in_range(const ArchOptions& options) {
  require_options_in_range(options.tooth);
  if (options.tooth.fdi || options.tooth.directions || options.tooth.steering.length_mm)
    throw UsageError(
        "Numbers, directions and root lengths are each tooth's own: they cannot be set for the whole arch.");
  if (!(options.clearance_mm >= 0 && options.clearance_mm <= 3))
    throw UsageError(
        fmt::format("A clearance of {} mm between roots is out of its range, 0 to 3 mm.", options.clearance_mm));
  for (const auto& [fdi, mm] : options.root_lengths)
    if (!(mm >= shortest_root_mm && mm <= longest_root_mm))
      throw UsageError(fmt::format("A root length of {} mm for tooth {} is out of its range, {} to {} mm.", mm, fdi,
                                   shortest_root_mm, longest_root_mm));
}

int CompletedArch::rooted() const {
  return static_cast<int>(
      std::count_if(teeth.begin(), teeth.end(), [](const ToothOfArch& t) { return t.tooth.has_value(); }));
}

std::optional<double> ToothClearance::of_roots() const {
  std::optional<double> least;
  for (const auto& mm : {root_root, root_crown, crown_root})
    if (mm && (!least || *mm < *least)) least = mm;
  return least;
}

CompletedArch complete_arch(const LabelledScan& scan, const CompletionModels& models, const ArchOptions& options,
                            const ArchProgress& progress) {
  return complete(scan, models, options, progress, nullptr);
}

CompletedArch complete_arch(const LabelledScan& scan, const CompletionModels& models, const ArchOptions& options,
                            const ArchProgress& progress, ArchMemory& memory) {
  return complete(scan, models, options, progress, &memory);
}

}  // namespace rhizodont
