// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/crown_traits.hpp"

#include <Eigen/Core>

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace rhizodont {

/// A distribution around a mean, kept so that its density is a product and a logarithm. The tails are those of
/// Student's t, for crowns from scanners lie farther out than generated ones.
struct CrownDistribution {
  Eigen::VectorXd mean;
  Eigen::MatrixXd root;  ///< of the inverse covariance, lower triangle: root * (x - mean) is white

  /// Squared Mahalanobis distance.
  double squared_distance(const Eigen::VectorXd& x) const;
  /// Logarithm of the density, but for a constant that depends on the number of dimensions alone.
  double log_density(const Eigen::VectorXd& x) const;
};

/// What is known of one tooth type: how traits vary where a crown is of the type, and where it is of another or of the
/// other side.
struct TypeStatistics {
  Eigen::VectorXd mean_offsets;  ///< of CrownTraits::offsets
  Eigen::MatrixXd modes;         ///< principal components of the offsets, as columns
  CrownDistribution own, others;
  /// Weights of the difference of the traits as one side and as the other: ln of how much more probable the one is.
  Eigen::VectorXd side;
};

/// Statistics of generated crowns by which crowns are told apart.
struct LikenessModel {
  std::array<TypeStatistics, tooth_type_count> types;
  double type_weight = 1;    ///< > 0: of what tells types apart, in the probabilities
  double side_weight = 1;    ///< > 0: of what tells sides apart
  double type_bound = 0;     ///< ln of how much more probable another type has to be before it is said
  double side_bound = 0;     ///< likewise the other side
  double strange_bound = 1;  ///< > 0, mean squared deviation per dimension: farther is not like the tooth
  double refused_bound = 1;  ///< >= strange_bound: farther from all teeth is no crown
  std::map<std::string, std::string> metadata;
};

/// What an observer of the statistics makes of a crown.
struct Likeness {
  std::vector<double> probability;  ///< of each tooth whose traits were given, sum 1
  std::vector<double> type_lead;    ///< likewise: ln of how much more probable the best type is than the tooth's
  std::vector<double> side_lead;    ///< likewise: ln of how much more probable the tooth's other side is
  std::vector<double> strangeness;  ///< likewise: mean squared deviation per dimension from that tooth's crowns; 1 is
                                    ///< usual
};

/// Judges traits by the statistics; all teeth count as equally frequent, those whose traits are not given as
/// impossible.
Likeness likeness(const std::vector<ToothTraits>& traits, const LikenessModel& model);

/// A generated crown for the statistics.
struct LikenessSample {
  int type = 0;                     ///< 0..15, left side
  std::vector<ToothTraits> traits;  ///< those of this tooth first
};

/// Statistics and bounds from generated crowns: two thirds of each type for the distributions, the rest for weight and
/// bounds. Throws UsageError for fewer than 60 crowns of a type.
LikenessModel fit_likeness(const std::vector<LikenessSample>& samples);

/// Reads what save_likeness wrote. Throws InputError if the file is missing or damaged.
LikenessModel load_likeness(const std::filesystem::path& file);
void save_likeness(const LikenessModel& model, const std::filesystem::path& file);

}  // namespace rhizodont
