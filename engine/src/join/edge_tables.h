#pragma once
// Coedge::parameter of curves that run beside one another at different paces.

#include <optional>

#include "base/function_ref.h"
#include "join/space_curve.h"

namespace tessera { inline namespace abi_0_1 {

/// A line that leads: its point at s, for s in a range.
struct LeadingLine {
  FunctionRef<Vec3(double)> at;
  Interval range;
};

/// A curve that follows it from end to end.
struct FollowingLine {
  const SpaceCurve* curve;
  Interval within;  ///< of the curve's parameter
  bool turned;      ///< whether it runs against s
};

/// Returns the parameter of the nearest point of `follower` by s, monotone, as Coedge::parameter states it: fractions
/// of linear functions, each through the nearest points of both ends and the middle of its range. Points at equal s are
/// apart by at most `slack` more than nearest ones, as sampled, unless that takes more than 1,024 pieces per piece of
/// the start, or nearest points run back. Empty if t = s, or t = from + to - s, is as good.
std::optional<Curve> following_parameter(const LeadingLine& leader, const FollowingLine& follower, double slack);

/// Returns the parameter that runs evenly from one end of `to` to the other. Empty if it is t = s or t = from + to - s.
std::optional<Curve> even_parameter(const Interval& range, const Interval& to, bool turned);

}}  // namespace tessera::abi_0_1
