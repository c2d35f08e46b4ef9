// Curves of a STEP file, by kind.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "io/step/step_curves.h"
#include "io/step/step_splines.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A range that is usable: finite, not empty.
Status check_range(const StepEntity& entity, const Interval& range) {
  if (range.from < range.to && std::isfinite(range.to - range.from)) return {};
  return entity.error(
      "an interval of its parameter must not be empty: from " + text(range.from) + " to " + text(range.to),
      StatusCode::invalid_argument);
}

/// The line backwards, over the negated parameter.
SplineLine reversed(SplineLine line) {
  std::ranges::reverse(line.points);
  std::ranges::reverse(line.weights);
  std::ranges::reverse(line.knots);
  for (double& knot : line.knots) knot = -knot;
  line.range = {-line.range.to, -line.range.from};
  if (line.arcs) line.arcs = Arcs(line.range.from, line.range.to);
  return line;
}

Status unsupported_curve(const StepEntity& entity) {
  return entity.error("is no curve that can be converted", StatusCode::unsupported);
}

}  // namespace

bool is_step_wrapper(const StepEntity& entity) {
  return entity.is("SURFACE_CURVE") || entity.is("SEAM_CURVE") || entity.is("INTERSECTION_CURVE");
}

std::uint64_t inner_step_curve(StepEntity& entity) {
  const bool is_part = entity.has_parts() && is_step_wrapper(entity);  // (BOUNDED_CURVE() .. SURFACE_CURVE(#1, ..))
  return entity.reference(is_part ? entity.attribute(entity.part("SURFACE_CURVE"), 0) : entity.attribute(1));
}

Result<StepCurve> StepCurves::curve(std::uint64_t number, const std::optional<Interval>& range) const {
  const Result<SplineLine> made = line(number, range, 0);
  if (!made) return made.status();
  Result<Curve> curve = curve_of(*made);
  if (!curve) return StepEntity(index_, number).named(curve.status());
  return StepCurve{*std::move(curve), made->arcs};
}

Result<SplineLine> StepCurves::line(std::uint64_t number, const Range& range, int depth) const {
  StepEntity entity(index_, number);
  if (depth > max_depth) entity.fail("is made of too many curves, or of itself");
  if (!entity.status().ok()) return entity.status();
  if (range)
    if (Status status = check_range(entity, *range); !status.ok()) return status;
  if (entity.is("LINE")) return straight(entity, range);
  if (entity.is("CIRCLE") || entity.is("ELLIPSE") || entity.is("PARABOLA") || entity.is("HYPERBOLA"))
    return conic(entity, range);
  if (entity.is("POLYLINE") || is_step_spline(entity, "CURVE")) return spline(entity, range);
  if (entity.is("TRIMMED_CURVE")) return trimmed(entity, range, depth);
  if (!is_step_wrapper(entity)) return unsupported_curve(entity);
  const std::uint64_t inner = inner_step_curve(entity);
  if (!entity.status().ok()) return entity.status();
  return line(inner, range, depth + 1);
}

Result<SplineLine> StepCurves::straight(StepEntity& entity, const Range& range) const {
  const std::uint64_t at = entity.reference(entity.attribute(1)), along = entity.reference(entity.attribute(2));
  if (!entity.status().ok()) return entity.status();
  if (!range) return entity.error("needs an interval of its parameter", StatusCode::invalid_argument);
  const Result<Vec3> start = point(at);
  if (!start) return start.status();
  const Result<Vec3> by = vector(along);
  if (!by) return by.status();
  const Vec3 unit = normalized(*by);
  return straight_line(*start + range->from * unit, *start + range->to * unit, *range);
}

