// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The pieces of the solver, each against an evaluation that shares nothing with it: quadrature, dense matrices, closed
// forms.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "poisson/bspline.hpp"
#include "poisson/multigrid.hpp"
#include "poisson/normal_field.hpp"
#include "poisson/shapes.hpp"
#include "poisson/stencils.hpp"
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

/// Matrix of one axis: entry (i, j) = integral of f(x - i) g(x - j).
template <class F, class G>
Eigen::MatrixXd axis_matrix(int count, const F& f, const G& g) {
  Eigen::MatrixXd matrix(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) matrix(i, j) = integral([&](double x) { return f(x) * g(x - (j - i)); });
  return matrix;
}

SplineGrid small_grid(int degree) {
  SplineGrid grid;
  grid.degree = degree;
  grid.cells = {8, 10, 12};
  grid.origin = Point(-1.0, 2.0, 0.5);
  grid.spacing = 0.3;
  return grid;
}

std::vector<std::size_t> positions(const SplineGrid& grid) {
  std::vector<std::size_t> all;
  for (int z = 0; z < grid.functions(2); ++z)
    for (int y = 0; y < grid.functions(1); ++y)
      for (int x = 0; x < grid.functions(0); ++x) all.push_back(grid.index(x, y, z));
  return all;
}

std::vector<ScreeningSample> random_screening(const SplineGrid& grid, int count, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<ScreeningSample> samples;
  for (int s = 0; s < count; ++s) {
    const Eigen::Array3d at(grid.cells[0] * uniform(random), grid.cells[1] * uniform(random),
                            grid.cells[2] * uniform(random));
    samples.push_back({grid.origin + (grid.spacing * at).matrix(), uniform(random)});
  }
  return samples;
}

/// The operator as a dense matrix, from quadrature and the truncated powers.
Eigen::MatrixXd dense_operator(const SplineGrid& grid, const std::vector<ScreeningSample>& samples) {
  const int p = grid.degree;
  const auto value = [p](double x) { return spline(p, x); };
  const auto slope = [p](double x) { return spline_slope(p, x); };
  std::array<Eigen::MatrixXd, 3> mass, stiffness;
  for (int axis = 0; axis < 3; ++axis) {
    mass[static_cast<std::size_t>(axis)] = axis_matrix(grid.functions(axis), value, value);
    stiffness[static_cast<std::size_t>(axis)] = axis_matrix(grid.functions(axis), slope, slope);
  }
  const int nx = grid.functions(0), ny = grid.functions(1), count = nx * ny * grid.functions(2);
  const auto split = [&](int i) { return std::array<int, 3>{i % nx, i / nx % ny, i / (nx * ny)}; };
  Eigen::MatrixXd matrix(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const auto a = split(i), b = split(j);
      const auto m = [&](std::size_t axis) { return mass[axis](a[axis], b[axis]); };
      const auto k = [&](std::size_t axis) { return stiffness[axis](a[axis], b[axis]); };
      matrix(i, j) = grid.spacing * (k(0) * m(1) * m(2) + m(0) * k(1) * m(2) + m(0) * m(1) * k(2));
    }
  for (const ScreeningSample& sample : samples) {
    const Eigen::Vector3d at = (sample.position - grid.origin) / grid.spacing;
    Eigen::VectorXd values(count);
    for (int i = 0; i < count; ++i) {
      const auto a = split(i);
      values[i] = spline(p, at[0] - a[0]) * spline(p, at[1] - a[1]) * spline(p, at[2] - a[2]);
    }
    matrix += sample.weight * values * values.transpose();
  }
  return matrix;
}

class SolverOfDegree : public testing::TestWithParam<int> {
 protected:
  std::mt19937 random_{11};

