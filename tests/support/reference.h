#pragma once
// An evaluator in long double that shares nothing with the library: direct sums of the definition
// r = sum C(m,i) u^i (1-u)^(m-i) C(n,j) v^j (1-v)^(n-j) w_ij (V_ij, 1), and the quotient rule.

#include <array>
#include <cmath>
#include <vector>

#include "tessera/bezier_patch.h"

namespace tessera::test {

using Real = long double;

struct RealVec3 {
  Real x = 0, y = 0, z = 0;
  Vec3 rounded() const { return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}; }
};
inline RealVec3 operator+(RealVec3 a, RealVec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline RealVec3 operator-(RealVec3 a, RealVec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline RealVec3 operator*(Real s, RealVec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline RealVec3 cross(RealVec3 a, RealVec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline RealVec3 normalized(RealVec3 a) { return (1 / std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z)) * a; }

struct RealJet {
  RealVec3 position, du, dv, duu, duv, dvv;
};

/// t^k, 1 for k = 0; 0 for k < 0, where terms have a factor 0.
inline Real reference_power(Real t, int k) {
  Real value = k < 0 ? 0 : 1;
  for (; k > 0; --k) value *= t;
  return value;
}
/// The Bernstein polynomial or its first or second derivative, from the product rule on t^i (1-t)^(n-i).
inline Real reference_bernstein(int n, int i, Real t, int order = 0) {
  Real binomial = 1;
  for (int k = 1; k <= i; ++k) binomial = binomial * (n - i + k) / k;
  const Real s = 1 - t;
  const int j = n - i;
  const auto term = [&](Real factor, int a, int b) {
    return factor == 0 ? 0 : factor * reference_power(t, a) * reference_power(s, b);
  };
  if (order == 0) return binomial * term(1, i, j);
  if (order == 1) return binomial * (term(i, i - 1, j) - term(j, i, j - 1));
  return binomial *
         (term(Real(i) * (i - 1), i - 2, j) - 2 * term(Real(i) * j, i - 1, j - 1) + term(Real(j) * (j - 1), i, j - 2));
}

/// The basis polynomials of one parameter, `[order][i]`, orders 0 to 2.
using ReferenceBernstein = std::array<std::vector<Real>, 3>;
inline ReferenceBernstein reference_bernsteins(int degree, Real t) {
  ReferenceBernstein basis;
  for (int order = 0; order <= 2; ++order)
    for (int i = 0; i <= degree; ++i)
      basis[static_cast<std::size_t>(order)].push_back(reference_bernstein(degree, i, t, order));
  return basis;
}

/// Derivative of order (a, b) of the numerator, and of the denominator in `weight`.
inline RealVec3 reference_sum(const BezierPatch& patch, const ReferenceBernstein& u, const ReferenceBernstein& v, int a,
                              int b, Real& weight) {
  RealVec3 sum;
  weight = 0;
  for (int i = 0; i <= patch.degree_u(); ++i)
    for (int j = 0; j <= patch.degree_v(); ++j) {
      const Real factor = u[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)] *
                          v[static_cast<std::size_t>(b)][static_cast<std::size_t>(j)] * Real(patch.weight(i, j));
      const Vec3& p = patch.point(i, j);
      sum = sum + factor * RealVec3{p.x, p.y, p.z};
      weight += factor;
    }
  return sum;
}
inline RealVec3 reference_sum(const BezierPatch& patch, Real u, Real v, int a, int b, Real& weight) {
  return reference_sum(patch, reference_bernsteins(patch.degree_u(), u), reference_bernsteins(patch.degree_v(), v), a,
                       b, weight);
}

inline RealJet reference_jet(const BezierPatch& patch, Real u, Real v) {
  const ReferenceBernstein f = reference_bernsteins(patch.degree_u(), u), g = reference_bernsteins(patch.degree_v(), v);
  Real w, wu, wv, wuu, wuv, wvv;
  const RealVec3 a = reference_sum(patch, f, g, 0, 0, w);
  const RealVec3 au = reference_sum(patch, f, g, 1, 0, wu), av = reference_sum(patch, f, g, 0, 1, wv);
  const RealVec3 auu = reference_sum(patch, f, g, 2, 0, wuu), avv = reference_sum(patch, f, g, 0, 2, wvv);
  const RealVec3 auv = reference_sum(patch, f, g, 1, 1, wuv);
  if (!patch.is_rational()) return {a, au, av, auu, auv, avv};
  RealJet jet;
  jet.position = (1 / w) * a;
  jet.du = (1 / w) * (au - wu * jet.position);
  jet.dv = (1 / w) * (av - wv * jet.position);
  jet.duu = (1 / w) * (auu - 2 * wu * jet.du - wuu * jet.position);
  jet.duv = (1 / w) * (auv - wu * jet.dv - wv * jet.du - wuv * jet.position);
  jet.dvv = (1 / w) * (avv - 2 * wv * jet.dv - wvv * jet.position);
  return jet;
}

/// The formulas of section 3.3 of do Carmo's Differential Geometry of Curves and Surfaces for a jet with independent
/// tangents: S is the second form in the orthonormal basis e1 = r_u / |r_u|, e2 = N x e1.
struct RealGeometry {
  RealVec3 normal, first_form, second_form, first_direction, second_direction;
  Real gaussian = 0, mean = 0, first = 0, second = 0;  ///< first >= second
};
inline Real dot(RealVec3 a, RealVec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline RealGeometry reference_geometry(const RealJet& jet) {
  RealGeometry g;
  g.normal = normalized(cross(jet.du, jet.dv));
  g.first_form = {dot(jet.du, jet.du), dot(jet.du, jet.dv), dot(jet.dv, jet.dv)};
  g.second_form = {dot(jet.duu, g.normal), dot(jet.duv, g.normal), dot(jet.dvv, g.normal)};
  const RealVec3 e1 = normalized(jet.du), e2 = cross(g.normal, e1);
  // Parameters of e1 and e2: r_u = a e1, r_v = b e1 + c e2.
  const Real a = dot(jet.du, e1), b = dot(jet.dv, e1), c = dot(jet.dv, e2);
  const Real u1 = 1 / a, u2 = -b / (a * c), v2 = 1 / c;
  const auto [l, m, n] = g.second_form;
  const Real s11 = u1 * u1 * l, s12 = u1 * (u2 * l + v2 * m), s22 = u2 * u2 * l + 2 * u2 * v2 * m + v2 * v2 * n;
  g.gaussian = s11 * s22 - s12 * s12;
  g.mean = (s11 + s22) / 2;
  const Real radius = std::hypot((s11 - s22) / 2, s12);
  g.first = g.mean + radius;
  g.second = g.mean - radius;
  // An eigenvector is orthogonal to each row of S - k1; the longer row is the safer one.
  const Real x = s11 > s22 ? g.first - s22 : s12, y = s11 > s22 ? s12 : g.first - s11, size = std::hypot(x, y);
  if (size > 0) g.first_direction = (x / size) * e1 + (y / size) * e2;
  g.second_direction = cross(g.normal, g.first_direction);
  return g;
}

inline Vec3 reference_position(const BezierPatch& patch, Real u, Real v) {
  Real weight;
  const RealVec3 sum = reference_sum(patch, u, v, 0, 0, weight);
  return patch.is_rational() ? ((1 / weight) * sum).rounded() : sum.rounded();
}
/// r_u x r_v / |r_u x r_v|; requires that this is not zero.
inline Vec3 reference_normal(const BezierPatch& patch, double u, double v) {
  const RealJet jet = reference_jet(patch, u, v);
  return normalized(cross(jet.du, jet.dv)).rounded();
}

}  // namespace tessera::test
