// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/tooth_classifier.hpp"

#include "rhizodont/error.hpp"

#include <cmath>
#include <string>

namespace rhizodont {
namespace {

constexpr const char* classifier_weights = "The weights that tell teeth apart";

Eigen::VectorXd log_softmax(const Eigen::VectorXd& scores) {
  const double most = scores.maxCoeff();
  return scores.array() - most - std::log((scores.array() - most).exp().sum());
}

}  // namespace

std::size_t tooth_of_fdi(int fdi) {
  return 2 * static_cast<std::size_t>(tooth_type_of_fdi(fdi)) + (is_right_side(fdi) ? 1 : 0);
}

ToothClassifier::ToothClassifier(const TensorFile& file)
    : features_(file, classifier_weights),
      dense_{panorama_layer(file, "dense.0", 2, classifier_weights),
             panorama_layer(file, "dense.1", 2, classifier_weights)} {
  if (dense_[0].inputs != 2 * features_.channels() || dense_[1].inputs != dense_[0].weight.rows() ||
      dense_[1].weight.rows() != static_cast<Eigen::Index>(tooth_count) + 1)
    throw InputError(std::string(classifier_weights) + " do not fit each other.");
}

Eigen::VectorXd ToothClassifier::scores(const CrownPanorama& panorama) const {
  const Eigen::MatrixXf around = features_(panorama);
  Eigen::VectorXf pooled(2 * around.rows());
  pooled << around.rowwise().mean(), around.rowwise().maxCoeff();
  const Eigen::VectorXf hidden = (dense_[0].weight * pooled + dense_[0].bias).cwiseMax(0.0F);
  return (dense_[1].weight * hidden + dense_[1].bias).cast<double>();
}

ToothProbabilities ToothClassifier::operator()(const CrownPanorama& panorama) const {
  const Eigen::VectorXd straight = log_softmax(scores(panorama)), reflected = log_softmax(scores(mirrored(panorama)));
  Eigen::VectorXd mean(straight.size());
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    const bool is_tooth = i < static_cast<Eigen::Index>(tooth_count);
    mean[i] = 0.5 * (straight[i] + reflected[is_tooth ? i ^ 1 : i]);
  }
  mean = log_softmax(mean);
  ToothProbabilities result;
  for (std::size_t t = 0; t < tooth_count; ++t) result.log_tooth[t] = mean[static_cast<Eigen::Index>(t)];
  result.log_unlike = mean[static_cast<Eigen::Index>(tooth_count)];
  return result;
}

}  // namespace rhizodont
