#include "io/step/step_face_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// One of the two parameters.
enum class Along : std::uint8_t { u, v };
double of(const ParameterPoint& p, Along along) { return along == Along::u ? p.u : p.v; }

struct Extent {
  double from = std::numeric_limits<double>::infinity(), to = -std::numeric_limits<double>::infinity();
  bool empty() const { return !(from <= to); }
  double width() const { return to - from; }
  void extend(double value) { from = std::min(from, value), to = std::max(to, value); }
  void extend(const Extent& other) { from = std::min(from, other.from), to = std::max(to, other.to); }
};

/// Finds how far the loops of a face reach along one parameter.
class ExtentFinder {
 public:
  ExtentFinder(const SurfaceInverse& inverse, std::span<const BrepEdge> edges, Along along, double tolerance)
      : inverse_(inverse), edges_(edges), along_(along), tolerance_(tolerance) {}

  Extent find(const LoopTrace& loop) const {
    Extent out;
    for (const EdgeTrace& piece : loop.pieces) out.extend(find(piece));
    return out;
  }

 private:
  struct Place {
    double s, value;
  };

  Extent find(const EdgeTrace& piece) const {
    const auto constant = constant_parameter(inverse_, piece, along_ == Along::u, tolerance_);
    if (constant) return {*constant, *constant};
    Extent out;
    for (const TraceSample& sample : piece.samples) out.extend(of(sample.place, along_));
    if (piece.edge == no_id) return out;
    const FastCurve curve(*edges_[piece.edge].curve);
    for (std::size_t k = 1; k + 1 < piece.samples.size(); ++k) {
      const auto place = [&](std::size_t at) {
        return Place{piece.samples[at].s, of(piece.samples[at].place, along_)};
      };
      if (const auto extreme = refined(curve, piece.samples[k].place, {place(k - 1), place(k), place(k + 1)}))
        out.extend(*extreme);
    }
    return out;
  }

  /// Goes to the extreme of parabolas through three places, until it rests; nothing if it is not between them.
  std::optional<double> refined(const FastCurve& curve, const ParameterPoint& near, std::array<Place, 3> p) const {
    const double low = std::min(p[0].s, p[2].s), high = std::max(p[0].s, p[2].s);
    std::optional<double> out;
    for (int step = 0; step < 8; ++step) {
      const double a = p[0].s - p[1].s, b = p[2].s - p[1].s, fa = p[0].value - p[1].value, fb = p[2].value - p[1].value;
      const double denominator = 2 * (fa * b - fb * a);
      const double vertex = p[1].s + (fa * b * b - fb * a * a) / denominator;
      if (!(vertex > low && vertex < high)) return out;  // or no parabola
      const double value = of(inverse_.at(curve.point(vertex), near), along_);
      const double change = std::abs(value - p[1].value);
      out = value;
      if (change <= 1e-12 * std::abs(value) || vertex == p[0].s || vertex == p[1].s || vertex == p[2].s) break;
      // The new place replaces the one that is farthest from it.
      const auto far = [&](const Place& one) { return std::abs(one.s - vertex); };
      std::size_t farthest = far(p[0]) > far(p[2]) ? 0 : 2;
      p[farthest] = p[1];
      p[1] = {vertex, value};
    }
    return out;
  }

  const SurfaceInverse& inverse_;
  std::span<const BrepEdge> edges_;
  Along along_;
  double tolerance_;
};

void shift(LoopTrace& loop, Along along, double by) {
  for (EdgeTrace& piece : loop.pieces)
    for (TraceSample& sample : piece.samples) (along == Along::u ? sample.place.u : sample.place.v) += by;
}

/// Twice the area that the loop encloses on its left.
double signed_area(const LoopTrace& loop) {
  double area = 0;
  const ParameterPoint corner = loop.pieces.front().first();
  ParameterPoint before{0, 0};
  for (const EdgeTrace& piece : loop.pieces)
    for (const TraceSample& sample : piece.samples) {
      const ParameterPoint now{sample.place.u - corner.u, sample.place.v - corner.v};
      area += before.u * now.v - now.u * before.v;
      before = now;
    }
  return area;
}

