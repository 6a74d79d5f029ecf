// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "voronoi/predicates.hpp"

#include <gtest/gtest.h>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <boost/multiprecision/gmp.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>

namespace rhizodont {
namespace {

using Rational = boost::multiprecision::mpq_rational;
using Integer = boost::multiprecision::mpz_int;
using ExactPoint = std::array<Rational, 3>;

ExactPoint exact(const Point& p) { return {Rational(p.x()), Rational(p.y()), Rational(p.z())}; }

int sign(const Rational& x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

/// A site with the power weight that symbolic perturbation stands for: so small that it decides nothing but ties, and
/// so much larger than that of the next index that it decides those alone.
struct WeightedSite {
  ExactPoint position;
  Rational weight;
};

WeightedSite weighted(const Point& p, int index) { return {exact(p), Rational(1, Integer(1) << (400 * (index + 1)))}; }

Rational power(const WeightedSite& s, const ExactPoint& q) {
  Rational sum = -s.weight;
  for (std::size_t c = 0; c < 3; ++c) sum += (q[c] - s.position[c]) * (q[c] - s.position[c]);
  return sum;
}

/// Positive if q is nearer to p0 than to p.
Rational farther(const WeightedSite& p, const WeightedSite& p0, const ExactPoint& q) {
  return power(p, q) - power(p0, q);
}

/// The bisector of p0 and p1 met with the line through a and b.
std::optional<ExactPoint> on_line(const WeightedSite& p0, const WeightedSite& p1, const ExactPoint& a,
                                  const ExactPoint& b) {
  const Rational fa = farther(p1, p0, a);
  const Rational fb = farther(p1, p0, b);
  if (fa == fb) return {};
  const Rational t = fa / (fa - fb);
  ExactPoint q;
  for (std::size_t c = 0; c < 3; ++c) q[c] = a[c] + t * (b[c] - a[c]);
  return q;
}

/// The bisectors of p0 with p1 and with p2 met with the plane of a triangle, by Cramer's rule on barycentric weights.
std::optional<ExactPoint> in_plane(const WeightedSite& p0, const WeightedSite& p1, const WeightedSite& p2,
                                   const std::array<ExactPoint, 3>& t) {
  std::array<Rational, 3> f, g, w;
  for (std::size_t i = 0; i < 3; ++i) {
    f[i] = farther(p1, p0, t[i]);
    g[i] = farther(p2, p0, t[i]);
  }
  Rational sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    w[i] = f[j] * g[k] - f[k] * g[j];
    sum += w[i];
  }
  if (sum == 0) return {};
  ExactPoint q{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t c = 0; c < 3; ++c) q[c] += w[i] / sum * t[i][c];
  return q;
}

/// Four sites and a facet.
struct Configuration {
  std::array<Point, 4> p;
  std::array<Point, 3> q;
};

enum class Kind { general, lattice, cospherical, coinciding, symmetric, needle, clustered };

/// Configurations of a kind. All but general ones tie often.
class Configurations {
 public:
  explicit Configurations(Kind kind) : kind_(kind) {
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y)
        for (int z = -3; z <= 3; ++z)
          if (x * x + y * y + z * z == 9) on_sphere_.emplace_back(x, y, z);
  }

  Configuration next() {
    Configuration c;
    for (Point& p : c.p) p = kind_ == Kind::cospherical ? one_of(on_sphere_) : place();
    for (Point& q : c.q) q = place();
    if (kind_ == Kind::cospherical) c.q[2] = -c.q[0] - c.q[1];  // the sphere's centre in the facet
    // Two sites in one place, or two bisectors in one plane.
    if (kind_ == Kind::coinciding) c.p[2 + pick(2)] = c.p[static_cast<std::size_t>(pick(2))];
    if (kind_ == Kind::symmetric) {
      for (Point& q : c.q) q.z() = 0;
      Point& image = c.p[static_cast<std::size_t>(pick(4))];
      const Point& original = c.p[static_cast<std::size_t>(pick(4))];
      image = Point(original.x(), original.y(), -original.z());
    }
    if (kind_ == Kind::needle) {
      c.q[2] = 0.5 * (c.q[0] + c.q[1]);
      c.q[2].z() = std::nextafter(c.q[2].z(), 10);
    }
    // Steps of a few units in the last place, far from the origin.
    if (kind_ == Kind::clustered)
      for (Point* x : {&c.p[0], &c.p[1], &c.p[2], &c.p[3], &c.q[0], &c.q[1], &c.q[2]})
        *x = Point(20, -30, 40) + std::ldexp(1.0, -45) * *x;
    return c;
  }

