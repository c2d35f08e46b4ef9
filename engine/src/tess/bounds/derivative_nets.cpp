#include "tess/bounds/derivative_nets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Cuts a Bezier curve of `count` points, `step` apart, at 1/2 by de Casteljau: `high` becomes its upper half, and
/// `low` its lower half.
void cut(Homogeneous* high, Homogeneous* low, int count, int step) {
  for (int k = 0; k < count; ++k) {
    low[k * step] = high[0];
    for (int i = 0; i + 1 < count - k; ++i) high[i * step] = 0.5 * high[i * step] + 0.5 * high[(i + 1) * step];
  }
}

/// Cuts a Bezier curve down to its part from `begin` to `end`.
void cut_to(Homogeneous* at, int count, int step, double begin, double end) {
  const auto mixed = [&](int i, double t) { return (1 - t) * at[i * step] + t * at[(i + 1) * step]; };
  if (end < 1)
    for (int k = 1; k < count; ++k)
      for (int i = count - 1; i >= k; --i) at[i * step] = mixed(i - 1, end);
  if (begin > 0)
    for (int k = 1; k < count; ++k)
      for (int i = 0; i + k < count; ++i) at[i * step] = mixed(i, begin / end);
}

/// Where a rational piece lies: its points are within `radius` of `centre`, its weights at least `lightest`. The
/// default is for polynomial pieces: it leaves the derivatives unchanged.
struct Place {
  Vec3 centre;
  double radius = 0, lightest = 1;
};

template <class Visit>
void for_vectors(const DerivativePiece& piece, const DerivativePiece::Nets& nets, const Visit& visit) {
  for (std::size_t k = 0; k < piece.count; ++k)
    for (const Homogeneous& a : std::span(nets[k]->at.data(), static_cast<std::size_t>(nets[k]->size()))) visit(a);
}

Place place_of(const DerivativePiece& piece) {
  Place place;
  place.lightest = std::numeric_limits<double>::infinity();
  Box3 box;
  for_vectors(piece, piece.points, [&](const Homogeneous& a) {
    box.extend(a.project());
    place.lightest = std::min(place.lightest, a.w);
  });
  place.centre = box.centre();
  place.radius = 0.5 * box.diagonal();
  return place;
}

/// The larger of both; NaN is larger than all numbers.
double larger(double most, double one) { return one > most || std::isnan(one) ? one : most; }

double largest(const DerivativePiece& piece, const DerivativePiece::Nets& nets, const Place& place) {
  double most = 0;
  for_vectors(piece, nets, [&](const Homogeneous& a) {
    most = larger(most, length(a.vector() - a.w * place.centre) + place.radius * std::abs(a.w));
  });
  return most / place.lightest;
}

/// The vectors that largest() measures, each the centre of a ball; the balls of polynomial pieces are points.
struct Vectors {
  static constexpr std::size_t capacity = std::size_t{4} * (max_product_degree + 1) * (max_product_degree + 1);
  using Numbers = double[capacity];
  Numbers x, y, z, radius, size;  // the first `count`
  std::size_t count = 0;
  double invalid = 0;  ///< NaN if one of them is not finite, else 0

  Vectors(const DerivativePiece& piece, const DerivativePiece::Nets& nets, const Place& place) {
    for_vectors(piece, nets, [&](const Homogeneous& a) {
      const Vec3 centre = (1 / place.lightest) * (a.vector() - a.w * place.centre);
      x[count] = centre.x;
      y[count] = centre.y;
      z[count] = centre.z;
      radius[count] = place.radius * std::abs(a.w) / place.lightest;
      size[count] = place.radius != 0 ? length(centre) : 0;
      invalid += 0 * (centre.x + centre.y + centre.z + radius[count] + size[count]);
      ++count;
    });
  }
};

/// Returns the largest product of a vector in a ball of `a` and one in a ball of `b`, or the largest size of these
/// products; NaN if a vector is not finite.
template <bool Balls, bool Size>
double largest_product(const Vectors& a, const Vectors& b) {
  if (a.count == 0 || b.count == 0) return 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < a.count; ++p)
    for (std::size_t q = 0; q < b.count; ++q) {
      double product = a.x[p] * b.x[q] + a.y[p] * b.y[q] + a.z[p] * b.z[q];
      if constexpr (Size) product = std::abs(product);
      if constexpr (Balls) product += a.size[p] * b.radius[q] + b.size[q] * a.radius[p] + a.radius[p] * b.radius[q];
      most = std::max(most, product);
    }
  return most + (a.invalid + b.invalid);
}
template <bool Size>
double largest_product(const Vectors& a, const Vectors& b, bool balls) {
  return balls ? largest_product<true, Size>(a, b) : largest_product<false, Size>(a, b);
}