/// Finds one range of the rectangle.
class RangeFinder {
 public:
  RangeFinder(const SurfaceInverse& inverse, std::vector<LoopTrace>& loops, Along along, bool agrees)
      : inverse_(inverse), loops_(loops), along_(along), agrees_(agrees), period_(of(inverse.period(), along)) {
    const Domain& whole = inverse.whole();
    first_ = along == Along::u ? whole.u0 : whole.v0;
    last_ = along == Along::u ? whole.u1 : whole.v1;
  }

  Extent find(std::span<const ParameterPoint> vertices, const ExtentFinder& finder) {
    if (loops_.empty()) return {first_, last_};
    std::vector<Extent> extents;
    for (const LoopTrace& loop : loops_) extents.push_back(finder.find(loop));
    const std::size_t outer = widest(extents);
    Extent out = extents[outer];
    if (period_ > 0) {
      gather(extents, outer, out);
    } else {
      for (const Extent& one : extents) out.extend(one);
      for (const ParameterPoint& vertex : vertices) out.extend(of(vertex, along_));
      reach_poles(out);
    }
    return out;
  }

 private:
  std::size_t widest(const std::vector<Extent>& extents) const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < extents.size(); ++k)
      if (extents[k].width() > extents[best].width()) best = k;
    return best;
  }

  bool winds_here(const LoopTrace& loop) const { return of(loop.winding, along_) != 0; }
  /// How a loop runs around the other parameter: 1 if the face lies beyond it, at larger values, and -1 below it.
  double side_of_face(const LoopTrace& loop) const {
    const double turns = of(loop.winding, along_ == Along::u ? Along::v : Along::u);
    return turns * ((along_ == Along::v) == agrees_ ? 1 : -1);
  }

  /// Moves loops near the widest one; a face that goes around has a whole period.
  void gather(const std::vector<Extent>& extents, std::size_t outer, Extent& out) {
    bool is_full = winds_here(loops_[outer]);
    // Of two loops around the other parameter, the face lies after the one and before the other.
    for (std::size_t k = 0; k < loops_.size(); ++k) {
      if (k == outer) continue;
      is_full = is_full || winds_here(loops_[k]);
      const double middle = 0.5 * (extents[k].from + extents[k].to);
      double goal = 0.5 * (out.from + out.to);
      if (const double side = side_of_face(loops_[outer]); side != 0 && side_of_face(loops_[k]) == -side)
        goal += side * 0.5 * period_;
      const double by = period_ * std::round((goal - middle) / period_);
      shift(loops_[k], along_, by);
      out.extend({extents[k].from + by, extents[k].to + by});
    }
    const double nearly = (1 - 1e-9) * period_;
    if (!is_full && out.width() < nearly) return;
    out.from = extents[outer].from, out.to = out.from + period_;
  }

  /// Extends the range to poles that lie within the face but on no loop.
  void reach_poles(Extent& out) const {
    double side = 0;
    for (const LoopTrace& loop : loops_) side += side_of_face(loop);
    if (side > 0 && std::isfinite(last_)) out.extend(last_);
    if (side < 0 && std::isfinite(first_)) out.extend(first_);
    if (const std::optional<double> apex = inverse_.apex(); apex && along_ == Along::v && side != 0)
      if ((side > 0) == (*apex > out.to)) out.extend(*apex);
  }

  const SurfaceInverse& inverse_;
  std::vector<LoopTrace>& loops_;
  Along along_;
  bool agrees_;
  double period_, first_ = 0, last_ = 0;
};

