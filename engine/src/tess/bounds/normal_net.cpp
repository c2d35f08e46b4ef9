#include "tess/bounds/normal_net.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "basis/bernstein.h"
#include "surface/net/homogeneous.h"
#include "tess/bounds/sweep_normal.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Coefficients of a polynomial of the given degrees over B_i B_j times the binomials C(m,i) C(n,j): such nets multiply
/// by convolution (Farouki and Rajan 1988, Algorithms for polynomials in Bernstein form, eq. 44).
template <class T>
struct Scaled {
  int degree_u, degree_v;
  std::vector<T> at;

  Scaled(int m, int n) : degree_u(m), degree_v(n), at(static_cast<std::size_t>((m + 1) * (n + 1))) {}
  T& operator()(int i, int j) { return at[static_cast<std::size_t>(i * (degree_v + 1) + j)]; }
  const T& operator()(int i, int j) const { return at[static_cast<std::size_t>(i * (degree_v + 1) + j)]; }
};

template <class A, class B, class Times>
auto product(const Scaled<A>& a, const Scaled<B>& b, Times times) {
  using T = std::decay_t<decltype(times(a.at[0], b.at[0]))>;
  Scaled<T> c(a.degree_u + b.degree_u, a.degree_v + b.degree_v);
  for (int i = 0; i <= a.degree_u; ++i)
    for (int j = 0; j <= a.degree_v; ++j)
      for (int k = 0; k <= b.degree_u; ++k)
        for (int l = 0; l <= b.degree_v; ++l) c(i + k, j + l) = c(i + k, j + l) + times(a(i, j), b(k, l));
  return c;
}

Scaled<Vec3> cross_product(const Scaled<Vec3>& a, const Scaled<Vec3>& b) {
  return product(a, b, [](const Vec3& p, const Vec3& q) { return cross(p, q); });
}
Scaled<Vec3> multiple(const Scaled<double>& w, const Scaled<Vec3>& a) {
  return product(w, a, [](double s, const Vec3& p) { return s * p; });
}

/// Returns part(A) of the net, differentiated once along u or along v, or not at all.
template <class Part>
auto scaled(const HomogeneousNet& net, int along_u, int along_v, Part part) {
  const int m = net.degree_u - along_u, n = net.degree_v - along_v;
  Scaled<std::decay_t<decltype(part(net.at(0, 0)))>> out(m, n);
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      const Homogeneous a = along_u + along_v == 0 ? net.at(i, j) : net.at(i + along_u, j + along_v) - net.at(i, j);
      const double factor =
          (along_u ? net.degree_u : 1) * (along_v ? net.degree_v : 1) * binomial(m, i) * binomial(n, j);
      out(i, j) = factor * part(a);
    }
  return out;
}

Scaled<Vec3> normal_numerator(const HomogeneousNet& net, bool rational) {
  const auto vector = [](const Homogeneous& a) { return a.vector(); };
  const auto weight = [](const Homogeneous& a) { return a.w; };
  const Scaled<Vec3> au = scaled(net, 1, 0, vector), av = scaled(net, 0, 1, vector);
  Scaled<Vec3> direct = cross_product(au, av);
  if (!rational) return direct;
  const Scaled<Vec3> a = scaled(net, 0, 0, vector);
  Scaled<Vec3> sum = multiple(scaled(net, 0, 0, weight), direct);
  const Scaled<Vec3> wv = multiple(scaled(net, 0, 1, weight), cross_product(au, a));
  const Scaled<Vec3> wu = multiple(scaled(net, 1, 0, weight), cross_product(a, av));
  for (std::size_t k = 0; k < sum.at.size(); ++k) sum.at[k] = sum.at[k] - wv.at[k] - wu.at[k];
  return sum;
}

/// Divides a field that vanishes at an edge by u, 1 - u, v or 1 - v.
VectorNet divided(const VectorNet& net, Side edge) {
  const bool along_u = edge == Side::u0 || edge == Side::u1, low = edge == Side::u0 || edge == Side::v0;
  VectorNet out;
  out.degree_u = net.degree_u - along_u;
  out.degree_v = net.degree_v - !along_u;
  out.at.resize(static_cast<std::size_t>((out.degree_u + 1) * (out.degree_v + 1)));
  const int degree = along_u ? net.degree_u : net.degree_v;
  for (int i = 0; i <= out.degree_u; ++i)
    for (int j = 0; j <= out.degree_v; ++j) {
      // B_{k+1,d}(t) / t = d / (k+1) B_{k,d-1}(t), and B_{k,d}(t) / (1-t) = d / (d-k) B_{k,d-1}(t).
      const int k = along_u ? i : j;
      const double factor = static_cast<double>(degree) / (low ? k + 1 : degree - k);
      out(i, j) = factor * net(i + (along_u && low), j + (!along_u && low));
    }
  return out;
}

/// Bounds the sum of the sizes of all terms, as if every point and weight were the largest.
double largest_term(const HomogeneousNet& net, bool rational) {
  double size = 0, weight = 0;
  for (std::size_t k = 0; k < net.size(); ++k) {
    size = std::max(size, length(net.points[k].vector()));
    weight = std::max(weight, std::abs(net.points[k].w));
  }
  return 4.0 * net.degree_u * net.degree_v * size * size * (rational ? 3 * weight : 1);
}

}  // namespace

NormalNet normal_net(const BezierPatch& patch) {
  if (std::optional<NormalNet> sweep = sweep_normal_net(patch)) return *std::move(sweep);
  const HomogeneousNet homogeneous(patch, patch.point(0, 0));
  const Scaled<Vec3> numerator = normal_numerator(homogeneous, patch.is_rational());
  NormalNet out;
  out.net.degree_u = numerator.degree_u;
  out.net.degree_v = numerator.degree_v;
  out.net.at = numerator.at;
  for (int i = 0; i <= out.net.degree_u; ++i)
    for (int j = 0; j <= out.net.degree_v; ++j)
      out.net(i, j) = 1 / (binomial(out.net.degree_u, i) * binomial(out.net.degree_v, j)) * out.net(i, j);
  // Each control point is a mean of products, each of at most two differences, with fewer roundings than 2^8.
  out.rounding = 0x1p-44 * largest_term(homogeneous, patch.is_rational());
  for (const Side edge : {Side::u0, Side::u1, Side::v0, Side::v1}) {
    const bool along_u = edge == Side::u0 || edge == Side::u1;
    const int degree = along_u ? out.net.degree_u : out.net.degree_v;
    if (!patch.collapsed_sides().has(edge) || degree == 0) continue;
    out.net = divided(out.net, edge);
    out.rounding *= degree;
  }
  return out;
}

}}  // namespace tessera::abi_0_1
