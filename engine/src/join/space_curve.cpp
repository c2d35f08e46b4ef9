#include "join/space_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "model/coedge_parameter.h"
#include "tessera/trim_region.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_sample_depth = 8;

std::size_t spans_of(const Curve& curve) { return curve.points().size() - static_cast<std::size_t>(curve.degree()); }

/// The derivative of the edge's parameter s by that of the loop's curve; 0 where it is infinite.
double slope_of(const Coedge& coedge, double s) {
  if (!coedge.parameter) return coedge.reversed ? -1 : 1;
  const double pace = evaluate_jet(*coedge.parameter, s).first.x;
  return pace == 0 ? 0 : 1 / pace;
}

/// About how many spans of a spline surface the curve runs through.
std::size_t spans_below(const Surface& surface, const Curve& curve) {
  const auto* const spline = std::get_if<BSplineSurface>(&surface);
  if (!spline) return 1;
  Box3 box;
  for (const Vec3& p : curve.points()) box.extend(p);
  const Domain& d = spline->domain();
  const double u = (box.upper.x - box.lower.x) / (d.u1 - d.u0), v = (box.upper.y - box.lower.y) / (d.v1 - d.v0);
  const auto spans = [](double share, std::size_t knots) { return std::min(share, 2.0) * static_cast<double>(knots); };
  return static_cast<std::size_t>(spans(u, spline->knots_u().size()) + spans(v, spline->knots_v().size()));
}

/// The curve's knots within its domain and both ends, with even steps between: at least 4, and about one per span of
/// what the curve lies on.
std::vector<double> first_parameters(const Curve& curve, std::size_t spans) {
  const Interval& d = curve.domain();
  std::vector<double> breaks{d.from};
  for (const double knot : curve.knots())
    if (knot > breaks.back() && knot < d.to) breaks.push_back(knot);
  breaks.push_back(d.to);
  const std::size_t steps = std::max<std::size_t>(1, std::max<std::size_t>(4, spans) / (breaks.size() - 1));
  std::vector<double> all;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
    for (std::size_t step = 0; step < steps; ++step) {
      const double x = static_cast<double>(step) / static_cast<double>(steps);
      all.push_back((1 - x) * breaks[k] + x * breaks[k + 1]);
    }
  all.push_back(d.to);
  return all;
}

}  // namespace

double nearest_fraction(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 along = b - a;
  const double square = dot(along, along);
  const double x = dot(p - a, along) / square;
  return x > 0 ? std::min(x, 1.0) : 0;  // NaN where squares overflow, or the segment is a point
}

Status in_face(const Shape& shape, std::size_t face, const Status& status) {
  const std::string& name = shape.faces[face].name;
  return Status(status.code(),
                "face " + std::to_string(face) + (name.empty() ? "" : " (" + name + ")") + ": " + status.message(),
                static_cast<std::ptrdiff_t>(face));
}

SpaceCurve::SpaceCurve(const Shape& shape, const EdgeUse& use, Line line, Status& failure)
    : shape_(&shape),
      face_(use.face),
      curve_(&edge_loops(shape.faces[use.face])[use.loop].curves[use.curve]),
      coedge_(&edge_loops(shape.faces[use.face])[use.loop].coedges[use.curve]),
      failure_(&failure) {
  const BrepEdge& edge = shape.edges[coedge_->edge];
  if (line == Line::stated && edge.curve) edge_ = &edge;
  const std::size_t spans = edge_ ? spans_of(*edge.curve) : spans_below(shape.faces[face_].surface, *curve_);
  const std::vector<double> first = first_parameters(*curve_, spans);
  samples_.push_back({first[0], at(first[0])});
  for (std::size_t k = 1; k < first.size(); ++k) {
    const Sample before = samples_.back();
    append(before, {first[k], at(first[k])}, 0);
  }
  for (const Sample& sample : samples_) extent_ = std::max(extent_, length(sample.point - samples_[0].point));
}

