// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The pieces of the solver, each against an evaluation that shares nothing with it: quadrature, closed forms.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "poisson/bspline.hpp"
#include "poisson/field_sample.hpp"
#include "poisson/multigrid.hpp"
#include "poisson/normal_field.hpp"
#include "poisson/shapes.hpp"
#include "poisson/spline_level.hpp"
#include "poisson/surface_shares.hpp"

namespace rhizodont {
namespace {

/// Uniform B-spline that starts at 0, and its derivative, by the truncated powers.
double spline(int degree, double x) {
  double sum = 0.0, sign = 1.0, binomial = 1.0, factorial = 1.0;
  for (int k = 1; k <= degree; ++k) factorial *= k;
  for (int k = 0; k <= degree + 1; ++k) {
    if (x > k) sum += sign * binomial * std::pow(x - k, degree);
    sign = -sign;
    binomial = binomial * (degree + 1 - k) / (k + 1);
  }
  return sum / factorial;
}
double spline_slope(int degree, double x) { return spline(degree - 1, x) - spline(degree - 1, x - 1.0); }

/// Integral over the cells [0, degree + 4] by Gauss's rule of three points, exact for the products here.
template <class Function>
double integral(const Function& f) {
  double sum = 0.0;
  for (int cell = -4; cell < 8; ++cell)
    sum += (5.0 * f(cell + 0.5 - 0.5 * std::sqrt(0.6)) + 8.0 * f(cell + 0.5) +
            5.0 * f(cell + 0.5 + 0.5 * std::sqrt(0.6))) /
           18.0;
  return sum;
}

/// Levels around a small cluster of samples in one corner of a box, the coarsest complete, two more only near the
/// samples.
struct Cluster {
  explicit Cluster(int degree, std::mt19937& random) {
    LevelOptions options;
    options.degree = degree;
    options.spacing = 0.5;
    options.margin = 1.5;
    options.complete_cells = 4;
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<LevelSample> reach{{Point(0.0, 0.0, 0.0), 0}, {Point(4.0, 4.0, 4.0), 0}};
    for (int i = 0; i < 40; ++i) {
      const Point p(1.5 * uniform(random), 2.0 * uniform(random), uniform(random));
      reach.push_back({p, i % 4 == 0 ? 1 : 2});
    }
    Eigen::AlignedBox3d box;
    for (const LevelSample& sample : reach) box.extend(sample.position);
    levels = build_levels(lay_out_levels(box, options), reach, options);
    samples.resize(levels.size());
    for (const LevelSample& sample : reach) {
      std::size_t l = levels.size() - 1;
      const auto touches = [&] {
        bool any = false;
        for_each_function(levels[l], sample.position, [&](std::size_t f, double) { any = any || levels[l].active[f]; });
        return any;
      };
      while (l > 0 && !touches()) --l;
      samples[l].push_back({sample.position, uniform(random)});
    }
  }

