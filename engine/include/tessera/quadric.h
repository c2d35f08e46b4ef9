#pragma once
// Quadrics: classification, canonical frame, pieces between ranges of the canonical parameters, and ray intersection.
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The quadric a x^2 + b y^2 + c z^2 + 2 d xy + 2 e yz + 2 f xz + 2 g x + 2 h y + 2 j z + k = 0, that is P Q P^T = 0
/// with P = [x y z 1] and Q = [[a,d,f,g],[d,b,e,h],[f,e,c,j],[g,h,j,k]].
struct QuadricCoefficients {
  double a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0, j = 0, k = 0;  ///< coefficients of the equation
};

/// Kind of a quadric, with its equation in the canonical frame and the canonical parametrisation of its surface. Here
/// a, b, c = Quadric::size(), x2 is x squared, and s = 1 on sheet 0, -1 on sheet 1. Angles are in radians.
enum class QuadricKind : std::uint8_t {
  ellipsoid,               ///< x2/a2 + y2/b2 + z2/c2 = 1: (a cos u cos v, b sin u cos v, c sin v), |v| <= pi/2
  hyperboloid_one_sheet,   ///< x2/a2 + y2/b2 - z2/c2 = 1: (a cos u cosh v, b sin u cosh v, c sinh v)
  hyperboloid_two_sheets,  ///< -x2/a2 - y2/b2 + z2/c2 = 1: (a cos u sinh v, b sin u sinh v, s c cosh v)
  elliptic_cone,           ///< x2/a2 + y2/b2 = z2: (a v cos u, b v sin u, v); c = 1
  elliptic_paraboloid,     ///< x2/a2 + y2/b2 = z: (a v cos u, b v sin u, v^2); c = 1
  hyperbolic_paraboloid,   ///< x2/a2 - y2/b2 = z: (a u, b v, u^2 - v^2); c = 1
  elliptic_cylinder,       ///< x2/a2 + y2/b2 = 1: (a cos u, b sin u, v); c = 1
  hyperbolic_cylinder,     ///< x2/a2 - y2/b2 = 1: (s a cosh u, b sinh u, v); c = 1
  parabolic_cylinder,      ///< x2/a2 = z: (a u, v, u^2); b = c = 1
  intersecting_planes,     ///< x2/a2 = y2/b2, a2 + b2 = 1: (a u, s b u, v); c = 1
  parallel_planes,         ///< x2 = a2: (s a, u, v); b = c = 1
  coincident_planes,       ///< x2 = 0: (0, u, v)
  plane,                   ///< x = 0, from a linear equation: (0, u, v)
  line,                    ///< imaginary intersecting planes, x2/a2 + y2/b2 = 0: the z axis
  point,                   ///< an imaginary cone, x2/a2 + y2/b2 + z2/c2 = 0: the origin
  imaginary_ellipsoid,     ///< x2/a2 + y2/b2 + z2/c2 = -1: empty
  imaginary_cylinder,      ///< x2/a2 + y2/b2 = -1: empty
  imaginary_planes,        ///< x2 = -a2: empty
  empty,                   ///< no solution: all coefficients but the constant k are 0, and k is not
};
/// Returns the kind's name for messages, such as "elliptic cone".
std::string_view name(QuadricKind kind);
/// Tells whether the real points of the kind form a surface.
bool is_surface(QuadricKind kind);
/// Returns the number of sheets: two for two sheets, two planes and a hyperbolic cylinder, otherwise one; 0 without a
/// surface.
int sheet_count(QuadricKind kind);

/// Largest values that count as zero.
struct QuadricOptions {
  /// Share in (0, 0.01]; units of length and a common factor of the coefficients have no effect. A value counts as 0
  /// below this share of its reference:
  ///
  /// - an eigenvalue of the quadratic part: the largest eigenvalue;
  /// - the linear part along null directions: the largest of quadratic, linear and constant part at length L;
  /// - the constant, taken at the centre: the largest of the terms that it is the sum of.
  double tolerance = 1e-13;
  /// L, the length at which terms of different degree are compared. 0 takes the largest length at which the quadratic
  /// part equals the linear or the constant one. Otherwise a part that is below `tolerance` of the largest at this
  /// length counts as 0 altogether: a plane with a trace of curvature needs this.
  double length = 0;
};

/// The canonical frame: a point of the model is origin + x axes[0] + y axes[1] + z axes[2]. The axes are a right-handed
/// rotation. If several frames fit, the axes are as near to the model's own as possible.
struct QuadricFrame {
  Vec3 origin;  ///< centre or vertex; if there are many, the one nearest to zero
  std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  ///< unit, right-handed

  /// Maps a direction from the frame to the model.
  Vec3 vector(const Vec3& p) const { return p.x * axes[0] + p.y * axes[1] + p.z * axes[2]; }
  Vec3 point(const Vec3& p) const { return origin + vector(p); }  ///< maps a point from the frame to the model
  /// Maps a direction from the model to the frame.
  Vec3 local_vector(const Vec3& d) const { return {dot(d, axes[0]), dot(d, axes[1]), dot(d, axes[2])}; }
  Vec3 local(const Vec3& p) const { return local_vector(p - origin); }  ///< maps a point from the model to the frame
};

