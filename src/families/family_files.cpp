// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Reads the templates and the table of mean dimensions (Wheeler; Ash and Nelson, "Wheeler's Dental Anatomy").
#include "base/option_range.hpp"
#include "base/parallel_tasks.hpp"
#include "completion/registration.hpp"
#include "families/arch_directions.hpp"
#include "families/mean_teeth.hpp"
#include "families/register_tooth.hpp"
#include "families/registered_templates.hpp"
#include "families/self_crossing.hpp"
#include "families/tooth_family.hpp"
#include "families/tooth_template.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>

namespace rhizodont {
namespace {

double largest_number(const std::string& text) {
  double largest = 0;
  for (std::size_t i = 0; i < text.size();) {
    if (std::isdigit(static_cast<unsigned char>(text[i])) == 0) {
      ++i;
      continue;
    }
    std::size_t used = 0;
    largest = std::max(largest, std::stod(text.substr(i), &used));
    i += used;
  }
  return largest;
}

std::array<ToothDimensions, tooth_type_count> read_dimensions(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError("The table of tooth dimensions " + file.string() + " cannot be read.");
  std::array<ToothDimensions, tooth_type_count> all{};
  std::string line;
  std::getline(stream, line);
  int rows = 0;
  while (std::getline(stream, line)) {
    std::vector<std::string> fields;
    std::stringstream text(line);
    for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
    if (fields.size() < 9) continue;
    const auto slash = fields[1].find('/');
    if (slash == std::string::npos) throw InputError("A row of " + file.string() + " has no FDI pair such as 11/21.");
    const int type = tooth_type_of_fdi(std::atoi(fields[1].c_str() + slash + 1));
    ToothDimensions& d = all[static_cast<std::size_t>(type)];
    d.crown_height = largest_number(fields[3]);
    d.root_length = largest_number(fields[4]);
    d.crown_mesiodistal = largest_number(fields[5]);
    d.crown_buccolingual = largest_number(fields[7]);
    if (std::min({d.crown_height, d.root_length, d.crown_mesiodistal, d.crown_buccolingual}) <= 0)
      throw InputError("A dimension is missing in " + file.string() + " for " + fields[0] + ".");
    ++rows;
  }
  if (rows != tooth_type_count) throw InputError(file.string() + " does not have one row for each of the 16 teeth.");
  return all;
}

// Neighbours in the arch share forms; a first upper premolar with a single root is grown as a second one, and the other
// way round. Canines resemble no neighbour.
std::vector<TemplateLoan> possible_loans(const Population& population) {
  constexpr std::array<std::pair<int, int>, 13> pairs{{{1, 0},
                                                       {3, 4},
                                                       {4, 3},
                                                       {5, 6},
                                                       {6, 5},
                                                       {7, 6},
                                                       {8, 9},
                                                       {9, 8},
                                                       {11, 12},
                                                       {12, 11},
                                                       {13, 14},
                                                       {14, 13},
                                                       {15, 14}}};
  std::vector<TemplateLoan> loans;
  for (const auto& [type, from] : pairs)
    loans.push_back({type, from, population.teeth[static_cast<std::size_t>(type)].neighbour_share});
  return loans;
}

TriangleMesh enamel(const FamilyTemplate& tooth) {
  TriangleMesh crown;
  crown.vertices = tooth.mesh.vertices;
  for (const Triangle& t : tooth.mesh.triangles)
    if (std::all_of(t.begin(), t.end(), [&](int v) { return tooth.crown[static_cast<std::size_t>(v)] == 1; }))
      crown.triangles.push_back(t);
  return crown;
}

std::vector<Point> usual_crown(const ToothFamilies& families, const TemplateLoan& loan) {
  std::vector<Point> vertices = template_of(families, loan.from).mesh.vertices;
  constexpr double models_per_pair = 2;  // left and right
  for (const FamilyCrownModel& model : families.crown_models) {
    if (model.type != loan.type || model.from != loan.from) continue;
    const double share = (model.usual_share - model.template_share) / models_per_pair;
    for (std::size_t v = 0; v < vertices.size(); ++v)
      vertices[v] += share * model.modes.mean_shift.segment<3>(static_cast<Eigen::Index>(3 * v)).cast<double>();
  }
  return vertices;
}

// Templates stand in the arch turned each in its own way: what a borrowed one has against the type's own.
void measure_turns(ToothFamilies& families) {
  parallel_tasks(families.loans.size(), [&](std::size_t i) {
    TemplateLoan& loan = families.loans[i];
    const FamilyTemplate& own = families.templates[static_cast<std::size_t>(loan.type)];
    const TriangleMesh goal = enamel(own);
    TriangleMesh borrowed = enamel(template_of(families, loan.from));
    loan.crown = usual_crown(families, loan);
    borrowed.vertices = loan.crown;
    CanonicalFrame upright;
    upright.centre = area_centroid(goal);
    const SurfaceSamples samples = sample_surface(goal, 512, 1);
    MeanCrown mean;
    for (const Point& p : samples.points) mean.crown.points.push_back(upright.to_canonical(p));
    mean.crown.normals = samples.normals;
    const CrownFrame found = canonical_frame(prepare_crown(borrowed), fdi_of_type(loan.type, false), mean);
    const Eigen::Matrix3d& r = found.frame.rotation;
    loan.turn = -std::atan2(r(1, 0) - r(0, 1), r(0, 0) + r(1, 1));
    Eigen::Vector3d up = found.frame.direction_to_world(found.form_direction());
    // Molars also fit the wrong way round; in the arch neighbours stand alike.
    if (std::abs(loan.turn) > 0.6) loan.turn = 0, up = Eigen::Vector3d::UnitZ();
    loan.crown_axis = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ().eval(), up) *
                      (Eigen::AngleAxisd(loan.turn, Eigen::Vector3d::UnitZ()) *
                       families.crown_axes[static_cast<std::size_t>(loan.type)]);
  });
}

// Registered teeth beside their types' own templates, each as likely as these.
void add_registered(ToothFamilies& families, const FamilyLoadOptions& options, const std::vector<int>& wanted,
                    const std::array<TemplateFile, tooth_type_count>& files,
                    const std::array<Eigen::Vector3d, tooth_type_count>& buccal) {
  require_registered_teeth(options.registered);
  for (const int type : wanted) {
    const auto t = static_cast<std::size_t>(type);
    std::vector<FamilyTemplate> teeth =
        load_registered_teeth(options.registered, type, files[t], buccal[t], options.vertices);
    double own = 1;
    for (const TemplateLoan& loan : families.loans)
      if (loan.type == type) own -= loan.share;
    for (FamilyTemplate& tooth : teeth) {
      const int from = tooth_type_count + static_cast<int>(families.further.size());
      families.loans.push_back({type, from, own / static_cast<double>(teeth.size() + 1)});
      families.further.push_back(std::move(tooth));
    }
  }
}

// How far templates are brought towards the mean crown of their type's model: most of the way; what is left of their
// own form has finer grooves than a mean can have.
constexpr double template_share = 0.8;

void measure_crown(FamilyTemplate& tooth) {
  Eigen::AlignedBox3d crown;
  for (std::size_t v = 0; v < tooth.crown.size(); ++v)
    if (tooth.crown[v] == 1) crown.extend(tooth.mesh.vertices[v]);
  tooth.crown_height = crown.max().z();
  tooth.crown_width = crown.sizes().head<2>();
}

// Moves the template's crown towards the mean of its models; less where it would run into itself.
void approach_mean(FamilyTemplate& tooth, std::vector<FamilyCrownModel*> models) {
  const std::vector<Point> before = tooth.mesh.vertices;
  double share = template_share;
  for (int attempt = 0; attempt < 5; ++attempt, share *= 0.7) {
    for (std::size_t v = 0; v < before.size(); ++v) {
      Eigen::Vector3f shift = Eigen::Vector3f::Zero();
      for (const FamilyCrownModel* model : models)
        shift += model->modes.mean_shift.segment<3>(static_cast<Eigen::Index>(3 * v));
      tooth.mesh.vertices[v] = before[v] + share / static_cast<double>(models.size()) * shift.cast<double>();
    }
    if (crosses_itself(tooth.mesh)) continue;
    for (FamilyCrownModel* model : models) model->template_share = share;
    measure_crown(tooth);
    return;
  }
  tooth.mesh.vertices = before;
}

// The statistical crown models of a folder on the loaded templates. A third molar's template takes those of the second
// molar, for there are none of third molars; a second molar's lent to a third molar keeps its own.
class CrownModelLoader {
 public:
  CrownModelLoader(ToothFamilies& families, std::filesystem::path folder, std::size_t mode_count,
                   const std::array<Eigen::Vector3d, tooth_type_count>& buccal)
      : families_(families), folder_(std::move(folder)), mode_count_(mode_count), buccal_(buccal) {}

