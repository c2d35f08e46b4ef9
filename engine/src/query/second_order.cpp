#include "query/second_order.h"

#include <algorithm>
#include <array>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns the weights of a patch of degrees up to 3, 1 if it is not rational, for kernels of rational patches.
const double* kernel_weights(const BezierPatch& patch) {
  static constexpr std::array<double, 16> ones{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  return patch.is_rational() ? patch.weights().data() : ones.data();
}

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Writes the position and the derivatives du, dv, duu, duv, dvv.
void write(const std::array<Vec3, 6>& values, kernel::SecondOrder& out) {
  double* const to[] = {out.position, out.du, out.dv, out.duu, out.duv, out.dvv};
  for (std::size_t k = 0; k < values.size(); ++k)
    to[k][0] = values[k].x, to[k][1] = values[k].y, to[k][2] = values[k].z;
}

/// The polynomials B_{i,n}(t) and two derivatives, from those of degree n - 1 and n - 2 (Farin, Curves and Surfaces for
/// CAGD, 5th ed., eqs. 5.2 and 5.23).
struct SecondBasis {
  using Values = std::array<double, std::size_t{max_degree} + 1>;
  int degree;
  Values value, first, second;

  SecondBasis(int any_degree, double t) : degree(any_degree) {
    value[0] = 1;
    for (int n = 1; n < degree - 1; ++n) raise(n, t);
    for (int i = 0; i <= degree; ++i) second[at(i)] = 0;
    if (degree > 1) {
      differ(degree - 1, degree - 1, first);  // of degree n - 2, by the order below
      for (int i = 0; i <= degree; ++i) {
        const double before = i > 0 ? first[at(i - 1)] : 0, here = i < degree ? first[at(i)] : 0;
        second[at(i)] = degree * (before - here);
      }
      raise(degree - 1, t);
    }
    differ(degree, degree, first);
    raise(degree, t);
  }

 private:
  /// Raises degree n - 1 to n, in place.
  void raise(int n, double t) {
    value[at(n)] = t * value[at(n - 1)];
    for (int i = n - 1; i > 0; --i) value[at(i)] = (1 - t) * value[at(i)] + t * value[at(i - 1)];
    value[0] *= 1 - t;
  }
  /// Computes the derivatives of degree n from the values of degree n - 1.
  void differ(int n, double scale, Values& out) const {
    double before = 0;
    for (int i = 0; i < n; ++i) {
      out[at(i)] = scale * (before - value[at(i)]);
      before = value[at(i)];
    }
    out[at(n)] = scale * before;
  }
};

/// The sums over u of a column of control points, a column after the other, and two derivatives.
struct ColumnSums {
  static constexpr std::size_t most = 3 * (std::size_t{max_degree} + 1);
  double value[most], first[most], second[most];
};

/// Sums over u first: a row of control points is a run of numbers, which compilers turn into vectors.
void polynomial(const BezierPatch& patch, double u_at, double v_at, const Vec3& origin, kernel::SecondOrder& out) {
  const SecondBasis u(patch.degree_u(), u_at), v(patch.degree_v(), v_at);
  const std::size_t columns = at(v.degree + 1), width = 3 * columns;
  double shift[ColumnSums::most];
  for (std::size_t j = 0; j < columns; ++j)
    shift[3 * j] = origin.x, shift[3 * j + 1] = origin.y, shift[3 * j + 2] = origin.z;
  ColumnSums sums;
  for (std::size_t k = 0; k < width; ++k) sums.value[k] = sums.first[k] = sums.second[k] = 0;
  const double* row = &patch.points().data()->x;
  for (int i = 0; i <= u.degree; ++i, row += width) {
    const double b = u.value[at(i)], b_du = u.first[at(i)], b_duu = u.second[at(i)];
    for (std::size_t k = 0; k < width; ++k) {
      const double from = row[k] - shift[k];
      sums.value[k] += b * from, sums.first[k] += b_du * from, sums.second[k] += b_duu * from;
    }
  }
  Vec3 position, du, dv, duu, duv, dvv;
  for (std::size_t j = 0; j < columns; ++j) {
    const auto of = [&](const double* sum) { return Vec3{sum[3 * j], sum[3 * j + 1], sum[3 * j + 2]}; };
    const Vec3 p = of(sums.value), pu = of(sums.first);
    position += v.value[j] * p, dv += v.first[j] * p, dvv += v.second[j] * p;
    du += v.value[j] * pu, duv += v.first[j] * pu;
    duu += v.value[j] * of(sums.second);
  }
  write({position, du, dv, duu, duv, dvv}, out);
}

/// A homogeneous sum: w (x - origin), and w.
struct WeightedSum {
  Vec3 point;
  double weight = 0;
  void add(double b, const WeightedSum& a) { point += b * a.point, weight += b * a.weight; }
};

/// Uses the quotient rule (Piegl and Tiller, The NURBS Book, eq. 4.20).
void rational(const BezierPatch& patch, double u_at, double v_at, const Vec3& origin, kernel::SecondOrder& out) {
  const SecondBasis u(patch.degree_u(), u_at), v(patch.degree_v(), v_at);
  WeightedSum a, au, av, auu, auv, avv;
  const Vec3* point = patch.points().data();
  const double* weight = patch.weights().data();
  for (int i = 0; i <= u.degree; ++i) {
    WeightedSum row, row_dv, row_dvv;
    for (int j = 0; j <= v.degree; ++j, ++point, ++weight) {
      const WeightedSum from{*weight * (*point - origin), *weight};
      row.add(v.value[at(j)], from), row_dv.add(v.first[at(j)], from), row_dvv.add(v.second[at(j)], from);
    }
    a.add(u.value[at(i)], row), au.add(u.first[at(i)], row), auu.add(u.second[at(i)], row);
    av.add(u.value[at(i)], row_dv), auv.add(u.first[at(i)], row_dv), avv.add(u.value[at(i)], row_dvv);
  }
  const double inverse = 1 / a.weight;
  const Vec3 position = inverse * a.point;
  const Vec3 du = inverse * (au.point - au.weight * position), dv = inverse * (av.point - av.weight * position);
  const Vec3 duu = inverse * (auu.point - 2 * au.weight * du - auu.weight * position);
  const Vec3 duv = inverse * (auv.point - au.weight * dv - av.weight * du - auv.weight * position);
  const Vec3 dvv = inverse * (avv.point - 2 * av.weight * dv - avv.weight * position);
  write({position, du, dv, duu, duv, dvv}, out);
}

}  // namespace

void second_order(const SecondOrderPatch& of, double u, double v, kernel::SecondOrder& out) {
  const BezierPatch& patch = *of.patch;
  const double* const points = &patch.points().data()->x;
  const int m = patch.degree_u(), n = patch.degree_v();
  if (m == 3 && n == 3 && !patch.is_rational())
    of.kernels->cubic_second_order(points, &of.origin.x, u, v, out);
  else if (std::max(m, n) <= 3)
    of.kernels->low_rational_second_order(points, kernel_weights(patch), m, n, &of.origin.x, u, v, out);
  else if (patch.is_rational())
    rational(patch, u, v, of.origin, out);
  else
    polynomial(patch, u, v, of.origin, out);
}

}}  // namespace tessera::abi_0_1
