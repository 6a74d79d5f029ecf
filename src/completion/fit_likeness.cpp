// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/likeness.hpp"
#include "completion/likeness_vector.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <utility>

namespace rhizodont {
namespace {

constexpr Eigen::Index mode_count = 12;
constexpr double pooled_share = 0.8;  // of a type's covariance that is the mean of all types'
constexpr double shrinkage = 0.05;    // of a covariance towards its diagonal
constexpr double side_shrinkage = 0.2;

/// A share of the values is at most this: of n values, the ceil(share (n + 1))-th (split conformal prediction).
double bound_for(std::vector<double> values, double share) {
  const auto n = static_cast<double>(values.size());
  const auto place = static_cast<std::ptrdiff_t>(std::clamp(std::ceil(share * (n + 1)), 1.0, n)) - 1;
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

struct Weighted {
  Eigen::VectorXd x;
  double weight = 1;
};

struct Moments {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

Moments moments_of(const std::vector<Weighted>& rows) {
  const Eigen::Index dimensions = rows.front().x.size();
  Moments m{Eigen::VectorXd::Zero(dimensions), Eigen::MatrixXd::Zero(dimensions, dimensions)};
  double sum = 0;
  for (const Weighted& row : rows) m.mean += row.weight * row.x, sum += row.weight;
  m.mean /= sum;
  for (const Weighted& row : rows) m.covariance += row.weight / sum * (row.x - m.mean) * (row.x - m.mean).transpose();
  return m;
}

/// Regularised discriminant analysis: J. H. Friedman, 1989.
CrownDistribution distribution_of(const Moments& own, const Eigen::MatrixXd& pooled) {
  Eigen::MatrixXd covariance = (1 - pooled_share) * own.covariance + pooled_share * pooled;
  covariance.diagonal() *= 1 + shrinkage;
  covariance.diagonal().array() += 1e-9;
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols());
  return {own.mean, factor.matrixL().solve(identity)};
}

/// Of a type, before the covariances are mixed with those of the others.
struct TypeMoments {
  Moments own, others;
};

using Samples = std::vector<const LikenessSample*>;

const CrownTraits* traits_of(const LikenessSample& sample, std::size_t tooth) {
  for (const ToothTraits& t : sample.traits)
    if (t.tooth == tooth) return &t.traits;
  return nullptr;
}

TypeMoments moments_of_type(int type, const Samples& samples, TypeStatistics& result) {
  const auto left = static_cast<std::size_t>(2 * type);
  std::vector<const CrownTraits*> own;
  for (const LikenessSample* sample : samples)
    if (sample->type == type) own.push_back(&sample->traits.front().traits);
  Eigen::MatrixXd offsets(static_cast<Eigen::Index>(own.size()), static_cast<Eigen::Index>(CrownTraits::place_count));
  for (std::size_t i = 0; i < own.size(); ++i)
    for (std::size_t k = 0; k < CrownTraits::place_count; ++k)
      offsets(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = static_cast<double>(own[i]->offsets[k]);
  result.mean_offsets = offsets.colwise().mean();
  const Eigen::MatrixXd centred = offsets.rowwise() - result.mean_offsets.transpose();
  result.modes = Eigen::BDCSVD<Eigen::MatrixXd>(centred, Eigen::ComputeThinV).matrixV().leftCols(mode_count);

  std::vector<Weighted> right_ones, mirrored, strangers;
  for (const LikenessSample* sample : samples)
    for (const ToothTraits& tooth : sample->traits) {
      if (tooth.tooth / 2 != left / 2) continue;
      const bool is_own = sample->type == type;
      std::vector<Weighted>& rows = !is_own ? strangers : tooth.tooth == left ? right_ones : mirrored;
      rows.push_back({likeness_vector(tooth.traits, result), 1});
    }
  // A third of what is not this tooth is its mirror image, which is the hardest to tell.
  for (Weighted& row : mirrored) row.weight = 1 / (3 * static_cast<double>(mirrored.size()));
  for (Weighted& row : strangers) row.weight = 2 / (3 * static_cast<double>(strangers.size()));
  mirrored.insert(mirrored.end(), strangers.begin(), strangers.end());
  return {moments_of(right_ones), moments_of(mirrored)};
}

/// Fisher's discriminant for the difference between a crown as left and as right tooth, whose mean changes its sign
/// with the side.
void learn_sides(const Samples& samples, LikenessModel& model) {
  std::array<Moments, tooth_type_count> moments;
  Eigen::MatrixXd pooled;
  for (std::size_t t = 0; t < model.types.size(); ++t) {
    std::vector<Weighted> differences;
    for (const LikenessSample* sample : samples) {
      if (static_cast<std::size_t>(sample->type) != t) continue;
      const CrownTraits* right = traits_of(*sample, 2 * t + 1);
      if (!right) continue;
      const TypeStatistics& type = model.types[t];
      differences.push_back({standardised(likeness_vector(sample->traits.front().traits, type), type) -
                                 standardised(likeness_vector(*right, type), type),
                             1});
    }
    moments[t] = moments_of(differences);
    if (t == 0) pooled = Eigen::MatrixXd::Zero(moments[t].covariance.rows(), moments[t].covariance.cols());
    pooled += moments[t].covariance / tooth_type_count;
  }
  pooled.diagonal() *= 1 + side_shrinkage;
  const Eigen::LDLT<Eigen::MatrixXd> factor(pooled);
  for (std::size_t t = 0; t < model.types.size(); ++t) model.types[t].side = 2 * factor.solve(moments[t].mean);
}

void learn_distributions(const Samples& samples, LikenessModel& model) {
  std::array<TypeMoments, tooth_type_count> moments;
  Eigen::MatrixXd own, others;
  for (int type = 0; type < tooth_type_count; ++type) {
    const auto t = static_cast<std::size_t>(type);
    moments[t] = moments_of_type(type, samples, model.types[t]);
    if (type == 0) own = others = Eigen::MatrixXd::Zero(moments[t].own.mean.size(), moments[t].own.mean.size());
    own += moments[t].own.covariance / tooth_type_count;
    others += moments[t].others.covariance / tooth_type_count;
  }
  for (std::size_t t = 0; t < model.types.size(); ++t) {
    model.types[t].own = distribution_of(moments[t].own, own);
    model.types[t].others = distribution_of(moments[t].others, others);
  }
}

/// Mean logarithm of the probability of the right tooth.
double mean_log_probability(const Samples& samples, const LikenessModel& model) {
  constexpr double least = 1e-9;  // one crown that was laid wrongly has no more say than that
  double sum = 0;
  for (const LikenessSample* sample : samples)
    sum += std::log(std::max(least, likeness(sample->traits, model).probability.front()));
  return sum / static_cast<double>(samples.size());
}

void set_weights(const Samples& held_out, LikenessModel& model) {
  constexpr std::array<double, 8> weights{0.1, 0.15, 0.2, 0.3, 0.4, 0.55, 0.75, 1};
  std::array<double, 2> best{1, 1};
  double most = -1e300;
  for (const double type : weights)
    for (const double side : weights) {
      model.type_weight = type, model.side_weight = side;
      if (const double p = mean_log_probability(held_out, model); p > most) most = p, best = {type, side};
    }
  model.type_weight = best[0], model.side_weight = best[1];
}

void set_bounds(const Samples& held_out, LikenessModel& model) {
  std::vector<double> type, side, strange, strange_to_all;
  for (const LikenessSample* sample : held_out) {
    const Likeness judged = likeness(sample->traits, model);
    type.push_back(judged.type_lead.front());
    side.push_back(judged.side_lead.front());
    strange.push_back(judged.strangeness.front());
    strange_to_all.push_back(*std::min_element(judged.strangeness.begin(), judged.strangeness.end()));
  }
  // Together at most about one crown in a hundred is warned of, and hardly any refused.
  model.type_bound = bound_for(type, 0.997);
  model.side_bound = bound_for(side, 0.997);
  model.strange_bound = bound_for(strange, 0.997);
  model.refused_bound = std::max(model.strange_bound, 1.5 * bound_for(strange_to_all, 0.999));
}

}  // namespace

LikenessModel fit_likeness(const std::vector<LikenessSample>& samples) {
  constexpr int fewest = 60, every = 3;
  std::array<int, tooth_type_count> count{};
  Samples learned, held_out;
  for (const LikenessSample& sample : samples) {
    const int place = count.at(static_cast<std::size_t>(sample.type))++;
    (place % every == every - 1 ? held_out : learned).push_back(&sample);
  }
  if (*std::min_element(count.begin(), count.end()) < fewest)
    throw UsageError("Statistics of crowns need at least 60 crowns of each type.");
  LikenessModel model;
  learn_distributions(learned, model);
  learn_sides(learned, model);
  set_weights(held_out, model);
  set_bounds(held_out, model);
  return model;
}

}  // namespace rhizodont
