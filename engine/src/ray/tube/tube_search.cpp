// A ray against the tube of an edge.

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/infinity.h"
#include "ray/tube/edge_tubes.h"

namespace tessera { inline namespace abi_0_1 {
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

  /// Calls found(point, goes_on) for parts of the chord's curve within the gap. `goes_on`: the part begins where the
  /// last one ended, in this chord or the one before it.
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
      if (near_.distance(point.position) <= gap_ || !is_fine) {
        found(point, goes_on(chord, part.from));
        last_ = &chord, last_to_ = part.to;
      }
      return;
    }
    const Point middle = near_.see(point.position);
    visit(chord, {part.from, x, part.start, middle, part.off / 4}, found);
    visit(chord, {x, part.to, middle, part.end, part.off / 4}, found);
  }

  bool goes_on(const TubeChord& chord, double from) const {
    return last_ == &chord ? last_to_ == from
                           : last_ != nullptr && last_ + 1 == &chord && last_to_ == last_->to && from == chord.from;
  }

  const SetView& set_;
  const SceneFrame& frame_;
  double gap_;
  const Near& near_;
  int points_ = 0;
  const TubeChord* last_ = nullptr;  ///< the chord of the last part within the gap
  double last_to_ = 0;               ///< where that part ended
};

struct Nearest {
  double share, distance;
};

/// Distances from a line. Parts behind its start do not count. Those beyond its end do, if they are near it: the
/// nearest point decides whether the line ends before it.
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
  // A passage is a run of neighbouring parts within the gap. Its nearest point stands for it, and the first of these
  // along the line counts. A line that ends at that point has the same one, whatever parts lie behind.
  LeafRoot first, passage;
  first.s = passage.s = infinity;
  const NearLine near(line);
  TubeWalk walk(*set_, frame_, tube.gap, near);
  for (const TubeChord& chord : chords)
    walk.walk(chord, [&](const LoopPoint& point, bool goes_on) {
      const SeenPoint at = near.see(point.position);
      const double residual = std::hypot(at.x, at.y);
      if (goes_on && !(residual < passage.residual)) return;
      if (!goes_on && passage.s < first.s) first = passage;
      passage.patch = point.patch, passage.u = point.u, passage.v = point.v;
      passage.s = at.s, passage.residual = residual;
    });
  if (passage.s < first.s) first = passage;
  // By t as it is reported: line.far is rounded.
  if (first.s == infinity || line.t_at(first.s) > query.ray.tfar) return;
  const NearPoint origin(line.start + line.near * line.direction);
  TubeWalk from_origin(*set_, frame_, tube.gap, origin);
  bool holds_origin = false;
  for (const TubeChord& chord : chords)
    if (!holds_origin) from_origin.walk(chord, [&](const LoopPoint&, bool) { holds_origin = true; });
  if (holds_origin) return;
  first.certified = first.is_on_edge = true;
  first.s = std::max(first.s, line.near);
  query.take_edge(first, tube.gap);
}

}}  // namespace tessera::abi_0_1