  std::vector<double> random_field(const SplineGrid& grid) {
    std::normal_distribution<double> normal;
    std::vector<double> field(grid.size(), 0.0);
    for (const std::size_t i : positions(grid)) field[i] = normal(random_);
    return field;
  }
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

TEST_P(SolverOfDegree, OperatorIsTheDenseMatrix) {
  const SplineGrid grid = small_grid(GetParam());
  const auto samples = random_screening(grid, 40, random_);
  const Eigen::MatrixXd matrix = dense_operator(grid, samples);
  const std::vector<double> u = random_field(grid);
  std::vector<double> out(grid.size(), 0.0);
  apply_screened_laplacian(grid, samples, u, out);
  const auto at = positions(grid);
  Eigen::VectorXd x(matrix.rows()), y(matrix.rows());
  for (std::size_t i = 0; i < at.size(); ++i) {
    x[static_cast<Eigen::Index>(i)] = u[at[i]];
    y[static_cast<Eigen::Index>(i)] = out[at[i]];
  }
  EXPECT_LT((matrix * x - y).norm(), 1e-12 * y.norm());
  EXPECT_LE(dense_operator(grid, {}).selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff(),
            LaplaceStencil<double>(grid).largest_eigenvalue());
}

TEST_P(SolverOfDegree, RestrictionIsTheTransposeOfProlongation) {
  const SplineGrid grid = small_grid(GetParam());
  const SplineGrid parent = grid.coarser();
  const std::vector<double> fine = random_field(grid), coarse = random_field(parent);
  std::vector<double> restricted(parent.size(), 0.0), prolonged(grid.size(), 0.0);
  restrict_field(grid, fine, restricted);
  prolong_add(grid, coarse, prolonged);
  double a = 0.0, b = 0.0;
  for (std::size_t i = 0; i < coarse.size(); ++i) a += coarse[i] * restricted[i];
  for (std::size_t i = 0; i < fine.size(); ++i) b += fine[i] * prolonged[i];
  EXPECT_NEAR(a, b, 1e-12 * (std::abs(a) + 1.0));
}

TEST_P(SolverOfDegree, CoarseOperatorIsTheFineOneSeenFromTheCoarseGrid) {
  const SplineGrid grid = small_grid(GetParam());
  const SplineGrid parent = grid.coarser();
  const std::vector<double> coarse = random_field(parent);
  std::vector<double> prolonged(grid.size(), 0.0), product(grid.size(), 0.0), back(parent.size(), 0.0),
      direct(parent.size(), 0.0);
  prolong_add(grid, coarse, prolonged);
  apply_screened_laplacian(grid, {}, prolonged, product);
  restrict_field(grid, product, back);
  apply_screened_laplacian(parent, {}, coarse, direct);
  for (const std::size_t i : positions(parent)) EXPECT_NEAR(back[i], direct[i], 1e-12);
}

TEST_P(SolverOfDegree, ReachesTheToleranceByADenseResidual) {
  const SplineGrid grid = small_grid(GetParam());
  const auto samples = random_screening(grid, 60, random_);
  const std::vector<double> load = random_field(grid);
  const Eigen::MatrixXd matrix = dense_operator(grid, samples);
  const auto at = positions(grid);
  for (const double tolerance : {1e-4, 1e-8, 1e-11}) {
    const PoissonSolution solution = solve_screened_poisson(grid, samples, load, tolerance, 60);
    Eigen::VectorXd x(matrix.rows()), b(matrix.rows());
    for (std::size_t i = 0; i < at.size(); ++i) {
      x[static_cast<Eigen::Index>(i)] = solution.coefficients[at[i]];
      b[static_cast<Eigen::Index>(i)] = load[at[i]];
    }
    EXPECT_LE((b - matrix * x).norm(), 1.02 * tolerance * b.norm());
    EXPECT_NEAR(solution.relative_residual, (b - matrix * x).norm() / b.norm(), 0.02 * tolerance);
  }
}

TEST_P(SolverOfDegree, RecoversAManufacturedSolutionInFewCyclesOnALargerGrid) {
  SplineGrid grid;
  grid.degree = GetParam();
  grid.cells = {32, 40, 64};
  grid.spacing = 0.2;
  auto samples = random_screening(grid, 3000, random_);
  for (ScreeningSample& sample : samples) sample.weight *= 0.5;
  const std::vector<double> expected = random_field(grid);
  std::vector<double> load(grid.size(), 0.0);
  apply_screened_laplacian(grid, samples, expected, load);
  const PoissonSolution solution = solve_screened_poisson(grid, samples, load, 1e-10, 40);
  EXPECT_LE(solution.relative_residual, 1e-10);
  EXPECT_LE(solution.cycles, 25);
  double error = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i)
    error = std::max(error, std::abs(expected[i] - solution.coefficients[i]));
  EXPECT_LT(error, 1e-6);
}

/// The load tested with a linear function gives minus share times slope along the normal, however wide the smearing.
TEST_P(SolverOfDegree, NormalLoadIsExactOnLinearFunctions) {
  SplineGrid grid;
  grid.degree = GetParam();
  grid.cells = {64, 64, 64};
  grid.origin = Point(-6.4, -6.4, -6.4);
  grid.spacing = 0.2;
  const Eigen::Vector3d slope(0.7, -1.3, 0.4);
  OrientedPoints samples;
  samples.points = {Point(0.13, -0.21, 0.34)};
  samples.normals = {Eigen::Vector3d(2.0, 1.0, -2.0) / 3.0};
  for (const double share : {0.01, 0.05, 0.3, 1.0}) {
    std::vector<double> load(grid.size(), 0.0);
    add_normal_load(grid, samples, std::vector<double>{share}, 1.5, load);
    double tested = 0.0;
    for (int z = 0; z < grid.functions(2); ++z)
      for (int y = 0; y < grid.functions(1); ++y)
        for (int x = 0; x < grid.functions(0); ++x) {
          // The coefficients of a linear function are its values at the middles of the supports.
          const Eigen::Vector3d middle =
              grid.origin +
              grid.spacing * (Eigen::Vector3d(x, y, z) + Eigen::Vector3d::Constant(0.5 * (grid.degree + 1)));
          tested += slope.dot(middle) * load[grid.index(x, y, z)];
        }
    EXPECT_NEAR(tested, -share * slope.dot(samples.normals[0]), 1e-10) << share;
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, SolverOfDegree, testing::Values(1, 2));

TEST(SmearingWidth, GrowsWithTheShareBetweenItsBounds) {
  SplineGrid grid;
  grid.spacing = 0.2;
  EXPECT_DOUBLE_EQ(smearing_width(grid, 1e-4, 1.5), 0.2);
  EXPECT_DOUBLE_EQ(smearing_width(grid, 0.24, 1.5), 0.6);
  EXPECT_DOUBLE_EQ(smearing_width(grid, 100.0, 1.5), 1.6);
}

TEST(MergeSamples, KeepsWeightAndCentre) {
  const SplineGrid grid = small_grid(2);
  std::mt19937 random(3);
  const auto samples = random_screening(grid, 500, random);
  const auto merged = merge_samples(grid, samples);
  EXPECT_LE(merged.size(), 8U * 10U * 12U);
  double weight = 0.0, merged_weight = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), merged_centre = Eigen::Vector3d::Zero();
  for (const auto& s : samples) {
    weight += s.weight;
    centre += s.weight * s.position;
  }
  for (const auto& s : merged) {
    merged_weight += s.weight;
    merged_centre += s.weight * s.position;
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
