#include "ray/tube/centre_curve.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int steps = 4;  // towards the nearest point of a curve that is nearly its chord

/// Returns the share of a chord's line at which it is nearest to a point.
double nearest_share(const TubeChord& chord, const Vec3& point) {
  const Vec3 along = chord.end - chord.start;
  const double square = dot(along, along);
  return square > 0 ? std::clamp(dot(point - chord.start, along) / square, 0.0, 1.0) : 0;
}

double distance_from_line(const TubeChord& chord, const Vec3& point) {
  const double share = nearest_share(chord, point);
  return length(point - (1 - share) * chord.start - share * chord.end);
}

}  // namespace

CentreCurve::CentreCurve(const EdgeCurves& curves, const EdgeCurve& curve, std::span<const TubeChord> chords)
    : curves_(curves), curve_(curve), chords_(chords) {
  for (const TubeChord& chord : chords) ends_.push_back(curves.parameter(curve[chord.stretch], chord.to));
}

std::size_t CentreCurve::chord_of(double s) const {
  const auto found = static_cast<std::size_t>(std::ranges::lower_bound(ends_, s) - ends_.begin());
  return std::min(found, chords_.size() - 1);
}

CentreCurve::Place CentreCurve::nearest(const LoopPoint& point, double s) const {
  Place best = at(s);
  std::size_t k = best.chord;
  double off = distance_from_line(chords_[k], point.position);
  const auto nearer = [&](std::size_t other) {
    const double there = distance_from_line(chords_[other], point.position);
    if (!(there < off)) return false;
    k = other, off = there;
    return true;
  };
  while (k + 1 < chords_.size() && nearer(k + 1)) {
  }
  while (k > 0 && nearer(k - 1)) {
  }
  const TubeChord& chord = chords_[k];
  const Vec3 along = chord.end - chord.start;
  const double square = dot(along, along);
  double share = nearest_share(chord, point.position);
  for (int step = 0; step < steps; ++step) {
    const double x = (1 - share) * chord.from + share * chord.to;
    const Place here{k, curves_.at_place(curve_[chord.stretch], x)};
    if (here.distance(point) < best.distance(point)) best = here;
    if (!(square > 0)) break;
    share = std::clamp(share + dot(point.position - here.point.position, along) / square, 0.0, 1.0);
  }
  return best;
}

}}  // namespace tessera::abi_0_1
