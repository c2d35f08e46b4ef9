// Curves of edges, from vertex to vertex, and profiles of sweeps, as far as faces reach.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "exact/curve_foot.h"
#include "io/step/step_curves.h"
#include "io/step/step_splines.h"
#include "tessera/convert.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The part of a closed spline from one parameter to another, at most a period later, across its ends.
Result<Curve> across_ends(const Curve& closed, double from, double to) {
  const Result<Curve> clamped = clamp_ends(closed);
  if (!clamped) return clamped.status();
  SplineLine line{clamped->degree(), {}, {}, {}, clamped->domain(), {}, 0};
  line.knots.assign(clamped->knots().begin(), clamped->knots().end());
  line.points.assign(clamped->points().begin(), clamped->points().end());
  line.weights.assign(clamped->weights().begin(), clamped->weights().end());
  SplineLine out = line;
  const double period = line.range.to - line.range.from;
  const auto order = static_cast<std::ptrdiff_t>(line.degree) + 1;
  out.knots.resize(line.knots.size() - 1);
  for (auto knot = line.knots.begin() + order; knot != line.knots.end(); ++knot) out.knots.push_back(*knot + period);
  out.points.insert(out.points.end(), line.points.begin() + 1, line.points.end());
  if (!line.weights.empty()) {
    const double scale = line.weights.back() / line.weights.front();
    for (std::size_t k = 1; k < line.weights.size(); ++k) out.weights.push_back(scale * line.weights[k]);
  }
  return curve_of(out, Interval{from, to});
}

/// Where points lie on a spline: at an end that is near enough, or else at the nearest point.
class SplineFeet {
 public:
  SplineFeet(const Curve& curve, double tolerance)
      : curve_(curve),
        at_(curve),
        tolerance_(tolerance),
        first_(at_.point(curve.domain().from)),
        last_(at_.point(curve.domain().to)) {}

  bool is_closed() const { return length(first_ - last_) <= tolerance_; }
  double start(const Vec3& p) { return near(p, first_) ? curve_.domain().from : foot(p); }
  double end(const Vec3& p) { return near(p, last_) ? curve_.domain().to : foot(p); }

 private:
  bool near(const Vec3& p, const Vec3& end) const { return length(p - end) <= tolerance_; }
  double foot(const Vec3& p) {
    if (parameters_.empty()) {
      parameters_ = sample_parameters(curve_, 2 + 2 * curve_.degree());
      for (const double t : parameters_) points_.push_back(at_.point(t));
    }
    const Interval d = curve_.domain();
    const double t = nearest_foot(at_, p, d, parameters_, points_), tiny = 1e-9 * (d.to - d.from);
    return t - d.from < tiny ? d.from : d.to - t < tiny ? d.to : t;
  }

  const Curve& curve_;
  FastCurve at_;
  double tolerance_;
  Vec3 first_, last_;
  std::vector<double> parameters_;
  std::vector<Vec3> points_;
};

}  // namespace

Result<StepEdgeCurve> StepCurves::edge_curve(std::uint64_t number, const std::array<Vec3, 2>& ends, bool agrees,
                                             double tolerance) const {
  StepEntity entity(index_, number);
  for (int depth = 0; depth <= max_depth && entity.status().ok(); ++depth) {
    const bool is_trimmed = entity.is("TRIMMED_CURVE");
    if (!is_trimmed && !is_step_wrapper(entity)) break;
    const std::uint64_t inner = inner_step_curve(entity);
    const bool is_along = !is_trimmed || entity.logical(entity.attribute(4));
    if (!entity.status().ok()) return entity.status();
    agrees = agrees == is_along;
    entity.read(inner);
  }
  if (!entity.status().ok()) return entity.status();
  const Result<StepEdgeCurve> made = edge_of(entity, ends, agrees, tolerance);
  if (made || made.status().message().starts_with('#')) return made;
  return entity.named(made.status());
}

Result<StepEdgeCurve> StepCurves::edge_of(StepEntity& entity, const std::array<Vec3, 2>& ends, bool agrees,
                                          double tolerance) const {
  if (entity.is("CIRCLE") || entity.is("ELLIPSE")) return round_edge(entity, ends, agrees, tolerance);
  if (entity.is("LINE") || entity.is("PARABOLA") || entity.is("HYPERBOLA")) return open_edge(entity, ends);
  if (entity.is("POLYLINE") || is_step_spline(entity, "CURVE")) return spline_edge(entity, ends, agrees, tolerance);
  return entity.error("is no curve that can be converted", StatusCode::unsupported);
}

