// How far faces are apart along their common edges.

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "block/coedge_parameter.h"
#include "tessera/guard.h"
#include "tessera/topology.h"

namespace tessera::inline abi_0_1 {
namespace {

/// The parameter within [from, to] that is whole periods away.
double wrapped(double value, double from, double to) {
  const double period = to - from, turns = std::floor((value - from) / period);
  return std::clamp(value - turns * period, from, to);
}

/// The place of a loop's point in the face's domain. Loops may cross the seam of a closed surface, where the domain ends.
Result<Vec3> in_domain(const ModelSurface& face, Vec3 uv) {
  const Domain d = domain(face.surface);
  const auto closed = [&](const Vec3& a, const Vec3& middle, const Vec3& b) -> Result<bool> {
    const Result<SurfaceJet> at_a = evaluate_jet(face, a.x, a.y), at_middle = evaluate_jet(face, middle.x, middle.y),
                             at_b = evaluate_jet(face, b.x, b.y);
    for (const auto* const jet : {&at_a, &at_middle, &at_b})
      if (!*jet) return jet->status();
    return length(at_a->position - at_b->position) <= 1e-6 * length(at_a->position - at_middle->position);
  };
  const double far_u = 1e-9 * (d.u1 - d.u0), far_v = 1e-9 * (d.v1 - d.v0);
  if (uv.x < d.u0 - far_u || uv.x > d.u1 + far_u) {
    const double v = std::clamp(uv.y, d.v0, d.v1);
    const Result<bool> around = closed({d.u0, v, 0}, {d.u_at(0.5), v, 0}, {d.u1, v, 0});
    if (!around) return around.status();
    if (*around) uv.x = wrapped(uv.x, d.u0, d.u1);
  }
  if (uv.y < d.v0 - far_v || uv.y > d.v1 + far_v) {
    const double u = std::clamp(uv.x, d.u0, d.u1);
    const Result<bool> around = closed({u, d.v0, 0}, {u, d.v_at(0.5), 0}, {u, d.v1, 0});
    if (!around) return around.status();
    if (*around) uv.y = wrapped(uv.y, d.v0, d.v1);
  }
  return uv;
}

/// The face's point at the edge's parameter s.
Result<Vec3> point_at(const Shape& shape, const EdgeUse& use, double s) {
  const ShapeFace& face = shape.faces[use.face];
  const TrimLoop& loop = edge_loops(face)[use.loop];
  const Curve& curve = loop.curves[use.curve];
  const Result<Vec3> uv = in_domain(face, position(curve, curve_parameter(loop.coedges[use.curve], curve, s)));
  if (!uv) return uv.status();
  const Result<SurfaceJet> jet = evaluate_jet(face, uv->x, uv->y);
  if (!jet) return jet.status();
  return jet->position;
}

/// The largest distance of two of the points.
double spread(std::span<const Vec3> points) {
  double largest = 0;
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) largest = std::max(largest, length(points[a] - points[b]));
  return largest;
}

}  // namespace

Result<std::vector<double>> edge_gaps(const Shape& shape, int samples) {
  return guarded([&]() -> Result<std::vector<double>> {
    if (samples < 2)
      return Status(StatusCode::invalid_argument, "there must be at least 2 samples, not " + std::to_string(samples));
    const Result<EdgeUses> uses = edge_uses(shape);
    if (!uses) return uses.status();
    std::vector<double> gaps(shape.edges.size(), 0.0);
    std::vector<Vec3> points;
    for (std::size_t edge = 0; edge < gaps.size(); ++edge) {
      if ((*uses)[edge].size() < 2) continue;
      const Interval& range = shape.edges[edge].range;
      for (int k = 0; k < samples; ++k) {
        const double x = static_cast<double>(k) / (samples - 1), s = (1 - x) * range.from + x * range.to;
        points.clear();
        for (const EdgeUse& use : (*uses)[edge]) {
          const Result<Vec3> point = point_at(shape, use, s);
          if (!point) return point.status();
          points.push_back(*point);
        }
        gaps[edge] = std::max(gaps[edge], spread(points));
      }
    }
    return gaps;
  });
}

}  // namespace tessera::inline abi_0_1
