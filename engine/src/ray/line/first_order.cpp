#include "ray/line/first_order.h"

#include <algorithm>
#include <array>

namespace tessera { inline namespace abi_0_1 {
namespace {

using Values = std::array<double, max_degree + 1>;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The polynomials B_{i,n}(t) and their derivatives, by B_{i,n} = (1-t) B_{i,n-1} + t B_{i-1,n-1} and B'_{i,n} = n
/// (B_{i-1,n-1} - B_{i,n-1}) (Farin, Curves and Surfaces for CAGD, 5th ed., eqs. 5.2 and 5.23). `Fixed` is the degree
/// if the compiler knows it, else 0.
template <int Fixed>
struct Basis {
  int degree;
  Values value, derivative;

  Basis(int any_degree, double t) : degree(Fixed ? Fixed : any_degree) {
    const int last = Fixed ? Fixed : any_degree;
    const double s = 1 - t;
    value[0] = 1;
    for (int n = 1; n < last; ++n) raise(n, s, t);
    double before = 0;
    for (int i = 0; i < last; ++i) {
      derivative[at(i)] = last * (before - value[at(i)]);
      before = value[at(i)];
    }
    derivative[at(last)] = last * before;
    raise(last, s, t);
  }
  int size() const { return (Fixed ? Fixed : degree) + 1; }

 private:
  /// Raises degree n - 1 to n, in place.
  void raise(int n, double s, double t) {
    value[at(n)] = t * value[at(n - 1)];
    for (int i = n - 1; i > 0; --i) value[at(i)] = s * value[at(i)] + t * value[at(i - 1)];
    value[0] *= s;
  }
};

template <int M, int N>
FirstOrder polynomial(const BezierPatch& patch, double u_at, double v_at, const Vec3& origin) {
  const Basis<M> u(patch.degree_u(), u_at);
  const Basis<N> v(patch.degree_v(), v_at);
  FirstOrder out;
  const Vec3* point = patch.points().data();
  for (int i = 0; i < u.size(); ++i) {
    Vec3 row, row_dv;
    for (int j = 0; j < v.size(); ++j, ++point) {
      const Vec3 from = *point - origin;
      row += v.value[at(j)] * from;
      row_dv += v.derivative[at(j)] * from;
    }
    out.position += u.value[at(i)] * row;
    out.du += u.derivative[at(i)] * row;
    out.dv += u.value[at(i)] * row_dv;
  }
  return out;
}

/// Uses the quotient rule r_u = (A_u - w_u r) / w (Piegl and Tiller, The NURBS Book, eq. 4.20).
FirstOrder rational(const BezierPatch& patch, double u_at, double v_at, const Vec3& origin) {
  const Basis<0> u(patch.degree_u(), u_at), v(patch.degree_v(), v_at);
  FirstOrder out;
  double w = 0, w_u = 0, w_v = 0;
  const Vec3* point = patch.points().data();
  const double* weight = patch.weights().data();
  for (int i = 0; i < u.size(); ++i) {
    Vec3 row, row_dv;
    double weight_row = 0, weight_dv = 0;
    for (int j = 0; j < v.size(); ++j, ++point, ++weight) {
      const double b = v.value[at(j)] * *weight, b_dv = v.derivative[at(j)] * *weight;
      const Vec3 from = *point - origin;
      row += b * from, row_dv += b_dv * from;
      weight_row += b, weight_dv += b_dv;
    }
    const double a = u.value[at(i)], a_du = u.derivative[at(i)];
    out.position += a * row, out.du += a_du * row, out.dv += a * row_dv;
    w += a * weight_row, w_u += a_du * weight_row, w_v += a * weight_dv;
  }
  out.valid = w > 0;
  if (!out.valid) return out;
  const double inverse = 1 / w;
  out.position = inverse * out.position;
  out.du = inverse * (out.du - w_u * out.position);
  out.dv = inverse * (out.dv - w_v * out.position);
  return out;
}

}  // namespace

FirstOrder first_order(const BezierPatch& patch, double u, double v, const Vec3& origin) {
  if (patch.is_rational()) return rational(patch, u, v, origin);
  if (patch.degree_u() == 3 && patch.degree_v() == 3) return polynomial<3, 3>(patch, u, v, origin);
  return polynomial<0, 0>(patch, u, v, origin);
}

FirstOrder first_order(const BezierPatch& patch, const Vec3& origin, const kernel::RayKernels& kernels, double u,
                       double v) {
  const double* const points = &patch.points().data()->x;
  const int m = patch.degree_u(), n = patch.degree_v();
  const auto triple = [](const double* x) { return Vec3{x[0], x[1], x[2]}; };
  kernel::RayPoint found;
  if (m == 3 && n == 3 && !patch.is_rational())
    kernels.cubic_point(points, &origin.x, u, v, found);
  else if (std::max(m, n) <= 3 && patch.is_rational())
    kernels.low_rational_point(points, patch.weights().data(), m, n, &origin.x, u, v, found);
  else
    return first_order(patch, u, v, origin);
  return {triple(found.position), triple(found.du), triple(found.dv)};
}

}}  // namespace tessera::abi_0_1