/// Curves without ends, whose parameter grows along one direction: the points decide which way the edge runs.
Result<StepEdgeCurve> StepCurves::open_edge(StepEntity& entity, const std::array<Vec3, 2>& ends) const {
  const Result<double> a = inverted(entity, ends[0]), b = inverted(entity, ends[1]);
  if (!a) return a.status();
  if (!b) return b.status();
  const Interval range{std::min(*a, *b), std::max(*a, *b)};
  if (!(range.from < range.to)) return entity.error("its edge is a point: both vertices are at one place of it");
  const Result<SplineLine> line = entity.is("LINE") ? straight(entity, range) : conic(entity, range);
  if (!line) return line.status();
  Result<Curve> curve = curve_of(*line);
  if (!curve) return curve.status();
  return StepEdgeCurve{*std::move(curve), *b < *a};
}

Result<StepEdgeCurve> StepCurves::round_edge(StepEntity& entity, std::array<Vec3, 2> ends, bool agrees,
                                             double tolerance) const {
  if (!agrees) std::swap(ends[0], ends[1]);
  const Result<double> a = inverted(entity, ends[0]), b = inverted(entity, ends[1]);
  if (!a) return a.status();
  if (!b) return b.status();
  Interval range{*a, *b};
  const double rounding = 1e-12;
  if (range.to <= range.from + rounding) range.to += full_turn;
  if (length(ends[1] - ends[0]) <= 1e-3 * tolerance) range.to = range.from + full_turn;
  range.to = std::min(range.to, range.from + full_turn);
  const Result<SplineLine> line = conic(entity, range);
  if (!line) return line.status();
  Result<Curve> curve = curve_of(*line);
  if (!curve) return curve.status();
  return StepEdgeCurve{*std::move(curve), !agrees};
}

Result<StepEdgeCurve> StepCurves::spline_edge(StepEntity& entity, std::array<Vec3, 2> ends, bool agrees,
                                              double tolerance) const {
  const Result<SplineLine> line = spline(entity, {});
  if (!line) return line.status();
  const Result<Curve> whole = curve_of(*line);
  if (!whole) return whole.status();
  if (!agrees) std::swap(ends[0], ends[1]);
  const auto made = [](Result<Curve> curve, bool reversed) -> Result<StepEdgeCurve> {
    if (!curve) return curve.status();
    return StepEdgeCurve{*std::move(curve), reversed};
  };
  SplineFeet feet(*whole, tolerance);
  const Interval d = whole->domain();
  if (length(ends[1] - ends[0]) <= 1e-3 * tolerance && feet.is_closed()) {
    const double seam = feet.start(ends[0]);
    if (seam == d.from || seam == d.to) return made(*whole, !agrees);
    return made(across_ends(*whole, seam, seam + (d.to - d.from)), !agrees);
  }
  const double from = feet.start(ends[0]), to = feet.end(ends[1]);
  if (from < to) return made(curve_of(*line, Interval{from, to}), !agrees);
  if (feet.is_closed()) {
    if (from == to) return made(*whole, !agrees);
    return made(across_ends(*whole, from, to + (d.to - d.from)), !agrees);
  }
  if (from == to) return entity.error("its edge is a point: both vertices are at one place of it");
  return made(curve_of(*line, Interval{to, from}), agrees);  // the file errs about the direction
}

Result<Interval> StepCurves::profile_range(std::uint64_t number, const Frame* axis, const Vec3& direction,
                                           const Box3& extent) const {
  StepEntity entity(index_, number);
  for (int depth = 0; depth <= max_depth && is_step_wrapper(entity); ++depth) {
    const std::uint64_t inner = inner_step_curve(entity);
    if (!entity.status().ok()) return entity.status();
    entity.read(inner);
  }
  const bool is_line = entity.is("LINE");
  if (!is_line && !entity.is("PARABOLA") && !entity.is("HYPERBOLA")) return Interval{0, 0};
  if (extent.empty()) return entity.error("is unbounded, and so is the surface that it sweeps");
  // The turned or moved points lie in a ball about the middle, on the axis, or in a cylinder along the direction.
  Vec3 middle = extent.centre();
  double reach = extent.diagonal();
  if (axis) {
    const Vec3 local = axis->local(middle);
    middle = axis->at({0, 0, local.z});
    reach += std::hypot(local.x, local.y);
  }
  const Result<Vec3> along = growing_direction(entity);
  if (!along) return along.status();
  double slant = 1;
  if (!axis) slant = is_line ? length(*along - dot(*along, direction) * direction) : 1;
  if (!(slant > 1e-9)) return entity.error("runs along the direction in which it is swept");
  reach = 2 * reach / slant;
  const Result<double> from = inverted(entity, middle - reach * *along), to = inverted(entity, middle + reach * *along);
  if (!from) return from.status();
  if (!to) return to.status();
  return Interval{std::min(*from, *to), std::max(*from, *to)};
}

}}  // namespace tessera::abi_0_1
