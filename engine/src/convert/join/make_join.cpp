#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/text.h"
#include "convert/basis/bezier_net.h"
#include "convert/join/side_rows.h"
#include "tessera/bezier_operations.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns a row of control points along an edge, raised to `degree`; with weights if the patch is rational.
BezierPolygon row_of(const BezierPatch& patch, const SideView& view, int row, int degree) {
  BezierPolygon polygon;
  for (int k = 0; k <= view.along; ++k) {
    polygon.points.push_back(patch.points()[view.index(row, k)]);
    if (patch.is_rational()) polygon.weights.push_back(patch.weights()[view.index(row, k)]);
  }
  return elevated(polygon, degree);
}

/// Returns the row that continues from `before` through `border`: border + factor (border - before), homogeneous.
Result<BezierPolygon> continued(const BezierPolygon& before, const BezierPolygon& border, double factor) {
  BezierPolygon next = border;
  for (std::size_t k = 0; k < next.points.size(); ++k) {
    if (border.weights.empty()) {
      next.points[k] = border.points[k] + factor * (border.points[k] - before.points[k]);
      continue;
    }
    const double w = border.weights[k], v = before.weights[k], weight = w + factor * (w - v);
    if (!(weight > 0))
      return Status(StatusCode::invalid_weight,
                    "the join would need the weight " + text(weight) + " in its first row inside the patch, at " +
                        std::to_string(k) + " along the edge: k is too small",
                    static_cast<std::ptrdiff_t>(k));
    // (w P + factor (w P - v B)) / weight, relative to P.
    next.points[k] = border.points[k] + (factor * v / weight) * (border.points[k] - before.points[k]);
    next.weights[k] = weight;
  }
  return next;
}

Result<BezierPatch> joined(const JoinedPatch& p, const JoinedPatch& q, double k, bool reversed) {
  const SideView from = side_view(p.patch, p.side, false), to = side_view(q.patch, q.side, reversed);
  const int along = std::max(from.along, to.along);
  const double factor = (from.across * width_across(q)) / (k * to.across * width_across(p));
  const bool rational = p.patch.is_rational() || q.patch.is_rational();
  const BezierPolygon border = row_of(p.patch, from, 0, along);
  const Result<BezierPolygon> inside = continued(row_of(p.patch, from, 1, along), border, factor);
  if (!inside) return inside.status();

  const int m = crosses_u(q.side) ? to.across : along, n = crosses_u(q.side) ? along : to.across;
  const SideView target(m, n, q.side, reversed);
  std::vector<Vec3> points(static_cast<std::size_t>((m + 1) * (n + 1)));
  std::vector<double> weights(points.size());
  for (int depth = 0; depth <= to.across; ++depth) {
    const BezierPolygon row = depth == 0 ? border : depth == 1 ? *inside : row_of(q.patch, to, depth, along);
    for (int i = 0; i <= along; ++i) {
      const std::size_t at = static_cast<std::size_t>(i);
      points[target.index(depth, i)] = row.points[at];
      weights[target.index(depth, i)] = row.weights.empty() ? 1 : row.weights[at];
    }
  }
  return rational ? BezierPatch::rational(m, n, points, weights) : BezierPatch::polynomial(m, n, points);
}

}  // namespace

Result<BezierPatch> make_join(const JoinedPatch& p, const JoinedPatch& q, double k, bool reversed) {
  return guarded([&]() -> Result<BezierPatch> {
    if (Status status = check_joined(p, "p"); !status.ok()) return status;
    if (Status status = check_joined(q, "q"); !status.ok()) return status;
    if (!(k > 0) || !std::isfinite(k))
      return Status(std::isfinite(k) ? StatusCode::invalid_argument : StatusCode::non_finite,
                    "the factor k of a join is " + text(k) + ", it must be finite and greater than 0");
    return joined(p, q, k, reversed);
  });
}

}}  // namespace tessera::abi_0_1
