#include <array>
#include <cmath>
#include <vector>

#include "surface/quadric/quadric_profile.h"
#include "tessera/convert.h"
#include "tessera/guard.h"
#include "tessera/quadric.h"
#include "tessera/status.h"

// Conic segments as rational quadratics in standard form, weights (1, w, 1) (Farin, Curves and Surfaces for CAGD, 5th
// ed., sec. 12.2 to 12.4). The middle point of a circle is where the end tangents meet, and w is the cosine of half the
// arc. A hyperbola uses cosh likewise; a parabola has w = 1.

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Control values of one Bezier segment of a profile; their points are not premultiplied by the weights.
struct Segment {
  int degree = 1;
  std::array<ProfileValue, 3> values;
  std::array<double, 3> weights{1, 1, 1};
};

ProfileValue middle_of_circle(const ProfileValue& p, const ProfileValue& q, double& weight) {
  const double both = 1 + (p.f * q.f + p.g * q.g);  // 2 cos^2 of half the arc, which is at most 45 degrees
  weight = std::sqrt(both / 2);
  return {1, (p.f + q.f) / both, (p.g + q.g) / both};
}

Segment segment(Profile profile, double from, double to, const ProfileValue& first, const ProfileValue& last) {
  if (profile == Profile::line) return {1, {first, last, last}, {1, 1, 1}};
  Segment result{2, {first, first, last}, {1, 1, 1}};
  if (profile == Profile::circle) {
    result.values[1] = middle_of_circle(first, last, result.weights[1]);
  } else if (profile == Profile::hyperbola) {
    const double w = result.weights[1] = std::cosh(0.5 * (to - from));
    const ProfileValue middle = profile_value(profile, 0.5 * (from + to));
    result.values[1] = {1, middle.f / w, middle.g / w};
  } else {
    result.values[1] = {1, 0.5 * (from + to), from * to};  // the polar form of (t, t^2)
  }
  return result;
}

std::vector<double> breaks_of(Profile profile, double from, double to) {
  const SegmentedRange range(profile, from, to);
  std::vector<double> breaks;
  for (int k = 0; k <= range.count; ++k) breaks.push_back(range.begin(k));
  return breaks;
}

/// Returns the segments between the breaks. Neighbours share the values at their break; a full turn ends where it
/// began.
std::vector<Segment> segments(Profile profile, const std::vector<double>& breaks) {
  std::vector<ProfileValue> ends;
  for (const double t : breaks) ends.push_back(profile_value(profile, t));
  if (profile == Profile::circle && is_full_turn(breaks.front(), breaks.back())) ends.back() = ends.front();
  std::vector<Segment> result;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
    result.push_back(segment(profile, breaks[k], breaks[k + 1], ends[k], ends[k + 1]));
  return result;
}

Result<BezierPatch> patch_of(const QuadricPiece& piece, const Segment& u, const Segment& v) {
  const Quadric& quadric = piece.quadric();
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(u.degree); ++i)
    for (std::size_t j = 0; j <= static_cast<std::size_t>(v.degree); ++j) {
      const Vec3 p = canonical_point(quadric, piece.sheet() == 0 ? 1 : -1, u.values[i], v.values[j]);
      points.push_back(quadric.frame().point(p));
      weights.push_back(u.weights[i] * v.weights[j]);
    }
  return BezierPatch::rational(u.degree, v.degree, points, weights);
}

}  // namespace

Result<PatchGrid> to_bezier(const QuadricPiece& piece) {
  return guarded([&]() -> Result<PatchGrid> {
    const Profiles profile = profiles(piece.quadric().kind());
    const Domain& range = piece.range();
    std::vector<double> breaks_u = breaks_of(profile.u, range.u0, range.u1);
    std::vector<double> breaks_v = breaks_of(profile.v, range.v0, range.v1);
    std::vector<BezierPatch> patches;
    const std::vector<Segment> along_v = segments(profile.v, breaks_v);
    for (const Segment& u : segments(profile.u, breaks_u))
      for (const Segment& v : along_v) {
        Result<BezierPatch> patch = patch_of(piece, u, v);
        if (!patch) return patch.status();
        patches.push_back(*std::move(patch));
      }
    return PatchGrid::make(std::move(breaks_u), std::move(breaks_v), std::move(patches));
  });
}

}}  // namespace tessera::abi_0_1