Result<SplineLine> StepCurves::conic(StepEntity& entity, const Range& given) const {
  const std::uint64_t position = entity.reference(entity.attribute(1));
  const bool is_parabola = entity.is("PARABOLA"), is_hyperbola = entity.is("HYPERBOLA"),
             is_open = is_parabola || is_hyperbola;
  const bool has_second = is_hyperbola || entity.is("ELLIPSE");
  const double first = units_.length * entity.positive(entity.attribute(2), is_parabola ? "focal distance" : "radius");
  const double second = has_second ? units_.length * entity.positive(entity.attribute(3), "radius") : first;
  if (!entity.status().ok()) return entity.status();
  if (is_open && !given) return entity.error("needs an interval of its parameter", StatusCode::invalid_argument);
  const Interval range = given.value_or(Interval{0, full_turn});
  const bool is_too_long = range.to - range.from > full_turn * (1 + 1e-12);
  if (!is_open && (is_too_long || std::abs(range.from) > max_angle))
    return entity.error("an interval of angles must not be longer than a full turn", StatusCode::invalid_argument);
  constexpr double max_hyperbolic_angle = 50;
  if (is_hyperbola && std::max(-range.from, range.to) > max_hyperbolic_angle)
    return entity.error("an interval of its parameter goes too far", StatusCode::invalid_argument);
  const Result<Frame> frame = placement(position);
  if (!frame) return frame.status();
  if (is_parabola) return parabola_arc(frame->origin, frame->x, frame->y, first, range);
  if (is_hyperbola) return hyperbola_arcs(frame->origin, first * frame->x, second * frame->y, range);
  return ellipse_arcs(frame->origin, first * frame->x, second * frame->y, range);
}

Result<SplineLine> StepCurves::spline(StepEntity& entity, const Range& range) const {
  SplineLine out;
  const bool is_polyline = entity.is("POLYLINE");
  const SplineAttributes place = spline_attributes(entity, "CURVE");
  if (!is_polyline) out.degree = entity.integer(entity.attribute(place.spline, place.spline_at));
  Result<std::vector<Vec3>> poles =
      points(entity, is_polyline ? entity.attribute(1) : entity.attribute(place.spline, place.spline_at + 1));
  if (!poles) return poles.status();
  out.points = *std::move(poles);
  if (!check_degree(entity, out.degree, out.points.size())) return entity.status();
  out.knots =
      is_polyline ? uniform_knots(out.points.size()) : step_knots(entity, "CURVE", out.degree, out.points.size(), 0);
  if (entity.is("RATIONAL_B_SPLINE_CURVE")) {
    out.weights = entity.reals(entity.attribute(entity.part("RATIONAL_B_SPLINE_CURVE"), 0));
    if (out.weights.size() != out.points.size())
      entity.fail("has " + counted(out.weights.size(), "weight") + " for " + counted(out.points.size(), "point"));
  }
  if (!entity.status().ok()) return entity.status();
  const Interval all{out.knots[static_cast<std::size_t>(out.degree)], out.knots[out.points.size()]};
  out.range = range ? covered(out.knots, out.degree, *range) : all;
  if (Status status = check_range(entity, out.range); !status.ok()) return status;
  return out;
}

Result<double> StepCurves::curve_scale(std::uint64_t number, int depth) const {
  StepEntity entity(index_, number);
  if (depth > max_depth) entity.fail("is made of too many curves, or of itself");
  if (!entity.status().ok()) return entity.status();
  if (entity.is("CIRCLE") || entity.is("ELLIPSE")) return units_.angle;
  if (entity.is("PARABOLA")) {
    const double focal = entity.positive(entity.attribute(2), "focal distance");
    if (!entity.status().ok()) return entity.status();
    return 2 * focal * units_.length;
  }
  const bool is_line = entity.is("LINE");
  if (!is_line && !is_step_wrapper(entity) && !entity.is("TRIMMED_CURVE")) return 1.0;
  const std::uint64_t inner = is_line ? entity.reference(entity.attribute(2)) : inner_step_curve(entity);
  if (!entity.status().ok()) return entity.status();
  if (!is_line) return curve_scale(inner, depth + 1);
  const Result<Vec3> along = vector(inner);
  if (!along) return along.status();
  return length(*along);
}

