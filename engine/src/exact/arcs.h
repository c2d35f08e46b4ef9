#pragma once
// The unit circle between two angles as rational quadratic arcs, and the relation of their parameter to the angle.

#include <numbers>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

inline constexpr double full_turn = 2 * std::numbers::pi;  ///< radians

/// Arcs of equal length, at most 90 degrees each, which meet in double knots; at the knots, their parameter is the
/// angle. Within an arc about m of half-width h, it is m + h tan((angle - m)/2) / tan(h/2): the rational quadratic of
/// weights 1, cos h, 1 is the stereographic one (Farin, Curves and Surfaces for CAGD, 5th ed., sec. 12.6, 12.8).
class Arcs {
 public:
  /// Requires from < to. At most a full turn, which closes bit for bit.
  Arcs(double from, double to);

  double from() const { return from_; }
  double to() const { return to_; }
  double step() const { return (to_ - from_) / count_; }  ///< the angle of each arc

  /// A control point of the circle, (cosine, sine) as coordinates in the plane.
  struct Point {
    double cosine = 1, sine = 0, weight = 1;
  };
  std::vector<Point> points() const;
  std::vector<double> knots() const;

  /// Conversions between angle and parameter; beyond the ends, more arcs of the same length follow, so that an
  /// angle a full turn away has a parameter a full turn away.
  double parameter(double angle) const;
  double angle(double parameter) const;
  /// d parameter / d angle at a parameter; continuous, because the arcs are equal.
  double slope(double parameter) const;

 private:
  double middle(double value) const;
  double knot(double k) const { return k == count_ ? to_ : from_ + (to_ - from_) * k / count_; }
  double from_, to_;
  int count_;
  double half_;     ///< of the angle of each arc
  double tangent_;  ///< of a quarter of that angle
};

}}  // namespace tessera::abi_0_1
