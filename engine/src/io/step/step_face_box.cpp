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

/// The least value of a function with one minimum in an interval, by golden sections and parabolas (Brent, Algorithms
/// for Minimization without Derivatives, 1973, ch. 5). Ends after 40 steps.
template <class Function>
double least_value(const Function& f, double from, double to) {
  constexpr double golden = 0.3819660112501051, accuracy = 1e-8;
  double x = from + golden * (to - from), w = x, v = x, step = 0, before = 0;
  double fx = f(x), fw = fx, fv = fx;
  const double tiny = accuracy * (to - from);
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (from + to);
    if (std::abs(x - middle) <= 2 * tiny - 0.5 * (to - from)) break;
    double p = 0, q = 0;
    if (std::abs(before) > tiny) {
      const double r = (x - w) * (fx - fv);
      q = (x - v) * (fx - fw);
      p = (x - v) * q - (x - w) * r;
      q = 2 * (q - r);
      p = q > 0 ? -p : p;
      q = std::abs(q);
    }
    const bool is_parabola =
        q > 0 && std::abs(p) < std::abs(0.5 * q * before) && p > q * (from - x) && p < q * (to - x);
    before = is_parabola ? step : (x < middle ? to - x : from - x);
    step = is_parabola ? p / q : golden * before;
    const double u = x + (std::abs(step) >= tiny ? step : std::copysign(tiny, step)), fu = f(u);
    if (fu <= fx) {
      (u < x ? to : from) = x;
      v = w, fv = fw, w = x, fw = fx, x = u, fx = fu;
      continue;
    }
    (u < x ? from : to) = u;
    if (fu <= fw || w == x)
      v = w, fv = fw, w = u, fw = fu;
    else if (fu <= fv || v == x || v == w)
      v = u, fv = fu;
  }
  return fx;
}

/// Finds how far the loops of a face reach along one parameter.
class ExtentFinder {
 public:
  ExtentFinder(const SurfaceInverse& inverse, std::span<const BrepEdge> edges, Along along, double tolerance)
      : inverse_(inverse), edges_(edges), along_(along), tolerance_(tolerance) {}

  Extent find(const LoopTrace& loop) const {
    Extent out;
    for (const EdgeTrace& piece : loop.pieces) out.extend(sampled(piece));
    const Extent of_samples = out;
    for (const EdgeTrace& piece : loop.pieces) {
      const bool is_straight = piece.edge != no_id && inverse_.plane() && edges_[piece.edge].curve->degree() == 1;
      if (piece.edge == no_id || is_straight || is_constant(piece)) continue;
      const FastCurve curve(*edges_[piece.edge].curve);
      out.extend(largest(curve, piece, 1, of_samples.to));
      out.extend(-largest(curve, piece, -1, -of_samples.from));
    }
    return out;
  }

 private:
  std::optional<double> constant(const EdgeTrace& piece) const {
    return constant_parameter(inverse_, piece, along_ == Along::u, tolerance_);
  }
  bool is_constant(const EdgeTrace& piece) const { return constant(piece).has_value(); }

  Extent sampled(const EdgeTrace& piece) const {
    if (const std::optional<double> value = constant(piece)) return {*value, *value};
    Extent out;
    for (const TraceSample& sample : piece.samples) out.extend(of(sample.place, along_));
    return out;
  }

  /// The largest of `sign` times the parameter between samples, as far as it may exceed `most`, the largest of all
  /// samples.
  double largest(const FastCurve& curve, const EdgeTrace& piece, double sign, double most) const {
    const std::vector<TraceSample>& samples = piece.samples;
    const std::size_t last = samples.size() - 1;
    const auto value = [&](std::size_t k) { return sign * of(samples[k].place, along_); };
    if (is_end_of_surface(sign, most)) return most;
    double out = most;
    for (std::size_t k = 0; k <= last; ++k) {
      const std::size_t before = k == 0 ? 0 : k - 1, after = std::min(k + 1, last);
      const double step = std::max(value(k) - value(before), value(k) - value(after));
      const bool is_peak = value(k) >= value(before) && value(k) >= value(after);
      if (!is_peak || value(k) + step <= most || ((k == 0 || k == last) && falls_from(samples, k == 0, value)))
        continue;
      const auto negative = [&](double s) { return -sign * of(inverse_.at(curve.point(s), samples[k].place), along_); };
      const double from = samples[before].s, to = samples[after].s, here = samples[k].s;
      // From an end, the curve may fall at once.
      if ((k == 0 || k == last) && negative(here + 1e-3 * (from + to - 2 * here)) > -value(k)) continue;
      out = std::max(out, -least_value(negative, std::min(from, to), std::max(from, to)));
    }
    return out;
  }

  /// Whether nothing can be beyond a value: the surface ends there.
  bool is_end_of_surface(double sign, double value) const {
    if (of(inverse_.period(), along_) > 0) return false;
    const Domain& whole = inverse_.whole();
    const double from = along_ == Along::u ? whole.u0 : whole.v0, to = along_ == Along::u ? whole.u1 : whole.v1;
    return value >= (sign > 0 ? to : -from) - 1e-14 * (to - from);
  }

  /// Whether the parabola through the first (or the last) three samples falls from the end, clearly.
  template <class Value>
  static bool falls_from(const std::vector<TraceSample>& samples, bool at_start, const Value& value) {
    if (samples.size() < 3) return false;
    const auto place = [&](std::size_t k) { return at_start ? k : samples.size() - 1 - k; };
    const double a = samples[place(1)].s - samples[place(0)].s, b = samples[place(2)].s - samples[place(0)].s;
    const double fa = value(place(1)) - value(place(0)), fb = value(place(2)) - value(place(0));
    if (!(fa < 0) || a == 0 || b == a) return false;
    const double slope = (fa / a * b - fb / b * a) / (b - a);
    return slope * a < 0.5 * fa;
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
    // Between two loops around the other parameter, the face lies after the one and before the other.
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