/// Moves the range and the loops by periods into the range of the surface, if that has ends; a range across the seam
/// becomes all of the surface.
void move_into_surface(const SurfaceInverse& inverse, std::vector<LoopTrace>& loops, Along along, FreeRange& range) {
  if (range.period == 0) return;
  const double tolerance = range.tolerance();
  const double by = range.period * -std::floor((range.from - range.first + tolerance) / range.period);
  range.from += by, range.to += by;
  for (LoopTrace& loop : loops) shift(loop, along, by);
  const bool turns = along == Along::u ? inverse.turns_u() : inverse.turns_v();
  if (!turns && range.to > range.last + tolerance) range.from = range.first, range.to = range.last;
}

/// The largest of some speeds in a rectangle, so that a step of the tolerance is nowhere much longer.
ParameterPoint largest_speeds(const SurfaceInverse& inverse, const Domain& box) {
  ParameterPoint out;
  for (int k = 0; k < 9; ++k) {
    const ParameterPoint there = inverse.speeds({box.u_at(k % 3 / 2.0), box.v_at(k / 3 / 2.0)});
    out = {std::max(out.u, there.u), std::max(out.v, there.v)};
  }
  return out;
}

bool is_unbounded(const FreeRange& range) { return !std::isfinite(range.to - range.from); }

}  // namespace

bool keep_outside(const SurfaceInverse& inverse, std::span<const LoopTrace> loops, bool agrees) {
  const Domain& w = inverse.whole();
  const bool has_end_u = inverse.period().u == 0 && !inverse.is_pole_v({w.u0, w.v0}),
             has_end_v = inverse.period().v == 0 && !(std::isfinite(w.v1 - w.v0) && inverse.is_pole_u({w.u0, w.v0}) &&
                                                      inverse.is_pole_u({w.u0, w.v1}));
  if (loops.empty() || has_end_u || has_end_v) return false;
  return std::ranges::all_of(loops, [&](const LoopTrace& loop) {
    const double area = signed_area(loop) * (agrees ? 1 : -1);
    return loop.winding == ParameterPoint{0, 0} && area < 0;
  });
}

Result<FaceBox> step_face_box(const SurfaceInverse& inverse, std::span<const BrepEdge> edges,
                              std::vector<LoopTrace>& loops, std::span<const ParameterPoint> vertices, bool agrees,
                              double tolerance) {
  const bool is_whole = keep_outside(inverse, loops, agrees);
  const Domain& whole = inverse.whole();
  FreeRange u{0, 0, whole.u0, whole.u1, inverse.period().u, 0, {}},
      v{0, 0, whole.v0, whole.v1, inverse.period().v, 0, {}};
  Extent in_u =
      RangeFinder(inverse, loops, Along::u, agrees).find(vertices, {inverse, edges, Along::u, 1e-3 * tolerance});
  Extent in_v =
      RangeFinder(inverse, loops, Along::v, agrees).find(vertices, {inverse, edges, Along::v, 1e-3 * tolerance});
  if (is_whole) in_u = {whole.u0, whole.u1}, in_v = {whole.v0, whole.v1};
  u.from = in_u.from, u.to = in_u.to, v.from = in_v.from, v.to = in_v.to;
  std::array<std::vector<double>, 2> knots = inverse.knots();
  u.knots = std::move(knots[0]), v.knots = std::move(knots[1]);
  if (is_unbounded(u) || is_unbounded(v)) return Status(StatusCode::unsupported, "it has no bounds");
  const ParameterPoint speeds = largest_speeds(inverse, {u.from, u.to, v.from, v.to});
  u.length_tolerance = speeds.u > 0 ? tolerance / speeds.u : 0;
  v.length_tolerance = speeds.v > 0 ? tolerance / speeds.v : 0;
  for (FreeRange* const side : {&u, &v}) {
    if (!(side->from < side->to)) return Status(StatusCode::unsupported, "it has no extent");
    move_into_surface(inverse, loops, side == &u ? Along::u : Along::v, *side);
    side->settle();
    if (!(side->from < side->to)) return Status(StatusCode::unsupported, "it has no extent");
  }
  return FaceBox{
      {u.from, u.to, v.from, v.to}, u.tolerance(), v.tolerance(), u.ends_with_surface(), v.ends_with_surface()};
}

}}  // namespace tessera::abi_0_1