 private:
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  const Point& one_of(const std::vector<Point>& points) {
    return points[static_cast<std::size_t>(pick(static_cast<int>(points.size())))];
  }
  Point place() {
    if (kind_ != Kind::general) return Point(pick(5) - 2, pick(5) - 2, pick(5) - 2);
    std::uniform_real_distribution<double> d(-10, 10);
    return Point(d(random_), d(random_), d(random_));
  }

  std::mt19937 random_{17};
  Kind kind_;
  std::vector<Point> on_sphere_;
};

/// A random order of indices for four sites.
std::array<std::int32_t, 4> some_order(std::mt19937& random) {
  std::array<std::int32_t, 4> order{0, 1, 2, 3};
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

bool is_tie(const WeightedSite& p, const WeightedSite& p0, const std::optional<ExactPoint>& q) {
  // Weights are below 2^-400 and rounded coordinates above 2^-60, so that their sixth powers stand apart.
  return q && abs(farther(p, p0, *q)) < Rational(1, Integer(1) << 380);
}

class Predicates : public testing::TestWithParam<Kind> {
 protected:
  static constexpr int trials = 1500;
  void expect_ties(int ties) const {
    if (GetParam() == Kind::general)
      EXPECT_EQ(ties, 0);
    else
      EXPECT_GT(ties, 2);
  }
};

TEST_P(Predicates, Side1AgreesWithPerturbedRationals) {
  Configurations make(GetParam());
  std::mt19937 random(1);
  int ties = 0;
  for (int n = 0; n < trials; ++n) {
    const auto [p, q] = make.next();
    const auto index = some_order(random);
    const WeightedSite p0 = weighted(p[0], index[0]), p1 = weighted(p[1], index[1]);
    EXPECT_EQ(side1({&p[0], index[0]}, {&p[1], index[1]}, q[0]), sign(farther(p1, p0, exact(q[0]))));
    ties += is_tie(p1, p0, exact(q[0])) ? 1 : 0;
  }
  if (GetParam() != Kind::needle && GetParam() != Kind::cospherical) expect_ties(ties);
}

TEST_P(Predicates, Side2AgreesWithPerturbedRationals) {
  Configurations make(GetParam());
  std::mt19937 random(2);
  int found = 0, ties = 0;
  for (int n = 0; n < trials; ++n) {
    const auto [p, q] = make.next();
    const auto index = some_order(random);
    const WeightedSite p0 = weighted(p[0], index[0]), p1 = weighted(p[1], index[1]), p2 = weighted(p[2], index[2]);
    const auto meeting = on_line(p0, p1, exact(q[0]), exact(q[1]));
    if (!meeting) continue;
    ++found;
    ties += is_tie(p2, p0, meeting) ? 1 : 0;
    const Site s0{&p[0], index[0]}, s1{&p[1], index[1]}, s2{&p[2], index[2]};
    EXPECT_EQ(side2(s0, s1, s2, q[0], q[1]), sign(farther(p2, p0, *meeting)));
    EXPECT_EQ(side2(s0, s1, s2, q[1], q[0]), side2(s0, s1, s2, q[0], q[1])) << "the segment has no direction";
    EXPECT_EQ(side2(s1, s0, s2, q[0], q[1]), side2(s0, s1, s2, q[0], q[1])) << "the point is as near to either";
  }
  EXPECT_GT(found, trials / 3);
  expect_ties(ties);
}

TEST_P(Predicates, Side3AgreesWithPerturbedRationals) {
  Configurations make(GetParam());
  std::mt19937 random(3);
  int found = 0, ties = 0;
  for (int n = 0; n < trials; ++n) {
    const auto [p, q] = make.next();
    const auto index = some_order(random);
    std::array<WeightedSite, 4> w;
    for (std::size_t k = 0; k < 4; ++k) w[k] = weighted(p[k], index[k]);
    const auto meeting = in_plane(w[0], w[1], w[2], {exact(q[0]), exact(q[1]), exact(q[2])});
    if (!meeting) continue;
    ++found;
    ties += is_tie(w[3], w[0], meeting) ? 1 : 0;
    const Site s0{&p[0], index[0]}, s1{&p[1], index[1]}, s2{&p[2], index[2]}, s3{&p[3], index[3]};
    const int side = side3(s0, s1, s2, s3, q[0], q[1], q[2]);
    EXPECT_EQ(side, sign(farther(w[3], w[0], *meeting)));
    EXPECT_EQ(side3(s0, s2, s1, s3, q[1], q[2], q[0]), side) << "the order says nothing";
    EXPECT_EQ(side3(s1, s0, s2, s3, q[0], q[1], q[2]), side) << "the point is as near to all three";
  }
  EXPECT_GT(found, trials / 10);
  expect_ties(ties);
}

std::string name_of(const testing::TestParamInfo<Kind>& info) {
  return std::array{
      "General", "Lattice", "Cospherical", "Coinciding", "Symmetric", "Needle", "Clustered"}[static_cast<std::size_t>(
      info.param)];
}
INSTANTIATE_TEST_SUITE_P(Configurations, Predicates,
                         testing::Values(Kind::general, Kind::lattice, Kind::cospherical, Kind::coinciding,
                                         Kind::symmetric, Kind::needle, Kind::clustered),
                         name_of);

TEST(PredicatesAtTheLimit, NearlyTiedPositionsAreDecidedExactly) {
  // q differs from the bisector by less than a rounded evaluation can see.
  const Point p0(0, 0, 0), p1(1e6, 0, 0);
  const double half = 5e5;
  EXPECT_EQ(side1({&p0, 0}, {&p1, 1}, Point(std::nextafter(half, 0.0), 1e6, 1e6)), 1);
  EXPECT_EQ(side1({&p0, 0}, {&p1, 1}, Point(std::nextafter(half, 1e9), 1e6, 1e6)), -1);
}

TEST(DelaunaySign, AgreesWithCotangentsOfAHundredDigits) {
  using Digits = boost::multiprecision::cpp_dec_float_100;
  const auto cotangent = [](const Point& a, const Point& b, const Point& apex) {
    std::array<Digits, 3> u, v;
    for (int i = 0; i < 3; ++i) {
      u[static_cast<std::size_t>(i)] = Digits(a[i]) - Digits(apex[i]);
      v[static_cast<std::size_t>(i)] = Digits(b[i]) - Digits(apex[i]);
    }
    Digits dot = 0, square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      dot += u[i] * v[i];
      const Digits cross = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
      square += cross * cross;
    }
    return std::pair<Digits, Digits>(dot, square);
  };
  int ties = 0, flat = 0;
  for (const Kind kind : {Kind::general, Kind::lattice, Kind::cospherical, Kind::symmetric}) {
    Configurations make(kind);
    for (int n = 0; n < 400; ++n) {
      const auto [p, q] = make.next();
      const auto [dot_c, square_c] = cotangent(p[0], p[1], p[2]);
      const auto [dot_d, square_d] = cotangent(p[0], p[1], p[3]);
      const int found = delaunay_sign(p[0], p[1], p[2], p[3]);
      EXPECT_EQ(delaunay_sign(p[1], p[0], p[3], p[2]), found);
      if (square_c == 0 || square_d == 0) {
        ++flat;
        continue;
      }
      const Digits sum = dot_c / sqrt(square_c) + dot_d / sqrt(square_d);
      const int expected = abs(sum) < 1e-60 ? 0 : (sum > 0 ? 1 : -1);
      ties += expected == 0 ? 1 : 0;
      EXPECT_EQ(found, expected);
    }
  }
  EXPECT_GT(ties, 10);
  EXPECT_GT(flat, 10);
}

TEST(DelaunaySign, TrianglesWithoutArea) {
  const Point a(0, 0, 0), b(2, 0, 0), between(1, 0, 0), beyond(3, 0, 0), above(1, 1, 0), far(1, 9, 0);
  EXPECT_EQ(delaunay_sign(a, b, between, far), -1) << "pi and more";
  EXPECT_EQ(delaunay_sign(a, b, between, beyond), 0) << "pi and 0";
  EXPECT_EQ(delaunay_sign(a, b, beyond, above), 1) << "0 and a right angle";
  EXPECT_EQ(delaunay_sign(a, b, a, above), 1) << "an apex at an end";
  EXPECT_EQ(delaunay_sign(a, b, between, between), -1);
}

}  // namespace
}  // namespace rhizodont