  void load(const std::vector<int>& types) {
    if (mode_count_ == 0 || !std::filesystem::exists(folder_)) return;
    std::vector<std::pair<int, int>> pairs;
    for (int type : types) pairs.emplace_back(type, type);
    add(pairs);
    for (int type : types) {
      std::vector<FamilyCrownModel*> models;
      if (type % 8 == 7) continue;
      for (FamilyCrownModel& model : families_.crown_models)
        if (model.type == type) models.push_back(&model);
      approach_mean(families_.templates[static_cast<std::size_t>(type)], models);
    }
    pairs.clear();
    for (const TemplateLoan& loan : families_.loans) {
      if (loan.type % 8 != 7 || loan.from >= tooth_type_count) {
        pairs.emplace_back(loan.type, loan.from);
        continue;
      }
      for (std::size_t i = 0, count = families_.crown_models.size(); i < count; ++i) {
        if (families_.crown_models[i].type != loan.from || families_.crown_models[i].from != loan.from) continue;
        FamilyCrownModel lent = families_.crown_models[i];
        lent.type = loan.type;
        families_.crown_models.push_back(std::move(lent));
      }
    }
    add(pairs);
  }

 private:
  void add(const std::vector<std::pair<int, int>>& pairs) {
    std::vector<FamilyCrownModel> added(2 * pairs.size());
    parallel_tasks(added.size(), [&](std::size_t i) {
      const auto [type, from] = pairs[i / 2];
      const int of = type % 8 == 7 ? type - 1 : type;
      const bool right_side = i % 2 == 1;
      const int fdi = fdi_of_type(of, right_side);
      const CrownShapeModel model = load_crown_shape_model(
          folder_ / ("crown_ssm_" + std::to_string(fdi) + ".safetensors"), mode_count_, right_side);
      FamilyCrownModel& result = added[i];
      result.type = type;
      result.from = from;
      result.usual_share = type % 8 == 7 ? 0.0 : type == from ? template_share : 0.9;
      const int place = from < tooth_type_count ? from : type;  // a further template stands as its type's own
      result.modes =
          carry_crown_model(template_of(families_, from), model, buccal_[static_cast<std::size_t>(place)], type < 8);
    });
    for (FamilyCrownModel& model : added) families_.crown_models.push_back(std::move(model));
  }