void make_infinite_where_nan(std::initializer_list<double*> bounds) {
  for (double* bound : bounds)
    if (std::isnan(*bound)) *bound = std::numeric_limits<double>::infinity();
}

}  // namespace

DerivativeNet& DerivativeNet::operator=(const DerivativeNet& other) {
  rows = other.rows;
  columns = other.columns;
  std::copy_n(other.at.begin(), other.size(), at.begin());
  return *this;
}

void cut(const DerivativeNet& net, DerivativeNet (&quarter)[2][2]) {
  DerivativeNet high = net, low = net;
  for (int j = 0; j < net.columns; ++j) cut(&high(0, j), &low(0, j), net.rows, net.columns);
  for (int half = 0; half < 2; ++half) {
    quarter[half][0] = quarter[half][1] = half == 0 ? low : high;
    for (int i = 0; i < net.rows; ++i) cut(&quarter[half][1](i, 0), &quarter[half][0](i, 0), net.columns, 1);
  }
}

DerivativeNet cut_to(const DerivativeNet& net, const Domain& rectangle) {
  DerivativeNet part = net;
  for (int j = 0; j < net.columns; ++j) cut_to(&part(0, j), net.rows, net.columns, rectangle.u0, rectangle.u1);
  for (int i = 0; i < net.rows; ++i) cut_to(&part(i, 0), net.columns, 1, rectangle.v0, rectangle.v1);
  return part;
}

DerivativeNets::DerivativeNets(const BezierPatch& patch) : rational(patch.is_rational()) {
  const HomogeneousNet net(patch, patch.point(0, 0));
  const int m = degree_u = net.degree_u, n = degree_v = net.degree_v;
  scale = net.scale;
  uu.rows = m - 1;
  uu.columns = n + 1;
  uv.rows = m;
  uv.columns = n;
  vv.rows = m + 1;
  vv.columns = n - 1;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      const Homogeneous& a = net.at(i, j);
      if (i + 2 <= m) uu(i, j) = m * (m - 1.0) * ((net.at(i + 2, j) - net.at(i + 1, j)) - (net.at(i + 1, j) - a));
      if (i < m && j < n)
        uv(i, j) = m * double(n) * ((net.at(i + 1, j + 1) - net.at(i + 1, j)) - (net.at(i, j + 1) - a));
      if (j + 2 <= n) vv(i, j) = n * (n - 1.0) * ((net.at(i, j + 2) - net.at(i, j + 1)) - (net.at(i, j + 1) - a));
    }
  points.rows = m + 1;
  points.columns = n + 1;
  for (std::size_t k = 0; k < net.size(); ++k) {
    points.at[k] = net.points[k];
    size = std::max(size, max_abs(net.points[k].vector()));
    heaviest = std::max(heaviest, net.points[k].w);
  }
}

SecondDerivatives bound_piece(const DerivativeNets& patch, const DerivativePiece& piece, double rounding,
                              bool products) {
  const double m = patch.degree_u, n = patch.degree_v, scale = patch.scale * (1 + 0x1p-40);
  const Place place = patch.rational ? place_of(piece) : Place{};
  const double entering = patch.size + patch.heaviest * (max_abs(place.centre) + place.radius);
  const double rounded = rounding * entering / place.lightest;
  SecondDerivatives d{scale * (largest(piece, piece.uu, place) + (m > 1 ? m * (m - 1) * rounded : 0)),
                      scale * (largest(piece, piece.uv, place) + m * n * rounded),
                      scale * (largest(piece, piece.vv, place) + (n > 1 ? n * (n - 1) * rounded : 0))};
  make_infinite_where_nan({&d.uu, &d.uv, &d.vv});
  if (!products || std::max(m, n) > max_product_degree) return d;
  // The bounds include each vector's error; the error of a product is that of each vector times the other vector.
  const Vectors a(piece, piece.uu, place), b(piece, piece.uv, place), c(piece, piece.vv, place);
  const auto bound = [&](double product, double x, double y, double degrees) {
    return scale * scale * product + 0x1p-38 * x * y + scale * degrees * rounded * (x + y);
  };
  const bool balls = place.radius != 0;
  const double of_uu = m * m, of_uv = m * n, of_vv = n * n;
  d.uu_vv = bound(largest_product<false>(a, c, balls), d.uu, d.vv, std::max(of_uu, of_vv));
  d.uu_uv = bound(largest_product<true>(a, b, balls), d.uu, d.uv, std::max(of_uu, of_uv));
  d.uv_vv = bound(largest_product<true>(b, c, balls), d.uv, d.vv, std::max(of_uv, of_vv));
  make_infinite_where_nan({&d.uu_vv, &d.uu_uv, &d.uv_vv});
  return d;
}

}}  // namespace tessera::abi_0_1
