// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// B. Levy and N. Bonneel, "Variational anisotropic surface meshing with Voronoi parallel linear enumeration",
//   Proc. 21st International Meshing Roundtable, 2013: the side predicates.
// H. Edelsbrunner and E. P. Muecke, "Simulation of simplicity", ACM Transactions on Graphics 9(1), 1990.
//
// Notation: l_k = |p_k - p_0|^2, a_ki = 2 (p_k - p_0).(q_i - p_0). With q = sum_i Lambda_i q_i the bisector of p_0 and
// p_k is sum_i Lambda_i a_ki = l_k, and q is nearer to p_0 where l_k - sum_i Lambda_i a_ki > 0. A power weight w on the
// sites replaces l_k by l_k + w_0 - w_k.

#include "voronoi/predicates.hpp"

#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rhizodont {
namespace {

using Exact = CGAL::Exact_rational;

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

template <class Number>
int sign_of(const Number& x) {
  return x > Number(0) ? 1 : (x < Number(0) ? -1 : 0);
}

/// Differences p_k - p_0 and q_i - p_0, and the forms made of them, for K further sites and Q points.
template <class Number, int K, int Q>
struct Forms {
  std::array<Number, K> l;
  std::array<std::array<Number, Q>, K> a;
  double largest = 0;  // largest |difference|, for the filter

  Forms(const Point& p0, const std::array<const Point*, K>& p, const std::array<const Point*, Q>& q) {
    std::array<std::array<Number, 3>, Q> dq;
    for (int i = 0; i < Q; ++i)
      for (int c = 0; c < 3; ++c) dq[i][c] = difference((*q[i])[c], p0[c]);
    for (int k = 0; k < K; ++k) {
      std::array<Number, 3> dp;
      for (int c = 0; c < 3; ++c) dp[c] = difference((*p[k])[c], p0[c]);
      l[k] = dp[0] * dp[0] + dp[1] * dp[1] + dp[2] * dp[2];
      for (int i = 0; i < Q; ++i) {
        a[k][i] = dp[0] * dq[i][0] + dp[1] * dq[i][1] + dp[2] * dq[i][2];
        a[k][i] = a[k][i] + a[k][i];
      }
    }
  }

 private:
  Number difference(double x, double y) {
    const Number d = Number(x) - Number(y);
    if constexpr (std::is_same_v<Number, double>) largest = std::max(largest, std::abs(d));
    return d;
  }
};

/// r and Delta of a predicate with the derivatives of r by the weights of its sites: the result is
/// sign(Delta) sign(r), or with r = 0 that of the first derivative that is not zero, by index of the sites.
template <class Number, int N>
struct Evaluation {
  Number r;
  Number delta;
  std::array<Number, N> by_weight;
};

template <class Number>
Evaluation<Number, 2> evaluate1(const Forms<Number, 1, 1>& f) {
  return {f.l[0] - f.a[0][0], Number(1), {Number(1), Number(-1)}};
}

template <class Number>
Evaluation<Number, 3> evaluate2(const Forms<Number, 2, 2>& f) {
  const Number delta = f.a[0][1] - f.a[0][0];
  const Number lambda0 = f.a[0][1] - f.l[0];
  const Number lambda1 = f.l[0] - f.a[0][0];
  const Number r = delta * f.l[1] - f.a[1][0] * lambda0 - f.a[1][1] * lambda1;
  const Number slope = f.a[1][1] - f.a[1][0];
  return {r, delta, {delta - slope, slope, -delta}};
}

template <class Number>
Evaluation<Number, 4> evaluate3(const Forms<Number, 3, 3>& f) {
  const auto& a1 = f.a[0];
  const auto& a2 = f.a[1];
  const auto& a3 = f.a[2];
  Number r = Number(0);
  Number delta = Number(0);
  Number by1 = Number(0);  // sum_i b_i1 a_3i
  Number by2 = Number(0);  // sum_i b_i2 a_3i
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const Number b0 = a1[j] * a2[k] - a1[k] * a2[j];
    const Number b1 = a2[j] - a2[k];
    const Number b2 = a1[k] - a1[j];
    const Number lambda = b0 + b1 * f.l[0] + b2 * f.l[1];
    delta = delta + b0;
    r = r - a3[i] * lambda;
    by1 = by1 + b1 * a3[i];
    by2 = by2 + b2 * a3[i];
  }
  r = r + delta * f.l[2];
  return {r, delta, {delta - by1 - by2, by1, by2, -delta}};
}

template <int N>
int perturbed_sign(const Evaluation<Exact, N>& exact, const std::array<std::int32_t, N>& index) {
  const int sign_delta = sign_of(exact.delta);
  if (const int s = sign_of(exact.r); s != 0) return sign_delta * s;
  std::array<int, N> order;
  for (int k = 0; k < N; ++k) order[k] = k;
  std::sort(order.begin(), order.end(), [&](int x, int y) { return index[x] < index[y]; });
  for (const int k : order)
    if (const int s = sign_of(exact.by_weight[k]); s != 0) return sign_delta * s;
  return -1;
}

