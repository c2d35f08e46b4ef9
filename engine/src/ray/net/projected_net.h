#pragma once
// Bezier nets in a ray's frame: x and y across it, z along it, and the weight if there is one. These are the inner
// loops of exact rays. Each net is `[component][i][j]`, doubles; degrees that the compiler knows are unrolled.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ray/line/ray_line.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// The degrees of a net. M, N: the degrees if the compiler knows them, else 0.
template <int M, int N>
struct NetShape {
  int degree_u = M, degree_v = N;
  int m() const { return M ? M : degree_u; }
  int n() const { return N ? N : degree_v; }
  int columns() const { return n() + 1; }
  int size() const { return (m() + 1) * (n() + 1); }
};

/// Projects a net of homogeneous (x, y, z[, w]) into the ray's frame: (w (x - start) . across, w (x - start) .
/// direction[, w]).
template <bool Rational, class Shape>
void project(const Shape& shape, const double* net, const RayLine& line, double* out) {
  const int size = shape.size();
  const auto axis = [&](const Vec3& a, double* to) {
    const double shift = dot(a, line.start);
    for (int k = 0; k < size; ++k) {
      const double w = Rational ? net[3 * size + k] : 1;
      to[k] = (a.x * net[k] + a.y * net[size + k]) + (a.z * net[2 * size + k] - w * shift);
    }
  };
  axis(line.across[0], out);
  axis(line.across[1], out + size);
  axis(line.direction, out + 2 * size);
  if constexpr (Rational) std::copy(net + 3 * size, net + 4 * size, out + 3 * size);
}

/// Cuts one line of coefficients, `stride` apart, at 1/2 (de Casteljau). `lower` or `upper` may be `in`.
inline void halve_line(int degree, const double* in, int stride, double* lower, double* upper) {
  std::array<double, max_degree + 1> row;
  for (int k = 0; k <= degree; ++k) row[static_cast<std::size_t>(k)] = in[k * stride];
  for (int level = 0; level <= degree; ++level) {
    const int last = degree - level;
    lower[level * stride] = row[0];
    upper[last * stride] = row[static_cast<std::size_t>(last)];
    for (std::size_t k = 0; k < static_cast<std::size_t>(last); ++k) row[k] = 0.5 * (row[k] + row[k + 1]);
  }
}

/// Computes the halves of a net along u or v. `lower` or `upper` may be `in`.
template <class Shape>
void halve(const Shape& shape, int components, const double* in, bool along_u, double* lower, double* upper) {
  const int columns = shape.columns(), size = shape.size();
  for (int c = 0; c < components; ++c) {
    const int first = c * size;
    if (along_u) {
      for (int j = 0; j < columns; ++j)
        halve_line(shape.m(), in + first + j, columns, lower + first + j, upper + first + j);
    } else {
      for (int at = first; at < first + size; at += columns) halve_line(shape.n(), in + at, 1, lower + at, upper + at);
    }
  }
}

/// Restricts one line of coefficients, `stride` apart, to [a, b] in [0,1], a < b, in place: first to [0, b].
inline void restrict_line(int degree, double* line, int stride, double a, double b) {
  std::array<double, max_degree + 1> row;
  for (int k = 0; k <= degree; ++k) row[static_cast<std::size_t>(k)] = line[k * stride];
  for (int level = 1; level <= degree; ++level) {
    for (int k = degree; k >= level; --k) {
      const auto at = static_cast<std::size_t>(k);
      row[at] = (1 - b) * row[at - 1] + b * row[at];
    }
  }
  const double at_a = a / b;
  for (int level = 1; level <= degree; ++level) {
    for (std::size_t k = 0; k + static_cast<std::size_t>(level) <= static_cast<std::size_t>(degree); ++k)
      row[k] = (1 - at_a) * row[k] + at_a * row[k + 1];
  }
  for (int k = 0; k <= degree; ++k) line[k * stride] = row[static_cast<std::size_t>(k)];
}

template <class Shape>
void restrict_net(const Shape& shape, int components, double* net, bool along_u, double a, double b) {
  const int columns = shape.columns(), size = shape.size();
  for (int c = 0; c < components; ++c) {
    double* const first = net + c * size;
    if (along_u) {
      for (int j = 0; j < columns; ++j) restrict_line(shape.m(), first + j, columns, a, b);
    } else {
      for (int i = 0; i < size; i += columns) restrict_line(shape.n(), first + i, 1, a, b);
    }
  }
}

/// Values x, y, z, w of a projected net and the derivatives of x and y, homogeneous, at one point.
struct NetValue {
  double x = 0, y = 0, z = 0, w = 1;
  double xu = 0, xv = 0, yu = 0, yv = 0;
  /// Returns the distance from the ray.
  double residual() const { return std::sqrt(x * x + y * y) / w; }
  double s() const { return z / w; }
};

/// The polynomials B_{i,n}(t), raised one degree at a time, and their derivatives from the degree below (Farin, eqs.
/// 5.2 and 5.23).
template <int Fixed>
struct NetBasis {
  std::array<double, (Fixed ? Fixed : max_degree) + 1> value, derivative;

  NetBasis(int any_degree, double t) {
    const int last = Fixed ? Fixed : any_degree;
    value[0] = 1;
    for (int n = 1; n < last; ++n) raise(n, t);
    double before = 0;
    for (int i = 0; i < last; ++i) {
      derivative[at(i)] = last * (before - value[at(i)]);
      before = value[at(i)];
    }
    derivative[at(last)] = last * before;
    raise(last, t);
  }

 private:
  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
  void raise(int n, double t) {
    value[at(n)] = t * value[at(n - 1)];
    for (int i = n - 1; i > 0; --i) value[at(i)] = (1 - t) * value[at(i)] + t * value[at(i - 1)];
    value[0] *= 1 - t;
  }
};

/// Evaluates the net at (u,v) in [0,1]^2.
template <bool Rational, int M, int N>
NetValue evaluate(const NetShape<M, N>& shape, const double* net, double u, double v) {
  const NetBasis<M> bu(shape.m(), u);
  const NetBasis<N> bv(shape.n(), v);
  const int size = shape.size();
  NetValue out;
  out.w = Rational ? 0 : 1;
  int k = 0;
  for (int i = 0; i <= shape.m(); ++i) {
    double x = 0, y = 0, z = 0, w = 0, xv = 0, yv = 0;
    for (int j = 0; j <= shape.n(); ++j, ++k) {
      const double b = bv.value[static_cast<std::size_t>(j)], d = bv.derivative[static_cast<std::size_t>(j)];
      x += b * net[k], y += b * net[size + k], z += b * net[2 * size + k];
      xv += d * net[k], yv += d * net[size + k];
      if constexpr (Rational) w += b * net[3 * size + k];
    }
    const double b = bu.value[static_cast<std::size_t>(i)], d = bu.derivative[static_cast<std::size_t>(i)];
    out.x += b * x, out.y += b * y, out.z += b * z;
    out.xu += d * x, out.yu += d * y, out.xv += b * xv, out.yv += b * yv;
    if constexpr (Rational) out.w += b * w;
  }
  return out;
}

}}  // namespace tessera::abi_0_1
