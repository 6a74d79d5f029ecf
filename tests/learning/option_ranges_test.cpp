// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/option_faults.hpp"
#include "learning/train_completion.hpp"
#include "learning/train_surface.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace rhizodont {
namespace {

using test::expect_each_refused_by_name;
using test::Fault;
using test::Faults;

constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(OptionRanges, OfTraining) {
  std::vector<Fault> faults;
  const auto both = [](const TrainingLoopOptions& loop) {
    CompletionTrainingOptions completion;
    completion.loop = loop;
    try {
      train_completion({}, completion);
      ADD_FAILURE() << "not refused by the trainer of the completion network";
    } catch (const UsageError&) {
    }
    SurfaceTrainingOptions surface;
    surface.loop = loop;
    train_surface({}, surface);
  };
  using L = TrainingLoopOptions;
  Faults<L>(faults, both)
      .of("batch", &L::batch, {0})
      .of("threads", &L::threads, {0, 17})
      .of("samples", &L::samples, {std::uint64_t{0}})
      .of("hours", &L::hours, {-0.1})
      .of("learning_rate", &L::learning_rate, {0.0})
      .of("lowest_rate", &L::lowest_rate, {-0.1, 1.1})
      .of("warm_up", &L::warm_up, {-1})
      .of("weight_decay", &L::weight_decay, {-0.1})
      .of("gradient_clip", &L::gradient_clip, {0.0})
      .of("average_decay", &L::average_decay, {-0.1, 1.1})
      .of("validation_samples", &L::validation_samples, {-1})
      .of("validation_minutes", &L::validation_minutes, {-0.1})
      .of("checkpoint_minutes", &L::checkpoint_minutes, {-0.1})
      .of("report_steps", &L::report_steps, {0})
      .set("count", [](L& o) { o.processes.count = 0; })
      .set("rank", [](L& o) { o.processes.rank = -1; })
      .set("rank", [](L& o) { o.processes.rank = 1; });
  using C = CompletionTrainingOptions;
  Faults<C>(faults, [](const C& o) { train_completion({}, o); })
      .of("unknown_share", &C::unknown_share, {-0.1, 1.1})
      .of("root_weight", &C::root_weight, {0.0})
      .of("coarse_weight", &C::coarse_weight, {-0.1})
      .of("denoise_weight", &C::denoise_weight, {-0.1})
      .of("chamfer_weight", &C::chamfer_weight, {-0.1})
      .of("normal_weight", &C::normal_weight, {-0.1})
      .of("spread_weight", &C::spread_weight, {-0.1})
      .of("denoise_queries", &C::denoise_queries, {-1})
      .of("denoise_jitter", &C::denoise_jitter, {-0.1});
  using S = SurfaceTrainingOptions;
  Faults<S>(faults, [](const S& o) { train_surface({}, o); })
      .of("pool", &S::pool, {std::uint64_t{0}})
      .of("tilt_radians", &S::tilt_radians, {-0.1})
      .of("scale_deviation", &S::scale_deviation, {-0.1});
  expect_each_refused_by_name(faults);
}

}  // namespace
}  // namespace rhizodont
