#include "query/second_order.h"

#include <array>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The polynomials B_{i,n}(t) and two derivatives, from those of degree n - 1 and n - 2 (Farin, Curves and Surfaces for
/// CAGD, 5th ed., eqs. 5.2 and 5.23). `Fixed` is the degree if the compiler knows it, else 0.
template <int Fixed>
struct SecondBasis {
  using Values = std::array<double, at(Fixed ? Fixed : max_degree) + 1>;
  int degree;
  Values value, first, second;

  SecondBasis(int any_degree, double t) : degree(Fixed ? Fixed : any_degree) {
    const int last = Fixed ? Fixed : any_degree;
    value[0] = 1;
    for (int n = 1; n < last - 1; ++n) raise(n, t);
    second.fill(0);
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

template <int M, int N>
SecondOrder polynomial(const BezierPatch& patch, double u_at, double v_at, const Vec3& origin) {
  const SecondBasis<M> u(patch.degree_u(), u_at);
  const SecondBasis<N> v(patch.degree_v(), v_at);
  SecondOrder out;
  const Vec3* point = patch.points().data();
  for (int i = 0; i < u.size(); ++i) {
    Vec3 row, row_dv, row_dvv;
    for (int j = 0; j < v.size(); ++j, ++point) {
      const Vec3 from = *point - origin;
      row += v.value[at(j)] * from;
      row_dv += v.first[at(j)] * from;
      row_dvv += v.second[at(j)] * from;
    }
    out.position += u.value[at(i)] * row;
    out.du += u.first[at(i)] * row;
    out.duu += u.second[at(i)] * row;
    out.dv += u.value[at(i)] * row_dv;
    out.duv += u.first[at(i)] * row_dv;
    out.dvv += u.value[at(i)] * row_dvv;
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
