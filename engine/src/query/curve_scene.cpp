#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/infinity.h"
#include "base/text.h"
#include "kernel/table/kernel_table.h"
#include "parallel/parallel_for.h"
#include "query/curve_search.h"
#include "query/query_tree.h"
#include "ray/line/ray_line.h"
#include "ray/net/projected_net.h"
#include "ray/scene/exact_source.h"
#include "tessera/convert.h"
#include "tessera/guard.h"
#include "tessera/nearest_curves.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A Bezier piece of a curve.
struct CurveSpan {
  std::uint32_t curve;
  Interval range;  ///< in the curve's parameter
  std::vector<Vec3> points;
  std::vector<double> weights;  ///< empty if polynomial

  int degree() const { return static_cast<int>(points.size()) - 1; }
  double weight(std::size_t k) const { return weights.empty() ? 1 : weights[k]; }
};

/// A part [from, to] of a span, whose parameters run from 0 to 1.
struct CurvePart {
  std::uint32_t span;
  double from, to;
  VectorRange bend;  ///< the second derivative, in the scene's coordinates
};

/// Evaluates a span; the position is relative to a centre. CurvePoint::u is the parameter.
CurvePoint point_of(const CurveSpan& span, const Vec3& centre, double t) {
  const NetBasis<0> basis(span.degree(), t);
  Vec3 sum, slope;
  double w = 0, dw = 0;
  for (std::size_t k = 0; k < span.points.size(); ++k) {
    const Vec3 from = span.points[k] - centre;
    const double b = basis.value[k] * span.weight(k), d = basis.derivative[k] * span.weight(k);
    sum += b * from, slope += d * from, w += b, dw += d;
  }
  const Vec3 position = (1 / w) * sum;
  return {t, 0, position, (1 / w) * (slope - dw * position)};
}

/// Moves the parameter of a nearest point to the foot of a perpendicular near it, within the span: where it lies is
/// known from distances only to the root of their rounding. Newton's method, with second derivatives by differences.
double polished(const CurveSpan& span, const Vec3& centre, const Vec3& point, double t) {
  constexpr double step = 1e-4;
  constexpr int steps = 4;
  for (int k = 0; k < steps; ++k) {
    const CurvePoint at = point_of(span, centre, t);
    const double from = std::max(t - step, 0.0), to = std::min(t + step, 1.0);
    const Vec3 turn = point_of(span, centre, to).derivative - point_of(span, centre, from).derivative;
    const Vec3 r = at.position - point;
    const double slope = dot(at.derivative, at.derivative) + dot(r, turn) / (to - from);
    const double next = t - dot(r, at.derivative) / slope;
    if (!(slope > 0 && next >= 0 && next <= 1 && std::abs(next - t) <= step)) break;
    t = next;
  }
  return t;
}

/// Bounds the second derivative over a part, for points relative to its middle, which keeps differences small.
VectorRange bend_of(const CurveSpan& span, const SceneFrame& frame, double from, double to) {
  constexpr std::size_t most = max_degree + 1;
  std::array<std::array<double, most>, 4> lines;
  const Vec3 middle = frame.centre + point_of(span, frame.centre, 0.5 * (from + to)).position;
  const std::size_t count = span.points.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 p = (frame.scale * span.weight(k)) * (span.points[k] - middle);
    lines[0][k] = p.x, lines[1][k] = p.y, lines[2][k] = p.z, lines[3][k] = span.weight(k);
  }
  for (std::array<double, most>& line : lines) restrict_line(span.degree(), line.data(), 1, from, to);
  VectorRange out;
  Range* const bends[] = {&out.x, &out.y, &out.z};
  for (std::size_t c = 0; c < 3; ++c) {
    Range value, slope;
    bound_coordinate({lines[c].data(), count}, {lines[3].data(), count}, value, slope, *bends[c]);
  }
  const double share = 1 / ((to - from) * (to - from));
  return share * out;
}

}  // namespace

class CurveScene::Impl {
 public:
  Status build(std::span<const Curve> curves, const Execution& execution);
  NearestCurvePoint nearest(const Vec3& point, double max_distance) const;
  std::size_t memory_bytes() const;

 private:
  /// The search of one point.
  struct Search {
    const Impl& scene;
    Vec3 point;  ///< relative to the frame's centre
    double slack, limit, reach_of_best;
    Foot best{};
    std::uint32_t part = no_id;
    int work = 0;
    bool complete = true, ambiguous = false;
    std::vector<std::pair<std::uint32_t, double>> deferred;  ///< parts that are not decided, and how far they are

    static constexpr int most_work = 4000;
    double reach() const { return reach_of_best; }
    bool visit(std::uint32_t item, double distance);
    void finish();
    bool search(std::uint32_t item, int limit_of_work);
    void take(const Foot& foot, std::uint32_t item);
  };

  Status take_spans(std::span<const Curve> curves);
  void cut(std::uint32_t span, std::vector<ItemBoxes>& boxes);

