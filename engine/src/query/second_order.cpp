#include "query/second_order.h"

#include <array>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The polynomials B_{i,n}(t) and two derivatives, from those of degree n - 1 and n - 2 (Farin, Curves and Surfaces for
/// CAGD, 5th ed., eqs. 5.2 and 5.23). `Fixed` is the degree if the compiler knows it, else 0.
template <int Fixed>
struct SecondBasis {
  using Values = std::array<double, std::size_t{max_degree} + 1>;
  int degree;
  Values value, first, second;

  SecondBasis(int any_degree, double t) : degree(Fixed ? Fixed : any_degree) {
    const int last = Fixed ? Fixed : any_degree;
    value[0] = 1;
    for (int n = 1; n < last - 1; ++n) raise(n, t);
    for (int i = 0; i <= last; ++i) second[at(i)] = 0;
    if (last > 1) {
      differ(last - 1, last - 1, first);  // of degree n - 2, by the order below
      for (int i = 0; i <= last; ++i) {
        const double before = i > 0 ? first[at(i - 1)] : 0, here = i < last ? first[at(i)] : 0;
        second[at(i)] = last * (before - here);
      }
      raise(last - 1, t);
    }
    differ(last, last, first);
    raise(last, t);
  }
  int size() const { return (Fixed ? Fixed : degree) + 1; }

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
template <int M, int N>
SecondOrder polynomial(const BezierPatch& patch, double u_at, double v_at, const Vec3& origin) {
  const SecondBasis<M> u(patch.degree_u(), u_at);
  const SecondBasis<N> v(patch.degree_v(), v_at);
  const std::size_t columns = at(v.size()), width = N ? 3 * (at(N) + 1) : 3 * columns;
  double shift[ColumnSums::most];
  for (std::size_t j = 0; j < columns; ++j)
    shift[3 * j] = origin.x, shift[3 * j + 1] = origin.y, shift[3 * j + 2] = origin.z;
  ColumnSums sums;
  for (std::size_t k = 0; k < width; ++k) sums.value[k] = sums.first[k] = sums.second[k] = 0;
  const double* row = &patch.points().data()->x;
  for (int i = 0; i < u.size(); ++i, row += width) {
    const double b = u.value[at(i)], b_du = u.first[at(i)], b_duu = u.second[at(i)];
    for (std::size_t k = 0; k < width; ++k) {
      const double from = row[k] - shift[k];
      sums.value[k] += b * from, sums.first[k] += b_du * from, sums.second[k] += b_duu * from;
    }
  }
  SecondOrder out;
  for (std::size_t j = 0; j < columns; ++j) {
    const auto of = [&](const double* sum) { return Vec3{sum[3 * j], sum[3 * j + 1], sum[3 * j + 2]}; };
    const Vec3 p = of(sums.value), pu = of(sums.first);
    out.position += v.value[j] * p, out.dv += v.first[j] * p, out.dvv += v.second[j] * p;
    out.du += v.value[j] * pu, out.duv += v.first[j] * pu;
    out.duu += v.value[j] * of(sums.second);
  }
  return out;
}

/// A homogeneous sum: w (x - origin), and w.
struct WeightedSum {
  Vec3 point;
  double weight = 0;
  void add(double b, const WeightedSum& a) { point += b * a.point, weight += b * a.weight; }
};

/// Uses the quotient rule (Piegl and Tiller, The NURBS Book, eq. 4.20).
SecondOrder rational(const BezierPatch& patch, double u_at, double v_at, const Vec3& origin) {
  const SecondBasis<0> u(patch.degree_u(), u_at), v(patch.degree_v(), v_at);
  WeightedSum a, au, av, auu, auv, avv;
  const Vec3* point = patch.points().data();
  const double* weight = patch.weights().data();
  for (int i = 0; i < u.size(); ++i) {
    WeightedSum row, row_dv, row_dvv;
    for (int j = 0; j < v.size(); ++j, ++point, ++weight) {
      const WeightedSum from{*weight * (*point - origin), *weight};
      row.add(v.value[at(j)], from), row_dv.add(v.first[at(j)], from), row_dvv.add(v.second[at(j)], from);
    }
    a.add(u.value[at(i)], row), au.add(u.first[at(i)], row), auu.add(u.second[at(i)], row);
    av.add(u.value[at(i)], row_dv), auv.add(u.first[at(i)], row_dv), avv.add(u.value[at(i)], row_dvv);
  }
  const double inverse = 1 / a.weight;
  SecondOrder out;
  out.position = inverse * a.point;
  out.du = inverse * (au.point - au.weight * out.position);
  out.dv = inverse * (av.point - av.weight * out.position);
  out.duu = inverse * (auu.point - 2 * au.weight * out.du - auu.weight * out.position);
  out.duv = inverse * (auv.point - au.weight * out.dv - av.weight * out.du - auv.weight * out.position);
  out.dvv = inverse * (avv.point - 2 * av.weight * out.dv - avv.weight * out.position);
  return out;
}

}  // namespace

SecondOrder second_order(const BezierPatch& patch, double u, double v, const Vec3& origin) {
  if (patch.is_rational()) return rational(patch, u, v, origin);
  if (patch.degree_u() == 3 && patch.degree_v() == 3) return polynomial<3, 3>(patch, u, v, origin);
  return polynomial<0, 0>(patch, u, v, origin);
}

}}  // namespace tessera::abi_0_1