  ToothFamilies& families_;
  std::filesystem::path folder_;
  std::size_t mode_count_;
  const std::array<Eigen::Vector3d, tooth_type_count>& buccal_;
};

}  // namespace

ToothFamilies load_tooth_families(const std::filesystem::path& folder, const FamilyLoadOptions& options) {
  require_ranges("the tooth families", {{"vertices", options.vertices, OptionRange::at_least(500)},
                                        {"crown_modes", options.crown_modes, OptionRange::at_least(0).at_most(40)}});
  for (const int type : options.types)
    require_ranges("the tooth families", {{"types", type, OptionRange::at_least(0).below(tooth_type_count)}});
  ToothFamilies families;
  families.population = options.population.empty() ? default_population() : load_population(options.population);
  families.dimensions = read_dimensions(folder / "anatomy.csv");
  for (std::size_t type = 0; type < families.dimensions.size(); ++type)
    families.dimensions[type].root_length = families.population.teeth[type].root_length_mm;
  const std::array<TemplateFile, tooth_type_count> files = load_template_files(folder);
  std::vector<int> wanted = options.types;
  if (wanted.empty()) {
    wanted.resize(tooth_type_count);
    std::iota(wanted.begin(), wanted.end(), 0);
  }
  std::array<Eigen::Vector3d, tooth_type_count> buccal;
  parallel_tasks(wanted.size(), [&](std::size_t i) {
    const int type = wanted[i];
    const auto t = static_cast<std::size_t>(type);
    buccal[t] = buccal_of_template(files, type);
    families.templates[t] = analyse_template(files[t].mesh, files[t].crown, buccal[t], options.vertices);
  });
  for (const TemplateLoan& loan : possible_loans(families.population)) {
    const auto loaded = [&wanted](int type) { return std::find(wanted.begin(), wanted.end(), type) != wanted.end(); };
    if (loaded(loan.type) && loaded(loan.from)) families.loans.push_back(loan);
  }
  if (!options.registered.empty()) add_registered(families, options, wanted, files, buccal);
  CrownModelLoader(families, folder / "crowns" / "ssm", options.crown_modes, buccal).load(wanted);
  families.crown_axes.fill(Eigen::Vector3d::UnitZ());
  parallel_tasks(wanted.size(), [&](std::size_t i) {
    const SyntheticTooth mean = mean_tooth(families, wanted[i]);
    families.crown_axes[static_cast<std::size_t>(wanted[i])] =
        Eigen::AngleAxisd(-mean.crown_turn, Eigen::Vector3d::UnitZ()) * growth_axis(mean_crown(mean));
  });
  measure_turns(families);
  return families;
}

}  // namespace rhizodont