  std::vector<SplineLevel> levels;
  std::vector<std::vector<ScreeningSample>> samples;
};

LevelField random_field(const std::vector<SplineLevel>& levels, std::mt19937& random) {
  std::normal_distribution<double> normal;
  LevelField field(field_size(levels), 0.0);
  for (const SplineLevel& level : levels)
    for (std::size_t i = 0; i < level.size(); ++i)
      if (level.active[i]) field[level.first + i] = normal(random);
  return field;
}

/// Value and gradient of the function that the coefficients stand for, level by level from the truncated powers.
FieldSample function_at(const std::vector<SplineLevel>& levels, const LevelField& field, const Point& p) {
  FieldSample sample;
  for (const SplineLevel& level : levels) {
    const Eigen::Vector3d at = (p - level.origin) / level.spacing;
    const std::array<int, 3> cell = cell_of(level, p);
    const int count = level.degree + 1;
    std::array<std::array<double, 3>, 3> value{}, slope{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = 0; k <= static_cast<std::size_t>(level.degree); ++k) {
        const double t = at[static_cast<Eigen::Index>(axis)] - cell[axis] + level.degree - static_cast<double>(k);
        value[axis][k] = spline(level.degree, t);
        slope[axis][k] = spline_slope(level.degree, t);
      }
    for (int n = 0; n < count * count * count; ++n) {
      const std::array<int, 3> k{n % count, n / count % count, n / (count * count)};
      const std::ptrdiff_t f =
          level.index(cell[0] - level.degree + k[0], cell[1] - level.degree + k[1], cell[2] - level.degree + k[2]);
      if (f < 0) continue;
      const double c = field[level.first + static_cast<std::size_t>(f)];
      const auto v = [&](std::size_t axis) { return value[axis][static_cast<std::size_t>(k[axis])]; };
      const auto s = [&](std::size_t axis) { return slope[axis][static_cast<std::size_t>(k[axis])]; };
      sample.value += c * v(0) * v(1) * v(2);
      sample.gradient +=
          c / level.spacing * Eigen::Vector3d(s(0) * v(1) * v(2), v(0) * s(1) * v(2), v(0) * v(1) * s(2));
    }
  }
  return sample;
}

double inner(const LevelField& a, const LevelField& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

class SolverOfDegree : public testing::TestWithParam<int> {
 protected:
  std::mt19937 random_{7};
};

TEST_P(SolverOfDegree, TablesAreTheIntegrals) {
  const int p = GetParam();
  const SplineTables tables = spline_tables(p);
  for (int k = -2; k <= 2; ++k) {
    const auto entry = static_cast<std::size_t>(k + 2);
    EXPECT_NEAR(tables.mass[entry], integral([&](double x) { return spline(p, x) * spline(p, x - k); }), 1e-14);
    EXPECT_NEAR(tables.stiffness[entry],
                integral([&](double x) { return spline_slope(p, x) * spline_slope(p, x - k); }), 1e-14);
    EXPECT_NEAR(tables.derivative[entry], integral([&](double x) { return spline_slope(p, x) * spline(p, x - k); }),
                1e-14);
  }
  for (const double x : {0.3, 0.9, 1.4, 2.2, 3.7, 5.1}) {
    double refined = 0.0;
    for (int k = 0; k < 4; ++k) refined += tables.refinement[static_cast<std::size_t>(k)] * spline(p, x - k);
    EXPECT_NEAR(refined, spline(p, 0.5 * x), 1e-14);
  }
}

TEST_P(SolverOfDegree, ValuesOnACellAreTheSplines) {
  const int p = GetParam();
  for (const double t : {0.0, 0.25, 0.8}) {
    const auto values = spline_values(p, t), slopes = spline_derivatives(p, t);
    for (int k = 0; k <= p; ++k) {
      EXPECT_NEAR(values[static_cast<std::size_t>(k)], spline(p, t + p - k), 1e-14);
      if (t > 0.0) {
        EXPECT_NEAR(slopes[static_cast<std::size_t>(k)], spline_slope(p, t + p - k), 1e-14);
      }
    }
  }
}

/// The bilinear form by Gauss's rule on the finest cells.
TEST_P(SolverOfDegree, OperatorIsTheBilinearForm) {
  const Cluster cluster(GetParam(), random_);
  const auto& levels = cluster.levels;
  ASSERT_EQ(levels.size(), 3U);
  EXPECT_FALSE(levels.back().complete);
  const LevelField u = random_field(levels, random_), v = random_field(levels, random_);
  const SplineLevel& finest = levels.back();
  const std::array<double, 3> node{0.5 - 0.5 * std::sqrt(0.6), 0.5, 0.5 + 0.5 * std::sqrt(0.6)};
  const std::array<double, 3> weight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  double form = 0.0;
  for (int z = 0; z < finest.cells[2]; ++z)
    for (int y = 0; y < finest.cells[1]; ++y)
      for (int x = 0; x < finest.cells[0]; ++x)
        for (std::size_t g = 0; g < 27; ++g) {
          const std::size_t i = g % 3, j = g / 3 % 3, k = g / 9;
          const Point p = finest.origin + finest.spacing * Eigen::Vector3d(x + node[i], y + node[j], z + node[k]);
          form += weight[i] * weight[j] * weight[k] * std::pow(finest.spacing, 3) *
                  function_at(levels, u, p).gradient.dot(function_at(levels, v, p).gradient);
        }
  for (const auto& samples : cluster.samples)
    for (const ScreeningSample& s : samples)
      form += s.weight * function_at(levels, u, s.position).value * function_at(levels, v, s.position).value;
  LevelField product(u.size());
  ScreenedLaplacian(levels, cluster.samples).apply(u, product);
  EXPECT_NEAR(inner(product, v), form, 1e-9 * std::abs(form) + 1e-9);
}

TEST_P(SolverOfDegree, ScreeningLoadTestsWithValues) {
  const Cluster cluster(GetParam(), random_);
  const LevelField v = random_field(cluster.levels, random_);
  LevelField load(v.size(), 0.0);
  add_screening_load(cluster.levels, cluster.samples, 0.7, load);
  double expected = 0.0;
  for (const auto& samples : cluster.samples)
    for (const ScreeningSample& s : samples)
      expected += 0.7 * s.weight * function_at(cluster.levels, v, s.position).value;
  EXPECT_NEAR(inner(load, v), expected, 1e-10);
}

TEST_P(SolverOfDegree, AccumulatedLevelsAreTheFunction) {
  const Cluster cluster(GetParam(), random_);
  const LevelField u = random_field(cluster.levels, random_);
  const LevelField sums = accumulated(cluster.levels, u);
  // The finest level alone, from its sums, where samples reach so deep.
  const std::vector<SplineLevel> finest{cluster.levels.back()};
  for (const ScreeningSample& s : cluster.samples.back())
    EXPECT_NEAR(function_at(finest, sums, s.position).value, function_at(cluster.levels, u, s.position).value, 1e-12);
}

TEST_P(SolverOfDegree, RecoversAFunctionToTheTolerance) {
  const Cluster cluster(GetParam(), random_);
  const LevelField u = random_field(cluster.levels, random_);
  LevelField load(u.size()), product(u.size());
  ScreenedLaplacian laplacian(cluster.levels, cluster.samples);
  laplacian.apply(u, load);
  const PoissonSolution solution = solve_screened_poisson(cluster.levels, cluster.samples, load, 1e-11, 100);
  EXPECT_LE(solution.relative_residual, 1.01e-11);
  laplacian.apply(solution.coefficients, product);
  double residual = 0.0;
  for (std::size_t i = 0; i < load.size(); ++i) residual += std::pow(load[i] - product[i], 2);
  EXPECT_NEAR(std::sqrt(residual / inner(load, load)), solution.relative_residual, 1e-14);
  // Coefficients are not unique, the function is.
  for (const auto& samples : cluster.samples)
    for (const ScreeningSample& s : samples)
      EXPECT_NEAR(function_at(cluster.levels, solution.coefficients, s.position).value,
                  function_at(cluster.levels, u, s.position).value, 1e-7);
}

TEST_P(SolverOfDegree, CyclesDoNotGrowWithFinerLevels) {
  const OrientedPoints sphere = shapes::sphere(4000, 4.0);
  for (const double spacing : {0.8, 0.4, 0.2}) {
    LevelOptions options;
    options.degree = GetParam();
    options.spacing = spacing;
    options.complete_cells = 16;
    Eigen::AlignedBox3d box;
    for (const Point& p : sphere.points) box.extend(p);
    const LevelLayout layout = lay_out_levels(box, options);
    std::vector<LevelSample> reach;
    std::vector<std::vector<ScreeningSample>> samples(static_cast<std::size_t>(layout.count));
    for (const Point& p : sphere.points) {
      reach.push_back({p, layout.count - 1});
      samples.back().push_back({p, 0.2});
    }
    const auto levels = build_levels(layout, reach, options);
    LevelField load(field_size(levels));
    ScreenedLaplacian(levels, samples).apply(random_field(levels, random_), load);
    EXPECT_LE(solve_screened_poisson(levels, samples, load, 1e-6, 100).cycles, GetParam() == 1 ? 12 : 40) << spacing;
  }
}

/// The load tested with a linear function gives minus share times slope along the normal, however wide the smearing.
TEST_P(SolverOfDegree, NormalLoadIsExactOnLinearFunctions) {
  LevelOptions options;
  options.degree = GetParam();
  options.complete_cells = 1000;
  const Eigen::AlignedBox3d box(Point(-5.0, -5.0, -5.0), Point(5.0, 5.0, 5.0));
  const auto levels = build_levels(lay_out_levels(box, options), {}, options);
  const Eigen::Vector3d slope(0.7, -1.3, 0.4);
  OrientedPoints samples;
  samples.points = {Point(0.13, -0.21, 0.34)};
  samples.normals = {Eigen::Vector3d(2.0, 1.0, -2.0) / 3.0};
  const double finest = static_cast<double>(levels.size()) - 1.0, share = 0.3;
  for (const double depth : {finest, finest - 0.4, finest - 1.0, finest - 1.7}) {
    const LevelField load = normal_load(levels, samples, std::vector<double>{share}, std::vector<double>{depth});
    for (std::size_t l = levels.size() - 2; l < levels.size(); ++l) {
      const SplineLevel& level = levels[l];
      double tested = 0.0;
      for (int z = 0; z < level.functions(2); ++z)
        for (int y = 0; y < level.functions(1); ++y)
          for (int x = 0; x < level.functions(0); ++x) {
            // The coefficients of a linear function are its values at the middles of the supports.
            const Eigen::Vector3d middle =
                level.origin +
                level.spacing * (Eigen::Vector3d(x, y, z) + Eigen::Vector3d::Constant(0.5 * (level.degree + 1)));
            tested += slope.dot(middle) * load[level.first + static_cast<std::size_t>(level.index(x, y, z))];
          }
      EXPECT_NEAR(tested, -share * slope.dot(samples.normals[0]), 1e-10) << depth << ' ' << l;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, SolverOfDegree, testing::Values(1, 2));

TEST(SplineLevels, StoreTheParentsOfAllTheyStore) {
  std::mt19937 random(8);
  const Cluster cluster(2, random);
  for (std::size_t l = 1; l < cluster.levels.size(); ++l)
    for (const auto& [x, y, z] : cluster.levels[l].blocks)
      for (int n = 0; n < 125; ++n) {
        const std::array<int, 3> f{4 * x - 1 + n % 5, 4 * y - 1 + n / 5 % 5, 4 * z - 1 + n / 25};
        bool in_box = true;
        for (int axis = 0; axis < 3; ++axis)
          in_box = in_box && f[static_cast<std::size_t>(axis)] >= 0 &&
                   f[static_cast<std::size_t>(axis)] < cluster.levels[l - 1].functions(axis);
        if (in_box) {
          EXPECT_GE(cluster.levels[l - 1].index(f[0], f[1], f[2]), 0);
        }
      }
}

TEST(SplineLevels, GrowWithAreaOverSquaredSpacing) {
  const OrientedPoints sphere = shapes::sphere(60000, 4.0);
  Eigen::AlignedBox3d box;
  for (const Point& p : sphere.points) box.extend(p);
  std::vector<double> counts;
  for (const double spacing : {0.4, 0.2, 0.1}) {
    LevelOptions options;
    options.spacing = spacing;
    const LevelLayout layout = lay_out_levels(box, options);
    std::vector<LevelSample> reach;
    for (const Point& p : sphere.points) reach.push_back({p, layout.count - 1});
    const auto levels = build_levels(layout, reach, options);
    counts.push_back(static_cast<double>(levels.back().blocks.size()));
  }
  EXPECT_LT(counts[2] / counts[1], 4.8) << "8 if it grew with volume";
}

TEST(MergeSamples, KeepsWeightAndCentre) {
  std::mt19937 random(3);
  const Cluster cluster(2, random);
  std::uniform_real_distribution<double> uniform(0.0, 4.0);
  std::vector<ScreeningSample> samples;
  for (int s = 0; s < 500; ++s)
    samples.push_back({Point(uniform(random), uniform(random), uniform(random)), 0.1 + 1e-3 * s});
  const auto merged = merge_samples(cluster.levels[1], samples);
  EXPECT_LT(merged.size(), samples.size());
  double weight = 0.0, merged_weight = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), merged_centre = Eigen::Vector3d::Zero();
  for (const auto& s : samples) {
    weight += s.weight;
    centre += s.weight * s.position;
  }
  std::set<std::array<int, 3>> cells;
  for (const auto& s : merged) {
    merged_weight += s.weight;
    merged_centre += s.weight * s.position;
    EXPECT_TRUE(cells.insert(cell_of(cluster.levels[1], s.position)).second) << "one per cell";
  }
  EXPECT_NEAR(merged_weight, weight, 1e-10);
  EXPECT_LT((merged_centre - centre).norm(), 1e-10);
}

TEST(SurfaceShares, SumToTheAreaForEvenAndRandomSamples) {
  std::mt19937 random(5);
  const auto total = [](const OrientedPoints& samples) {
    double sum = 0.0;
    for (const double share : surface_shares(samples, 10)) sum += share;
    return sum;
  };
  const double sphere = 4.0 * std::numbers::pi * 16.0;
  EXPECT_NEAR(total(shapes::sphere(3000, 4.0)) / sphere, 1.0, 0.08);
  const double torus = 4.0 * std::numbers::pi * std::numbers::pi * 5.0 * 1.5;
  EXPECT_NEAR(total(shapes::torus(3000, 5.0, 1.5, random)) / torus, 1.0, 0.1);
}

TEST(SurfaceShares, CountEachSideOfAThinPlate) {
  std::mt19937 random(6);
  const OrientedPoints plate = shapes::box(4000, {8.0, 6.0, 0.05}, random);
  double sum = 0.0;
  for (const double share : surface_shares(plate, 10)) sum += share;
  EXPECT_NEAR(sum / (2.0 * 48.0 + 2.0 * 0.05 * 14.0), 1.0, 0.12);
}

}  // namespace
}  // namespace rhizodont