  const kernel::NearestKernels* kernels_ = nullptr;
  SceneFrame frame_;
  std::vector<CurveSpan> spans_;
  std::vector<CurvePart> parts_;
  QueryTree tree_;
  double rounding_ = 0;  ///< of a point, in the scene's coordinates
};

Status CurveScene::Impl::take_spans(std::span<const Curve> curves) {
  for (std::size_t index = 0; index < curves.size(); ++index) {
    const Result<BezierPieces> pieces = to_bezier(curves[index]);
    if (!pieces) return pieces.status();
    const auto degree = static_cast<std::size_t>(pieces->degree);
    for (std::size_t k = 0; k + 1 < pieces->breaks.size(); ++k) {
      CurveSpan span{.curve = static_cast<std::uint32_t>(index),
                     .range = {pieces->breaks[k], pieces->breaks[k + 1]},
                     .points = {},
                     .weights = {}};
      const auto run = [&](const auto& of) {
        const auto first = of.begin() + static_cast<std::ptrdiff_t>(k * degree);
        return std::pair(first, first + static_cast<std::ptrdiff_t>(degree + 1));
      };
      const auto [begin, end] = run(pieces->points);
      span.points.assign(begin, end);
      if (!pieces->weights.empty()) {
        const auto [first, last] = run(pieces->weights);
        span.weights.assign(first, last);
        const double largest = *std::ranges::max_element(span.weights);
        for (double& weight : span.weights) weight /= largest;
      }
      spans_.push_back(std::move(span));
    }
  }
  return {};
}

/// Cuts a span by halves until each part is nearly straight.
void CurveScene::Impl::cut(std::uint32_t span, std::vector<ItemBoxes>& boxes) {
  constexpr double most_sag = 0.06;  // share of the chord
  constexpr int most_halvings = 10;
  struct Left {
    double from, to;
    int halvings;
  };
  std::vector<Left> left{{0, 1, 0}};
  while (!left.empty()) {
    const auto [from, to, halvings] = left.back();
    left.pop_back();
    const CurvePart part{span, from, to, bend_of(spans_[span], frame_, from, to)};
    const auto place = [&](double t) { return frame_.scale * point_of(spans_[span], frame_.centre, t).position; };
    const Vec3 a = place(from), b = place(to);
    const double sag = 0.125 * part.bend.magnitude() * (to - from) * (to - from);
    if (sag > most_sag * length(b - a) && sag > 1e-9 && halvings < most_halvings) {
      const double middle = 0.5 * (from + to);
      left.push_back({middle, to, halvings + 1}), left.push_back({from, middle, halvings + 1});
      continue;
    }
    parts_.push_back(part);
    boxes.push_back(chord_boxes(a, b, sag));
  }
}

Status CurveScene::Impl::build(std::span<const Curve> curves, const Execution& execution) {
  if (curves.empty()) return {StatusCode::invalid_argument, "a curve scene needs at least one curve"};
  const Result<Isa> isa = usable_isa({});
  if (!isa) return isa.status();
  kernels_ = &ray_kernels(*isa).nearest;
  if (Status status = take_spans(curves); !status.ok()) return status;
  Box3 box;
  for (const CurveSpan& span : spans_)
    for (const Vec3& p : span.points) box.extend(p);
  if (!(box.diagonal() >= smallest_exact && box.diagonal() <= largest_exact))
    return {StatusCode::unsupported, "a curve scene holds curves of a size from 1e-140 to 1e140: scale the curves"};
  frame_ = SceneFrame::around(box);
  std::vector<ItemBoxes> boxes;
  for (std::uint32_t k = 0; k < spans_.size(); ++k) {
    if (execution.cancel && execution.cancel->load(std::memory_order_relaxed))
      return {StatusCode::cancelled, "cancelled by the caller"};
    cut(k, boxes);
    rounding_ = std::max(rounding_, net_rounding(spans_[k].degree(), 0));
  }
  tree_.build(boxes);
  return {};
}

/// Where a curve is as far away all along, as an arc from its middle, no search ends before its limit. Each part gets a
/// little work until all were looked at.
bool CurveScene::Impl::Search::visit(std::uint32_t item, double distance) {
  constexpr int first_work = 48;
  if (!search(item, first_work)) deferred.emplace_back(item, distance);
  complete = work < most_work;
  return complete;
}

void CurveScene::Impl::Search::finish() {
  for (const auto& [item, distance] : deferred)
    if (distance <= reach_of_best && !search(item, most_work)) complete = false;
}

/// Searches a part with a limit of work. Returns whether that sufficed.
bool CurveScene::Impl::Search::search(std::uint32_t item, int limit_of_work) {
  const CurvePart& curve = scene.parts_[item];
  const CurveSpan& span = scene.spans_[curve.span];
  const auto at = [&](double t) { return point_of(span, scene.frame_.centre, t); };
  const double scale = scene.frame_.scale;
  const Foot foot = CurveSearch(at, (1 / scale) * curve.bend, scale, point, limit + slack)
                        .run(curve.from, curve.to, std::min(most_work, work + limit_of_work), work);
  if (!foot.is_farther) take(foot, item);
  return foot.converged;
}

