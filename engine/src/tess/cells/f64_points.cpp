#include "tess/cells/f64_points.h"

#include <algorithm>
#include <array>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t at(int k) { return static_cast<std::size_t>(k); }

/// C(n,k) for all degrees, by Pascal's triangle.
constexpr auto binomials = [] {
  std::array<std::array<double, max_degree + 1>, max_degree + 1> all{};
  for (std::size_t n = 0; n <= max_degree; ++n) {
    all[n][0] = 1;
    for (std::size_t k = 1; k <= n; ++k) all[n][k] = all[n - 1][k - 1] + all[n - 1][k];
  }
  return all;
}();

/// The weights C(n,k) (t^k s^(n-k)) at the fractions t and s = 1 - t. B_k at t is B_{n-k} at s, bit for bit.
struct Weights {
  std::array<double, max_degree + 1> value;

  Weights(int degree, Segments::Fraction fraction) {
    std::array<double, max_degree + 1> t, s;  // powers
    t[0] = s[0] = 1;
    for (int k = 1; k <= degree; ++k) {
      t[at(k)] = t[at(k - 1)] * fraction.value();
      s[at(k)] = s[at(k - 1)] * fraction.rest();
    }
    for (int k = 0; k <= degree; ++k) value[at(k)] = binomials[at(degree)][at(k)] * (t[at(k)] * s[at(degree - k)]);
  }
};

/// Returns the sum of weights.value[k] * point(k), k = 0 .. degree. The bits are the same if both run the other way.
template <class Point>
Homogeneous symmetric_sum(int degree, const Weights& weights, Point point) {
  const auto term = [&](int k) { return weights.value[at(k)] * point(k); };
  Homogeneous sum = term(0) + term(degree);
  for (int k = 1; 2 * k < degree; ++k) sum = sum + (term(k) + term(degree - k));
  if (degree % 2 == 0) sum = sum + term(degree / 2);
  return sum;
}

/// Returns the largest distance of a control point from `from`.
double reach(const BezierPatch& patch, const Vec3& from) {
  double most = 0;
  for (const Vec3& p : patch.points()) most = std::max(most, length(p - from));
  return most;
}

/// Returns twice 2 g + 2 u: 2 g as derived in the header, 2 u for the division; the factor covers what lengths and
/// products of roundings add.
double evaluation_rounding(const BezierPatch& patch) {
  return 4 * (3.0 * (patch.degree_u() + patch.degree_v()) + 9) * 0x1p-53;
}

}  // namespace

double f64_vertex_rounding(const BezierPatch& patch, const Vec3& origin) {
  return (0x1p-24 + evaluation_rounding(patch)) * reach(patch, origin) + 0x1p-148;
}

double f64_position_rounding(const BezierPatch& patch, const Vec3& origin) {
  return evaluation_rounding(patch) * reach(patch, origin) + 0x1p-52 * reach(patch, Vec3{});
}

Vec3 F64Points::Curve::at(Segments::Fraction t) const {
  return scale * symmetric_sum(degree, Weights(degree, t), [this](int k) { return points[tessera::at(k)]; }).project();
}

F64Points::Curve F64Points::row_at(Segments::Fraction u) const {
  const Weights weights(net_.degree_u, u);
  Curve row{net_.degree_v, net_.scale, {}};
  for (int j = 0; j <= net_.degree_v; ++j)
    row.points[at(j)] = symmetric_sum(net_.degree_u, weights, [&](int i) { return net_.at(i, j); });
  return row;
}

F64Points::Curve F64Points::border_along(Side side) const {
  const bool along_u = runs_along_u(side);
  Curve border{degree_along(side, net_), net_.scale, {}};
  const int across = is_far(side) ? (along_u ? net_.degree_v : net_.degree_u) : 0;
  for (int k = 0; k <= border.degree; ++k) border.points[at(k)] = along_u ? net_.at(k, across) : net_.at(across, k);
  return border;
}

Vec3 F64Points::start_of(Side side) const {
  const bool end_u = side == Side::u1 || side == Side::v1, end_v = side == Side::v1 || side == Side::u0;
  return patch_.point(end_u ? patch_.degree_u() : 0, end_v ? patch_.degree_v() : 0) - origin_ + Vec3{};
}

}}  // namespace tessera::abi_0_1
