#include "surface/quadric/quadric_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double quarter_turn = std::numbers::pi / 2;

/// Returns cos and sin, exact at multiples of pi/2 so that poles and quadrants are exact.
std::array<double, 2> cos_sin(double t) {
  const double quarters = std::round(t / quarter_turn);
  if (!(std::abs(quarters) < 1e9)) return {std::cos(t), std::sin(t)};  // NaN too; no larger double is a multiple
  if (std::abs(t - quarters * quarter_turn) > 4e-16 * std::max(1.0, std::abs(t))) return {std::cos(t), std::sin(t)};
  switch (static_cast<long>(quarters) & 3) {
    case 0:
      return {1, 0};
    case 1:
      return {0, 1};
    case 2:
      return {-1, 0};
    default:
      return {0, -1};
  }
}

ProfileValue circle_value(double t, int order) {
  const auto [c, s] = cos_sin(t);
  if (order == 0) return {1, c, s};
  return order == 1 ? ProfileValue{0, -s, c} : ProfileValue{0, -c, -s};
}
ProfileValue hyperbola_value(double t, int order) {
  const double c = std::cosh(t), s = std::sinh(t);
  if (order == 0) return {1, c, s};
  return order == 1 ? ProfileValue{0, s, c} : ProfileValue{0, c, s};
}

}  // namespace

Profiles profiles(QuadricKind kind) {
  switch (kind) {
    case QuadricKind::ellipsoid:
      return {Profile::circle, Profile::circle};
    case QuadricKind::hyperboloid_one_sheet:
    case QuadricKind::hyperboloid_two_sheets:
      return {Profile::circle, Profile::hyperbola};
    case QuadricKind::elliptic_cone:
    case QuadricKind::elliptic_cylinder:
      return {Profile::circle, Profile::line};
    case QuadricKind::elliptic_paraboloid:
      return {Profile::circle, Profile::parabola};
    case QuadricKind::hyperbolic_paraboloid:
      return {Profile::parabola, Profile::parabola};
    case QuadricKind::hyperbolic_cylinder:
      return {Profile::hyperbola, Profile::line};
    case QuadricKind::parabolic_cylinder:
      return {Profile::parabola, Profile::line};
    default:
      return {Profile::line, Profile::line};
  }
}

ProfileValue profile_value(Profile profile, double t, int order) {
  switch (profile) {
    case Profile::circle:
      return circle_value(t, order);
    case Profile::hyperbola:
      return hyperbola_value(t, order);
    case Profile::parabola:
      if (order == 0) return {1, t, t * t};
      return order == 1 ? ProfileValue{0, 1, 2 * t} : ProfileValue{0, 0, 2};
    case Profile::line:
      break;
  }
  if (order == 0) return {1, t, t};
  return order == 1 ? ProfileValue{0, 1, 1} : ProfileValue{0, 0, 0};
}

Vec3 canonical_point(const Quadric& quadric, double sign, const ProfileValue& u, const ProfileValue& v) {
  const Vec3& size = quadric.size();
  switch (quadric.kind()) {
    case QuadricKind::hyperboloid_two_sheets:
      return {size.x * u.f * v.g, size.y * u.g * v.g, sign * size.z * u.one * v.f};
    case QuadricKind::elliptic_cylinder:
      return {size.x * u.f * v.one, size.y * u.g * v.one, u.one * v.f};
    case QuadricKind::hyperbolic_cylinder:
      return {sign * size.x * u.f * v.one, size.y * u.g * v.one, u.one * v.f};
    case QuadricKind::hyperbolic_paraboloid:
      return {size.x * u.f * v.one, size.y * u.one * v.f, u.g * v.one - u.one * v.g};
    case QuadricKind::parabolic_cylinder:
      return {size.x * u.f * v.one, u.one * v.f, u.g * v.one};
    case QuadricKind::intersecting_planes:
      return {size.x * u.f * v.one, sign * size.y * u.f * v.one, u.one * v.f};
    case QuadricKind::parallel_planes:
      return {sign * size.x * u.one * v.one, u.f * v.one, u.one * v.f};
    case QuadricKind::coincident_planes:
    case QuadricKind::plane:
      return {0, u.f * v.one, u.one * v.f};
    default:
      return {size.x * u.f * v.f, size.y * u.g * v.f, size.z * u.one * v.g};
  }
}

bool is_full_turn(double from, double to) { return std::abs(to - from - 4 * quarter_turn) <= 4e-15; }

SegmentedRange::SegmentedRange(Profile profile, double from, double to) : from_(from), to_(to) {
  const bool round = profile == Profile::circle;
  if (!round && profile != Profile::hyperbola) return;
  // The margin avoids a further cut of a range that is a whole number of arcs except for rounding.
  const double widest = round ? quarter_turn * (1 + 1e-12) : 2;
  count = std::max(1, static_cast<int>(std::ceil((to - from) / widest)));
}

double SegmentedRange::segment(double t) const {
  const double k = std::floor((t - from_) / (to_ - from_) * count);
  return t < begin(k) ? k - 1 : t >= begin(k + 1) ? k + 1 : k;
}

// A standard conic segment about m with half-width h is the projection of the line from tan(h/2) (tanh for hyperbolas):
// x = 1 -+ s^2, y = 2 s, w = 1 +- s^2 has end weights 1 +- s^2 and middle weight 1 -+ s^2, in ratio cos h (cosh h).
double profile_parameter(Profile profile, double from, double to, double s) {
  if (s == 0 || s == 1) return s == 0 ? from : to;
  const double middle = 0.5 * (from + to), quarter = 0.25 * (to - from);
  if (profile == Profile::circle) return middle + 2 * std::atan(std::tan(quarter) * (2 * s - 1));
  if (profile == Profile::hyperbola) return middle + 2 * std::atanh(std::tanh(quarter) * (2 * s - 1));
  return from + s * (to - from);
}

double profile_fraction(Profile profile, double from, double to, double t) {
  if (t == from || t == to) return t == from ? 0 : 1;
  const double middle = 0.5 * (from + to), quarter = 0.25 * (to - from);
  if (profile == Profile::circle) return 0.5 + 0.5 * std::tan(0.5 * (t - middle)) / std::tan(quarter);
  if (profile == Profile::hyperbola) return 0.5 + 0.5 * std::tanh(0.5 * (t - middle)) / std::tanh(quarter);
  return (t - from) / (to - from);
}

GridParameter grid_parameter(Profile profile, double from, double to, double t) {
  if (!is_arc(profile)) return {t, 1};
  const SegmentedRange range(profile, from, to);
  const double k = range.segment(t), a = range.begin(k), b = range.begin(k + 1);
  const double s = profile_fraction(profile, a, b, t), half = 0.5 * (t - 0.5 * (a + b)), quarter = 0.25 * (b - a);
  const double slope = profile == Profile::circle ? 1 / (std::pow(std::cos(half), 2) * std::tan(quarter))
                                                  : 1 / (std::pow(std::cosh(half), 2) * std::tanh(quarter));
  return {s == 1 ? b : a + s * (b - a), quarter * slope};
}

double canonical_parameter(Profile profile, double from, double to, double t) {
  if (!is_arc(profile)) return t;
  const SegmentedRange range(profile, from, to);
  const double k = range.segment(t), a = range.begin(k), b = range.begin(k + 1);
  return profile_parameter(profile, a, b, t == b ? 1 : (t - a) / (b - a));
}

}}  // namespace tessera::abi_0_1