/// Sound if |x| > bound, bound >= the largest error of the evaluation of x in floating point.
/// The constants are (largest sum of magnitudes of the terms) x (depth of the evaluation), rounded up to a power of
/// two.
int filtered_sign(double x, double bound) { return x > bound ? 1 : (x < -bound ? -1 : 0); }

/// An angle by what its cotangent is made of: the dot product of its arms, and the square of the norm of their cross
/// product.
struct Cotangent {
  Exact dot;
  Exact squared_cross;

  Cotangent(const Point& a, const Point& b, const Point& apex) {
    std::array<Exact, 3> u, v;
    for (int i = 0; i < 3; ++i) {
      u[i] = Exact(a[i]) - Exact(apex[i]);
      v[i] = Exact(b[i]) - Exact(apex[i]);
    }
    dot = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    for (int i = 0; i < 3; ++i) {
      const Exact cross = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
      squared_cross += cross * cross;
    }
  }
};

}  // namespace

int side1(Site p0, Site p1, const Point& q0) {
  const Forms<double, 1, 1> f(*p0.position, {p1.position}, {&q0});
  const double m2 = f.largest * f.largest;
  if (const int s = filtered_sign(evaluate1(f).r, 128 * unit_roundoff * m2); s != 0) return s;
  return perturbed_sign<2>(evaluate1(Forms<Exact, 1, 1>(*p0.position, {p1.position}, {&q0})), {p0.index, p1.index});
}

int side2(Site p0, Site p1, Site p2, const Point& q0, const Point& q1) {
  const Forms<double, 2, 2> f(*p0.position, {p1.position, p2.position}, {&q0, &q1});
  const double m2 = f.largest * f.largest;
  const auto e = evaluate2(f);
  const int sign_delta = filtered_sign(e.delta, 256 * unit_roundoff * m2);
  const int sign_r = filtered_sign(e.r, 8192 * unit_roundoff * m2 * m2);
  if (sign_delta != 0 && sign_r != 0) return sign_delta * sign_r;
  return perturbed_sign<3>(evaluate2(Forms<Exact, 2, 2>(*p0.position, {p1.position, p2.position}, {&q0, &q1})),
                           {p0.index, p1.index, p2.index});
}

int side3(Site p0, Site p1, Site p2, Site p3, const Point& q0, const Point& q1, const Point& q2) {
  const std::array<const Point*, 3> p{p1.position, p2.position, p3.position};
  const std::array<const Point*, 3> q{&q0, &q1, &q2};
  const Forms<double, 3, 3> f(*p0.position, p, q);
  const double m2 = f.largest * f.largest;
  const auto e = evaluate3(f);
  const int sign_delta = filtered_sign(e.delta, 8192 * unit_roundoff * m2 * m2);
  const int sign_r = filtered_sign(e.r, 262144 * unit_roundoff * m2 * m2 * m2);
  if (sign_delta != 0 && sign_r != 0) return sign_delta * sign_r;
  return perturbed_sign<4>(evaluate3(Forms<Exact, 3, 3>(*p0.position, p, q)), {p0.index, p1.index, p2.index, p3.index});
}

int delaunay_sign(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto certainly_acute = [&](const Point& apex) {
    const Eigen::Vector3d u = a - apex;
    const Eigen::Vector3d v = b - apex;
    return u.dot(v) > 8 * unit_roundoff * u.norm() * v.norm();
  };
  if (certainly_acute(c) && certainly_acute(d)) return 1;
  const Cotangent at_c(a, b, c);
  const Cotangent at_d(a, b, d);
  const int sign_c = sign_of(at_c.dot);
  const int sign_d = sign_of(at_d.dot);
  const bool flat_c = sign_of(at_c.squared_cross) == 0;
  const bool flat_d = sign_of(at_d.squared_cross) == 0;
  // An angle of 0 leaves the other to be less than pi, or equal to it.
  if (flat_c && sign_c >= 0) return flat_d && sign_d < 0 ? 0 : 1;
  if (flat_d && sign_d >= 0) return flat_c ? 0 : 1;
  if (flat_c || flat_d) return -1;
  if (sign_c >= 0 && sign_d >= 0) return sign_c + sign_d > 0 ? 1 : 0;
  if (sign_c <= 0 && sign_d <= 0) return -1;
  const Exact square_c = at_c.dot * at_c.dot * at_d.squared_cross;
  const Exact square_d = at_d.dot * at_d.dot * at_c.squared_cross;
  return sign_c > 0 ? sign_of(Exact(square_c - square_d)) : sign_of(Exact(square_d - square_c));
}

}  // namespace rhizodont
