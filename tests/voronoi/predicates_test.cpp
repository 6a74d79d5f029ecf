// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "voronoi/predicates.hpp"

#include <gtest/gtest.h>
#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <optional>
#include <random>

namespace rhizodont {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using ExactPoint = std::array<Rational, 3>;

ExactPoint exact(const Point& p) { return {Rational(p.x()), Rational(p.y()), Rational(p.z())}; }

Rational squared_distance(const ExactPoint& a, const ExactPoint& b) {
  Rational sum = 0;
  for (std::size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

ExactPoint combine(const std::array<Rational, 3>& weights, const std::array<ExactPoint, 3>& corners) {
  ExactPoint q{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t c = 0; c < 3; ++c) q[c] += weights[i] * corners[i][c];
  return q;
}

/// Signed difference d^2(p, q) - d^2(r, q): positive if q is nearer to r.
Rational farther(const ExactPoint& p, const ExactPoint& r, const ExactPoint& q) {
  return squared_distance(p, q) - squared_distance(r, q);
}

int sign(const Rational& x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

/// The bisector of p0 and p1 met with the line through a and b.
std::optional<ExactPoint> on_segment(const ExactPoint& p0, const ExactPoint& p1, const ExactPoint& a,
                                     const ExactPoint& b) {
  const Rational fa = farther(p1, p0, a);
  const Rational fb = farther(p1, p0, b);
  if (fa == fb) return {};
  const Rational t = fa / (fa - fb);
  if (t < 0 || t > 1) return {};
  return combine({1 - t, t, 0}, {a, b, b});
}

/// The bisectors of p0 with p1 and with p2 met with a triangle, by Cramer's rule on barycentric weights.
std::optional<ExactPoint> in_triangle(const ExactPoint& p0, const ExactPoint& p1, const ExactPoint& p2,
                                      const std::array<ExactPoint, 3>& t) {
  std::array<Rational, 3> f, g;
  for (std::size_t i = 0; i < 3; ++i) {
    f[i] = farther(p1, p0, t[i]);
    g[i] = farther(p2, p0, t[i]);
  }
  std::array<Rational, 3> w;
  Rational sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    w[i] = f[j] * g[k] - f[k] * g[j];
    sum += w[i];
  }
  if (sum == 0) return {};
  for (Rational& x : w) {
    x /= sum;
    if (x < 0) return {};
  }
  return combine(w, t);
}

/// Points with small integer coordinates meet in degenerate positions often; scaled and shifted ones never do.
class Configurations {
 public:
  explicit Configurations(bool degenerate) : degenerate_(degenerate) {}
  Point next() {
    if (degenerate_) {
      std::uniform_int_distribution<int> d(-2, 2);
      return Point(d(random_), d(random_), d(random_));
    }
    std::uniform_real_distribution<double> d(-10, 10);
    return Point(d(random_), d(random_), d(random_));
  }

 private:
  std::mt19937 random_{17};
  bool degenerate_;
};

class Predicates : public testing::TestWithParam<bool> {};

TEST_P(Predicates, Side1AgreesWithRationals) {
  Configurations make(GetParam());
  int ties = 0;
  for (int n = 0; n < 3000; ++n) {
    const Point p0 = make.next(), p1 = make.next(), q = make.next();
    const int expected = sign(farther(exact(p1), exact(p0), exact(q)));
    const int low_first = side1({&p0, 0}, {&p1, 1}, q);
    const int high_first = side1({&p0, 1}, {&p1, 0}, q);
    if (expected != 0) {
      EXPECT_EQ(low_first, expected);
      EXPECT_EQ(high_first, expected);
    } else {
      ++ties;
      EXPECT_EQ(low_first, 1) << "the lower index wins ties";
      EXPECT_EQ(high_first, -1);
    }
  }
  EXPECT_EQ(ties > 0, GetParam());
}

TEST_P(Predicates, Side2AgreesWithRationals) {
  Configurations make(GetParam());
  int decided = 0, ties = 0;
  for (int n = 0; n < 6000; ++n) {
    const Point p0 = make.next(), p1 = make.next(), p2 = make.next(), a = make.next(), b = make.next();
    const auto q = on_segment(exact(p0), exact(p1), exact(a), exact(b));
    if (!q) continue;
    const int expected = sign(farther(exact(p2), exact(p0), *q));
    const int found = side2({&p0, 0}, {&p1, 1}, {&p2, 2}, a, b);
    EXPECT_EQ(found, side2({&p0, 0}, {&p1, 1}, {&p2, 2}, b, a)) << "the segment has no direction";
    if (expected == 0) {
      ++ties;
      // With p0 and p1 interchanged the same point is asked about, and p2 loses or wins against both.
      EXPECT_EQ(found, side2({&p1, 1}, {&p0, 0}, {&p2, 2}, a, b));
      EXPECT_NE(found, 0);
      continue;
    }
    ++decided;
    EXPECT_EQ(found, expected);
  }
  EXPECT_GT(decided, 500);
  EXPECT_EQ(ties > 0, GetParam());
}

TEST_P(Predicates, Side3AgreesWithRationals) {
  Configurations make(GetParam());
  int decided = 0, ties = 0;
  for (int n = 0; n < 20000; ++n) {
    const Point p0 = make.next(), p1 = make.next(), p2 = make.next(), p3 = make.next();
    const Point a = make.next(), b = make.next(), c = make.next();
    const auto q = in_triangle(exact(p0), exact(p1), exact(p2), {exact(a), exact(b), exact(c)});
    if (!q) continue;
    const int expected = sign(farther(exact(p3), exact(p0), *q));
    const int found = side3({&p0, 0}, {&p1, 1}, {&p2, 2}, {&p3, 3}, a, b, c);
    EXPECT_EQ(found, side3({&p0, 0}, {&p2, 2}, {&p1, 1}, {&p3, 3}, b, c, a)) << "the order says nothing";
    if (expected == 0) {
      ++ties;
      EXPECT_EQ(found, side3({&p1, 1}, {&p0, 0}, {&p2, 2}, {&p3, 3}, a, b, c));
      continue;
    }
    ++decided;
    EXPECT_EQ(found, expected);
  }
  EXPECT_GT(decided, 300);
  EXPECT_EQ(ties > 0, GetParam());
}

TEST(PredicatesAtTheLimit, NearlyTiedPositionsAreDecidedExactly) {
  // q differs from the bisector by less than a rounded evaluation can see.
  const Point p0(0, 0, 0), p1(1e6, 0, 0);
  const double half = 5e5;
  EXPECT_EQ(side1({&p0, 0}, {&p1, 1}, Point(std::nextafter(half, 0.0), 1e6, 1e6)), 1);
  EXPECT_EQ(side1({&p0, 0}, {&p1, 1}, Point(std::nextafter(half, 1e9), 1e6, 1e6)), -1);
}

INSTANTIATE_TEST_SUITE_P(General, Predicates, testing::Values(false));
INSTANTIATE_TEST_SUITE_P(Degenerate, Predicates, testing::Values(true));

}  // namespace
}  // namespace rhizodont