FacePoint SpaceCurve::evaluate(double t) const {
  if (!failure_->ok()) return {};
  if (edge_) {
    const double s = edge_parameter(*coedge_, *curve_, t);
    const CurveJet jet = evaluate_jet(*edge_->curve, s);
    if (is_finite(jet.position)) return {jet.position, slope_of(*coedge_, s) * jet.first};
    *failure_ = in_face(*shape_, face_, Status(StatusCode::non_finite, "the curve of an edge is not finite"));
    return {};
  }
  const Result<FacePoint> point = face_point(shape_->faces[face_], *curve_, t);
  if (point) return *point;
  *failure_ = in_face(*shape_, face_, point.status());
  return {};
}

bool SpaceCurve::has_strip(double t, const SpaceCurve& other, double s, double reach) const {
  const ModelSurface& face = shape_->faces[face_];
  const Result<Curve> across = Curve::bezier(std::array{position(*curve_, t), position(*other.curve_, s)});
  if (!across) return false;
  const Result<FacePoint> middle = face_point(face, *across, 0.5);
  if (!middle || !(length(middle->position - at(t)) <= reach)) return false;
  const Result<TrimRegion> kept = TrimRegion::make(edge_loops(shape_->faces[face_]), tessera::domain(face.surface));
  const Vec3 uv = position(*across, 0.5);
  return kept && kept->locate(uv.x, uv.y) == TrimSide::inside;
}

/// Appends the samples after `from` up to `to`.
void SpaceCurve::append(const Sample& from, const Sample& to, int depth) {
  const double middle_t = 0.5 * (from.t + to.t);
  const Sample middle{middle_t, at(middle_t)};
  const double chord = length(to.point - from.point);
  const double sagitta = length(middle.point - (0.5 * from.point + 0.5 * to.point));
  if (depth < max_sample_depth && sagitta > max_sagitta * chord) {
    append(from, middle, depth + 1);
    return append(middle, to, depth + 1);
  }
  if (sagitta > max_sagitta * max_sagitta * chord) samples_.push_back(middle);
  samples_.push_back(to);
}

SpaceCurve::Nearest SpaceCurve::nearest(const Vec3& p, const Interval& within) const {
  const auto after = [](double t, const Sample& sample) { return t < sample.t; };
  auto sample = std::upper_bound(samples_.begin(), samples_.end(), within.from, after);
  if (sample != samples_.begin()) --sample;
  double smallest = std::numeric_limits<double>::infinity(), t = within.from;
  for (; sample + 1 < samples_.end() && sample->t < within.to; ++sample) {
    const Vec3 &a = sample->point, &b = sample[1].point;
    const double x = nearest_fraction(a, b, p), distance = length((1 - x) * a + x * b - p);
    if (distance >= smallest) continue;
    smallest = distance;
    t = (1 - x) * sample->t + x * sample[1].t;
  }
  return nearest_from(p, t, within);
}

SpaceCurve::Nearest SpaceCurve::nearest_from(const Vec3& p, double t, const Interval& within) const {
  constexpr int max_steps = 12;
  constexpr double rounding = 0x1p-50;
  t = std::clamp(t, within.from, within.to);
  FacePoint at_t = evaluate(t);
  Nearest best{t, length(at_t.position - p)};
  for (int step = 0; step < max_steps; ++step) {
    const double square = dot(at_t.first, at_t.first);
    if (!(square > 0)) break;
    const double next = std::clamp(t - dot(at_t.position - p, at_t.first) / square, within.from, within.to);
    const double way = std::abs(next - t);
    if (!(way > rounding * (within.to - within.from))) break;
    t = next;
    at_t = evaluate(t);
    const double distance = length(at_t.position - p);
    if (!(distance <= best.distance) && step > 2) break;
    if (distance < best.distance) best = {t, distance};
  }
  return best;
}

}}  // namespace tessera::abi_0_1