/// Returns the parameter of a point of a line or a conic that is nearest to `p`, or almost so.
Result<double> StepCurves::inverted(StepEntity& basis, const Vec3& p) const {
  const std::uint64_t at = basis.reference(basis.attribute(1));
  if (basis.is("LINE")) {
    const std::uint64_t along = basis.reference(basis.attribute(2));
    if (!basis.status().ok()) return basis.status();
    const Result<Vec3> start = point(at);
    if (!start) return start.status();
    const Result<Vec3> by = vector(along);
    if (!by) return by.status();
    return dot(p - *start, normalized(*by));
  }
  const bool is_parabola = basis.is("PARABOLA"), is_hyperbola = basis.is("HYPERBOLA");
  if (!is_parabola && !is_hyperbola && !basis.is("CIRCLE") && !basis.is("ELLIPSE"))
    return basis.error("is trimmed by points, which is only possible on lines and conics", StatusCode::unsupported);
  const double first = units_.length * basis.positive(basis.attribute(2), "radius");
  const bool has_second = is_hyperbola || basis.is("ELLIPSE");
  const double second = has_second ? units_.length * basis.positive(basis.attribute(3), "radius") : first;
  if (!basis.status().ok()) return basis.status();
  const Result<Frame> frame = placement(at);
  if (!frame) return frame.status();
  const Vec3 local = frame->local(p);
  if (is_parabola) return local.y;
  if (is_hyperbola) return std::asinh(local.y / second);
  return std::atan2(local.y / second, local.x / first);
}

/// Returns the direction along which the parameter of a line, a parabola or a hyperbola grows.
Result<Vec3> StepCurves::growing_direction(StepEntity& curve) const {
  const bool is_line = curve.is("LINE");
  const std::uint64_t from = curve.reference(curve.attribute(is_line ? 2 : 1));
  if (!curve.status().ok()) return curve.status();
  if (is_line) {
    const Result<Vec3> by = vector(from);
    if (!by) return by.status();
    return normalized(*by);
  }
  const Result<Frame> frame = placement(from);
  if (!frame) return frame.status();
  return frame->y;
}

/// Returns one end of a trimmed curve as our parameter of its basis. The k-th attribute lists a point, a parameter or
/// both; the point counts if the file prefers it and it can be used.
Result<double> StepCurves::trim(StepEntity& entity, std::size_t k, std::uint64_t basis, double scale) const {
  std::optional<double> value;
  std::optional<std::uint64_t> at;
  for (const std::size_t select : entity.list(entity.attribute(k))) {
    if (entity.kind_of(select) == StepKind::reference)
      at = entity.reference(select);
    else
      value = entity.real(select) * scale;
  }
  const bool prefers_point = entity.enumeration(entity.attribute(5)) == "CARTESIAN";
  if (!value && !at) entity.fail("a trim with neither a parameter nor a point");
  if (!entity.status().ok()) return entity.status();
  if (at && (prefers_point || !value)) {
    StepEntity on(index_, basis);
    const Result<Vec3> p = point(*at);
    if (!p) return p.status();
    const Result<double> found = inverted(on, *p);
    if (found || !value) return found;
  }
  return *value;
}

Result<SplineLine> StepCurves::trimmed(StepEntity& entity, const Range& range, int depth) const {
  const std::uint64_t basis = entity.reference(entity.attribute(1));
  const bool agrees = entity.logical(entity.attribute(4));
  if (!entity.status().ok()) return entity.status();
  const auto turned = [&](const Interval& r) { return agrees ? r : Interval{-r.to, -r.from}; };
  Range part;
  if (range) {
    part = turned(*range);
  } else {
    const Result<double> scale = curve_scale(basis, depth + 1);
    if (!scale) return scale.status();
    const Result<double> first = trim(entity, 2, basis, *scale), second = trim(entity, 3, basis, *scale);
    if (!first) return first.status();
    if (!second) return second.status();
    part = agrees ? Interval{*first, *second} : Interval{*second, *first};
    const StepEntity of(index_, basis);
    // The arc that begins at its first angle may pass the place where angles begin again.
    const bool is_round = of.is("CIRCLE") || of.is("ELLIPSE");
    if (is_round && std::abs(part->from) <= max_angle && std::abs(part->to) <= max_angle) {
      while (part->to <= part->from + 1e-12) part->to += full_turn;
      while (part->to > part->from + full_turn * (1 + 1e-12)) part->to -= full_turn;
    }
    if (Status status = check_range(entity, *part); !status.ok()) return status;
  }
  Result<SplineLine> made = line(basis, part, depth + 1);
  if (!made || agrees) return made;
  return reversed(*std::move(made));
}

}}  // namespace tessera::abi_0_1
