#pragma once
// The canonical parametrisations of quadrics as products of plane curves, for evaluation and conversion.

#include <array>
#include <cstddef>

#include "tessera/quadric.h"

namespace tessera { inline namespace abi_0_1 {

/// The two functions of a canonical parameter t that make the parametrisation.
enum class Profile : std::uint8_t {
  circle,     ///< cos t, sin t
  hyperbola,  ///< cosh t, sinh t
  parabola,   ///< t, t^2
  line,       ///< t, t
};
struct Profiles {
  Profile u, v;
};
/// Returns the profiles of a kind that is a surface.
Profiles profiles(QuadricKind kind);

/// One direction's contribution: the constant 1 and the profile's two functions, or their derivatives 0, f', g'.
struct ProfileValue {
  double one = 1, f = 0, g = 0;
};
/// Returns the order-th derivative of (1, f, g), order 0 to 2; cos and sin are exact at multiples of pi/2.
ProfileValue profile_value(Profile profile, double t, int order = 0);
/// Returns the canonical point, bilinear in the two directions' values. `sign` is 1 on sheet 0, -1 on sheet 1.
Vec3 canonical_point(const Quadric& quadric, double sign, const ProfileValue& u, const ProfileValue& v);

/// Whether segments of the profile have a rational parameter of their own.
constexpr bool is_arc(Profile profile) { return profile == Profile::circle || profile == Profile::hyperbola; }

/// A range of t cut into Bezier segments of equal width: their number, and where segment k begins. The ends are exact.
/// Beyond them, further segments of the same width follow.
struct SegmentedRange {
  SegmentedRange(Profile profile, double from, double to);
  double begin(double k) const { return k == 0 ? from_ : k == count ? to_ : from_ + (to_ - from_) * k / count; }
  /// Returns the segment that holds t, a whole number; at a break the one on its right.
  double segment(double t) const;

  int count = 1;

 private:
  double from_, to_;
};
bool is_full_turn(double from, double to);
/// Convert the fraction s of the Bezier segment over [from, to] to the canonical parameter, and back.
double profile_parameter(Profile profile, double from, double to, double s);
double profile_fraction(Profile profile, double from, double to, double t);

/// A parameter of to_bezier()'s grid, and its derivative by the canonical parameter.
struct GridParameter {
  double value = 0, slope = 1;
};
/// Converts the canonical parameter t on a surface over [from, to]. Beyond the ends further segments follow, so an
/// angle a full turn away has a parameter a full turn away.
GridParameter grid_parameter(Profile profile, double from, double to, double t);
/// Converts a parameter of the grid to the canonical one: the inverse of grid_parameter().
double canonical_parameter(Profile profile, double from, double to, double t);

}}  // namespace tessera::abi_0_1