/// Takes a foot that is nearer than the best one, or as near and earlier.
void CurveScene::Impl::Search::take(const Foot& foot, std::uint32_t item) {
  constexpr double min_apart = 1e-6;  // in the scene's coordinates
  const auto order = [&](const Foot& of, std::uint32_t part_of) {
    return std::tuple(of.distance, scene.spans_[scene.parts_[part_of].span].curve, part_of);
  };
  const bool has_other = part != no_id && std::abs(foot.distance - best.distance) <= slack &&
                         length(foot.position - best.position) * scene.frame_.scale > min_apart;
  const bool is_clearly_nearer = part == no_id || foot.distance < best.distance - slack;
  ambiguous = has_other || (ambiguous && !is_clearly_nearer);
  if (part != no_id && !(order(foot, item) < order(best, part))) return;
  best = foot, part = item;
  limit = foot.distance;
  reach_of_best = (limit + slack) * scene.frame_.scale;
}

NearestCurvePoint CurveScene::Impl::nearest(const Vec3& point, double max_distance) const {
  constexpr double max_coordinate = 1e140;
  NearestCurvePoint out;
  const Vec3 at = frame_.to_scene(point);
  if (!is_finite(at) || max_abs(at) > max_coordinate) {
    out.kind = NearestKind::invalid_point;
    return out;
  }
  const double slack = (2 * rounding_ + 0x1p-50 * length(at)) / frame_.scale;
  Search search{*this,
                point - frame_.centre,
                slack,
                max_distance,
                (max_distance + slack) * frame_.scale,
                {},
                no_id,
                0,
                true,
                false,
                {}};
  QueryTree::Path path;
  tree_.begin(*kernels_, at, path);
  tree_.visit_near(path, search);
  search.finish();
  out.flags.certified = search.complete;
  out.rounding = slack;
  if (search.part == no_id) return out;
  const CurveSpan& span = spans_[parts_[search.part].span];
  double t = search.best.u;
  CurvePoint there = point_of(span, frame_.centre, t);
  const double moved = polished(span, frame_.centre, search.point, t);
  const CurvePoint foot = point_of(span, frame_.centre, moved);
  if (length(foot.position - search.point) <= length(there.position - search.point) + slack) t = moved, there = foot;
  const Vec3 from = there.position - search.point;
  out.kind = NearestKind::found, out.curve = span.curve;
  out.t = std::clamp(span.range.from + t * (span.range.to - span.range.from), span.range.from, span.range.to);
  out.position = frame_.centre + there.position, out.distance = length(from);
  out.flags.ambiguous = search.ambiguous;
  const double aside = 1e-12 * length(from) + 4 * slack;
  out.flags.border = (t <= 0 || t >= 1) && std::abs(dot(from, there.derivative)) > aside * length(there.derivative);
  return out;
}

std::size_t CurveScene::Impl::memory_bytes() const {
  std::size_t bytes = parts_.capacity() * sizeof(CurvePart) + spans_.capacity() * sizeof(CurveSpan);
  for (const CurveSpan& span : spans_)
    bytes += span.points.capacity() * sizeof(Vec3) + span.weights.capacity() * sizeof(double);
  return bytes + tree_.memory_bytes();
}

CurveScene::CurveScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CurveScene::CurveScene(CurveScene&&) noexcept = default;
CurveScene& CurveScene::operator=(CurveScene&&) noexcept = default;
CurveScene::~CurveScene() = default;

Result<CurveScene> CurveScene::make(std::span<const Curve> curves, const Execution& execution) {
  return guarded([&]() -> Result<CurveScene> {
    auto impl = std::make_unique<Impl>();
    if (Status status = impl->build(curves, execution); !status.ok()) return status;
    return CurveScene(std::move(impl));
  });
}

Status CurveScene::nearest(std::span<const Vec3> points, std::span<NearestCurvePoint> nearest, double max_distance,
                           const Execution& execution) const {
  constexpr std::size_t points_per_task = 256;
  return guarded([&]() -> Status {
    if (nearest.size() < points.size())
      return {StatusCode::buffer_too_small,
              counted(points.size(), "point") + ", but room for " + counted(nearest.size(), "result")};
    if (!(max_distance >= 0))
      return {StatusCode::invalid_argument, "the largest distance must be at least 0, found " + text(max_distance)};
    return parallel_for(points.size(), points_per_task, execution, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) nearest[k] = impl_->nearest(points[k], max_distance);
    });
  });
}

NearestCurvePoint CurveScene::nearest(const Vec3& point, double max_distance) const {
  NearestCurvePoint out;
  if (!nearest({&point, 1}, {&out, 1}, max_distance).ok()) out.kind = NearestKind::invalid_point;
  return out;
}

std::size_t CurveScene::memory_bytes() const { return impl_->memory_bytes(); }

}}  // namespace tessera::abi_0_1