/// A classified quadric. Immutable except for assignment.
class Quadric {
 public:
  /// Classifies a quadric and finds its canonical frame. Sizes and origin are right to some units of 2^-52 times the
  /// ratio of the largest eigenvalue to their own.
  ///
  /// Errors: non_finite (index = the coefficient, 0..9 for a..k; or the canonical form overflows), invalid_argument
  /// (all coefficients are 0; tolerance not in (0, 0.01]; length negative or not finite). Source: the principal axis
  /// theorem (Farin and Hansford, Practical Linear Algebra, on quadratic forms), and completing squares.
  static Result<Quadric> make(const QuadricCoefficients& coefficients, const QuadricOptions& options = {});

  const QuadricCoefficients& coefficients() const { return coefficients_; }  ///< the argument of make()
  QuadricKind kind() const { return kind_; }                                 ///< found from the eigenvalues
  const QuadricFrame& frame() const { return frame_; }  ///< the frame in which the equation is canonical
  const Vec3& size() const { return size_; }            ///< a, b, c of QuadricKind; 1 where the kind has none

  /// The canonical equation squares . (x2, y2, z2) + linear . (x, y, z) + constant = 0.
  struct Diagonal {
    Vec3 squares, linear;  ///< coefficients of the squares and of the linear terms
    double constant = 0;   ///< the term without a variable
  };
  Diagonal diagonal() const;  ///< the equation in the frame

 private:
  Quadric() = default;
  QuadricCoefficients coefficients_;
  QuadricKind kind_ = QuadricKind::empty;
  QuadricFrame frame_;
  Vec3 size_{1, 1, 1};
};

/// Intersections of a line with a quadric.
struct QuadricHits {
  int count = 0;              ///< number of different t, 0 to 2
  std::array<double, 2> t{};  ///< ascending; points are origin + t direction, t of either sign
  bool tangent = false;       ///< a double root: the discriminant is 0 within its own rounding
  bool contained = false;     ///< the whole line lies in the surface within rounding; count is then 0
};
/// Intersects a whole line with a quadric.
///
/// Result: every t of origin + t direction on the quadric; none for a zero or non-finite ray. Each t is a root of a
/// quadratic that is within a few units of rounding of the true one about the line's point nearest to the centre (no
/// cancellation for far origins); near tangency t itself has half the digits. A hit whose t overflows is left out.
/// Source: the quadratic formula without cancellation (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed.,
/// sec. 1.8).
QuadricHits intersect(const Quadric& quadric, const Vec3& origin, const Vec3& direction);

/// The canonical parameters of a point, and its sheet.
struct QuadricParameters {
  double u = 0, v = 0;  ///< canonical parameters, see QuadricKind
  int sheet = 0;        ///< below sheet_count()
};

/// The piece of a quadric between ranges of the canonical parameters. Immutable except for assignment; copies share
/// their quadric.
class QuadricPiece {
 public:
  /// Makes a piece.
  ///
  /// - `range`: angles u with |u| <= 100 that span at most 2 pi (to within 4e-15; at 2 pi the piece closes), latitudes
  ///   of an ellipsoid within [-pi/2, pi/2], arguments of cosh within [-300, 300].
  /// - `sheet`: from 0 to sheet_count() - 1.
  ///
  /// Errors: unsupported (the kind has no surface), non_finite, invalid_argument (a range that is empty, reversed or
  /// outside these limits; no such sheet).
  static Result<QuadricPiece> make(const Quadric& quadric, const Domain& range, int sheet = 0);

  const Quadric& quadric() const { return data_->quadric; }  ///< the whole surface
  const Domain& range() const { return data_->range; }       ///< ranges of the canonical parameters
  int sheet() const { return data_->sheet; }                 ///< the argument of make()
  /// Returns the parameters of a point of the surface if it lies in the piece, whose borders have a margin of 1e-12 of
  /// the ranges.
  std::optional<QuadricParameters> locate(const Vec3& point) const;

 private:
  struct Data {
    Quadric quadric;
    Domain range;
    int sheet;
  };
  explicit QuadricPiece(const Data& data);
  std::shared_ptr<const Data> data_;
};

/// Returns position and derivatives by the canonical parameters: the reference evaluator.
SurfaceJet evaluate_jet(const QuadricPiece& piece, double u, double v);
/// Returns the hits of the whole quadric that lie in the piece. Contained lines are not cut.
QuadricHits intersect(const QuadricPiece& piece, const Vec3& origin, const Vec3& direction);

/// Returns the canonical parameters of the point that to_bezier(piece) has at its own parameters (u, v) in the range:
/// on an arc about m of half-width h, m + 2 atan(tan(h/2) s) with s from -1 to 1 (atanh and tanh for cosh); otherwise
/// u, v themselves. Source: the standard form of a conic's arc is its rational parametrisation by the tangent of half
/// the angle (Farin, Curves and Surfaces for CAGD, 5th ed., sec. 12.4).
QuadricParameters canonical_parameters(const QuadricPiece& piece, double u, double v);
/// Returns the parameters in the grid of the point with these canonical parameters: the inverse of
/// canonical_parameters().
QuadricParameters grid_parameters(const QuadricPiece& piece, double u, double v);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
