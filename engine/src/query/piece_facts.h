#pragma once
// Facts of a piece of a patch: a frame, and bounds on how the piece departs from its tangent plane. They bound the
// distance of a point from the piece, and tell where that distance is a convex or a monotone function.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "query/range.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// A point or a vector of T.
template <class T>
struct Vec3Of {
  T x, y, z;
  Vec3Of() = default;
  explicit Vec3Of(const Vec3& a) : x(static_cast<T>(a.x)), y(static_cast<T>(a.y)), z(static_cast<T>(a.z)) {}
  explicit operator Vec3() const { return {double(x), double(y), double(z)}; }
};

/// The derivatives of a piece over its square [0, 1]^2, as boxes.
struct DerivativeRanges {
  VectorRange du, dv, duu, duv, dvv;
};

/// A piece of a patch over [-1/2, 1/2]^2 in lengths: x and y are its parameters times `length_u` and `length_v`, s(x,
/// y) its points. It has orthonormal axes: the first is along s_x in the middle, the third is the normal there. Bounds
/// hold over the whole piece, `[3]`: along each axis.
template <class T>
struct PieceFacts {
  Vec3Of<T> centre;                ///< s(0, 0)
  Vec3Of<T> axes[3];               ///< orthonormal
  T length_u, length_v;            ///< |s_u| and |s_v| in the middle
  T cosine, sine;                  ///< s_y in the middle, along the first and the second axis
  T off[3];                        ///< |s - (centre + x s_x + y s_y)|, s_x and s_y in the middle
  T reach[3];                      ///< |s - centre|
  T turn_x[3], turn_y[3];          ///< |s_x|, |s_y| less what they are in the middle
  T least_square;                  ///< a lower bound of |s_x a + s_y b|^2 for a^2 + b^2 = 1
  T bend_xx[3][2], bend_yy[3][2];  ///< ranges of s_xx and s_yy
  T bend_xy[3];                    ///< |s_xy|
};

/// A box that holds a piece, along axes of its own.
struct PieceBox {
  Vec3 centre, axes[3];  ///< orthonormal
  double half[3];        ///< half its sides

  double diagonal() const { return 2 * std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]); }

  /// Returns the distance of a point.
  double distance(const Vec3& point) const {
    const Vec3 from = point - centre;
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const double beyond = std::max(std::abs(dot(from, axes[k])) - half[k], 0.0);
      sum += beyond * beyond;
    }
    return std::sqrt(sum);
  }
};

/// A net of homogeneous coefficients w (x, y, z), w, `[component][i][j]`, without w if the piece is not rational.
struct PieceNet {
  int degree_u, degree_v;
  bool is_rational;
  const double* values;
};

/// Bounds the rounding of a coordinate of a part's net or of a point, for coordinates and weights of at most 2: each
/// level of de Casteljau's algorithm rounds twice, a part takes two passes along each parameter.
inline double net_rounding(int degree_u, int degree_v) { return (degree_u + degree_v + 4) * 0x1p-51; }

struct PieceBounds {
  PieceFacts<double> facts;
  PieceBox box;
  Box3 axis_box;
};

/// Returns the derivatives of a piece.
DerivativeRanges derivative_ranges(const PieceNet& net);
/// Returns what is known of a piece.
PieceBounds bound_piece(const PieceNet& net);
/// Returns the facts in float, with margins for rounding.
PieceFacts<float> packed(const PieceFacts<double>& facts);

template <class T>
double squared(const T (&a)[3]) {
  return double(a[0]) * a[0] + double(a[1]) * a[1] + double(a[2]) * a[2];
}

/// The square of the distance of `point` from a piece, as a function of x and y.
enum class Slope : std::uint8_t { unknown, rises, falls };
struct DistanceShape {
  Slope along_x, along_y;   ///< monotone, whatever the other parameter
  bool convex;              ///< in x and y
  bool convex_x, convex_y;  ///< along one of them
};

/// Tells the shape of the distance over the piece. With r = s - point: half the square has the gradient (r . s_x, r .
/// s_y) and the Hessian s_i . s_j + r . s_ij.
template <class T>
DistanceShape distance_shape(const PieceFacts<T>& f, const Vec3& point) {
  const Vec3 from = Vec3(f.centre) - point;
  // The rounding of axes turns the vector a little.
  const double turned = 4 * double(std::numeric_limits<T>::epsilon()) * max_abs(from);
  double middle[3], most[3], xx = 0, yy = 0, xy = 0, turn_x = 0, turn_y = 0;  // of r, and of r . (s_x - middle) ..
  for (int c = 0; c < 3; ++c) {
    middle[c] = dot(from, Vec3(f.axes[c]));
    const double reach = double(f.reach[c]) + turned, low = middle[c] - reach, high = middle[c] + reach;
    most[c] = std::max(-low, high);
    const auto least = [&](double from_bend, double to_bend) {
      return std::min(std::min(low * from_bend, low * to_bend), std::min(high * from_bend, high * to_bend));
    };
    xx += least(f.bend_xx[c][0], f.bend_xx[c][1]), yy += least(f.bend_yy[c][0], f.bend_yy[c][1]);
    xy += most[c] * f.bend_xy[c];
    turn_x += most[c] * f.turn_x[c], turn_y += most[c] * f.turn_y[c];
  }
  const double half_u = 0.5 * double(f.length_u), half_v = 0.5 * double(f.length_v);
  const double cosine = f.cosine, sine = f.sine, skew = std::abs(cosine);
  const auto slope = [](double value, double reach) {
    return value > reach ? Slope::rises : value < -reach ? Slope::falls : Slope::unknown;
  };
  const double reach_x = half_u + skew * half_v + double(f.off[0]) + turn_x;
  const double reach_y = half_v + skew * half_u + skew * double(f.off[0]) + double(f.off[1]) + turn_y;
  const double off_x = std::sqrt(squared(f.turn_x)), off_y = std::sqrt(squared(f.turn_y));
  const double least_x = std::max(1 - off_x, 0.0), least_y = std::max(1 - off_y, 0.0);
  const double h_xx = least_x * least_x + xx, h_yy = least_y * least_y + yy;
  const double h_xy = skew + off_x + off_y + off_x * off_y + xy;
  const bool is_convex =
      double(f.least_square) + std::min(xx, yy) - xy > 0 || (h_xx > 0 && h_yy > 0 && h_xx * h_yy > h_xy * h_xy);
  return {slope(middle[0], reach_x), slope(cosine * middle[0] + sine * middle[1], reach_y), is_convex, h_xx > 0,
          h_yy > 0};
}

}}  // namespace tessera::abi_0_1
