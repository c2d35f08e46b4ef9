// A ray against the tube of an edge.

#include <algorithm>
#include <cmath>
#include <optional>

#include "ray/tube/edge_tubes.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr int max_points = 4096;  // of curves, for one ray and one tube
constexpr double fine = 1e-3;     // share of the gap up to which a curve may leave its chord

/// A part of a chord's curve: it lies within `off` of the line between its ends.
template <class Point>
struct Part {
  double from, to;  ///< of the piece
  Point start, end;
  double off;
};

/// A point as a line sees it: across it, and along it.
struct SeenPoint {
  double x, y, s;
};

/// Finds the place of a tube's curve that is the first one within its gap of something. `Near` measures parts.
template <class Near>
class TubeWalk {
 public:
  using Point = typename Near::Point;
  TubeWalk(const SetView& set, const SceneFrame& frame, double gap, const Near& near)
      : set_(set), frame_(frame), gap_(gap), near_(near) {}

  /// Calls found(place, point) for parts of the chord's curve within the gap.
  template <class Found>
  void walk(const TubeChord& chord, const Found& found) {
    visit(chord, {chord.from, chord.to, near_.see(chord.start), near_.see(chord.end), chord.off}, found);
  }

 private:
  template <class Found>
  void visit(const TubeChord& chord, const Part<Point>& part, const Found& found) {
    const auto at = near_.nearest(part);
    if (!at || at->distance > gap_ + part.off) return;
    const bool is_fine = part.off <= fine * gap_;
    const double x = is_fine ? (1 - at->share) * part.from + at->share * part.to : (part.from + part.to) / 2;
    const LoopPoint point = loop_point(set_, frame_, *chord.piece, chord.patch, x);
    if (is_fine || ++points_ > max_points) {
      if (near_.distance(point.position) <= gap_ || !is_fine) found(point);
      return;
    }
    const Point middle = near_.see(point.position);
    visit(chord, {part.from, x, part.start, middle, part.off / 4}, found);
    visit(chord, {x, part.to, middle, part.end, part.off / 4}, found);
  }

  const SetView& set_;
  const SceneFrame& frame_;
  double gap_;
  const Near& near_;
  int points_ = 0;
};

struct Nearest {
  double share, distance;
};

/// Distances from a line. Parts behind its start do not count. Those beyond its end do, if they are near it: the nearest
/// point decides whether the line ends before it.
class NearLine {
 public:
  using Point = SeenPoint;
  explicit NearLine(const RayLine& line) : line_(line), near_(line.near - line.slack), far_(line.far + line.slack) {}

  SeenPoint see(const Vec3& p) const {
    const Vec3 from = p - line_.start;
    return {dot(line_.across[0], from), dot(line_.across[1], from), dot(line_.direction, from)};
  }
  double distance(const Vec3& p) const {
    const SeenPoint at = see(p);
    return std::hypot(at.x, at.y);
  }
  std::optional<Nearest> nearest(const Part<SeenPoint>& part) const {
    const SeenPoint &a = part.start, &b = part.end;
    const double from = near_ - part.off, ds = b.s - a.s;
    if (std::max(a.s, b.s) < from || std::min(a.s, b.s) > far_ + part.off) return {};
    const double low = a.s < from ? std::min((from - a.s) / ds, 1.0) : 0;
    const double high = b.s < from ? std::clamp((from - a.s) / ds, low, 1.0) : 1;
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    const double share = square > 0 ? std::clamp(-(a.x * dx + a.y * dy) / square, low, high) : low;
    return Nearest{share, std::hypot(a.x + share * dx, a.y + share * dy)};
  }

 private:
  const RayLine& line_;
  double near_, far_;
};

/// Distances from a point.
class NearPoint {
 public:
  using Point = Vec3;
  explicit NearPoint(const Vec3& point) : point_(point) {}

  Vec3 see(const Vec3& p) const { return p - point_; }
  double distance(const Vec3& p) const { return length(p - point_); }
  std::optional<Nearest> nearest(const Part<Vec3>& part) const {
    const Vec3 along = part.end - part.start;
    const double square = dot(along, along);
    const double share = square > 0 ? std::clamp(-dot(part.start, along) / square, 0.0, 1.0) : 0;
    return Nearest{share, length(part.start + share * along)};
  }

 private:
  Vec3 point_;
};

}  // namespace

void EdgeTubes::search(unsigned index, RayQuery& query) const {
  const Tube& tube = tubes_[index];
  const std::span<const TubeChord> chords = std::span(chords_).subspan(tube.first, tube.count);
  const RayLine& line = query.line;
  ++query.steps;
  LeafRoot best;
  bool found = false;
  const NearLine near(line);
  TubeWalk walk(*set_, frame_, tube.gap, near);
  for (const TubeChord& chord : chords)
    walk.walk(chord, [&](const LoopPoint& point) {
      const SeenPoint at = near.see(point.position);
      const double residual = std::hypot(at.x, at.y);
      // The nearest point of one passage counts, and the first passage of several.
      const bool is_better = std::abs(at.s - best.s) > 2 * tube.gap ? at.s < best.s : residual < best.residual;
      if (found && !is_better) return;
      found = true;
      best.patch = point.patch, best.u = point.u, best.v = point.v;
      best.s = at.s, best.residual = residual;
    });
  if (!found || best.s > line.far) return;
  const NearPoint origin(line.start + line.near * line.direction);
  TubeWalk from_origin(*set_, frame_, tube.gap, origin);
  bool holds_origin = false;
  for (const TubeChord& chord : chords)
    if (!holds_origin) from_origin.walk(chord, [&](const LoopPoint&) { holds_origin = true; });
  if (holds_origin) return;
  best.certified = best.is_seam = true;
  best.s = std::max(best.s, line.near);
  query.take_seam(best, tube.gap);
}

}  // namespace tessera::inline abi_0_1
