// How far faces are apart along their common edges.

#include <algorithm>

#include "model/coedge_parameter.h"
#include "model/face_points.h"
#include "tessera/guard.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The face's point at the edge's parameter s.
Result<Vec3> point_at(const Shape& shape, const EdgeUse& use, double s) {
  const ShapeFace& face = shape.faces[use.face];
  const TrimLoop& loop = edge_loops(face)[use.loop];
  const Curve& curve = loop.curves[use.curve];
  const Result<FacePoint> point = face_point(face, curve, curve_parameter(loop.coedges[use.curve], curve, s));
  if (!point) return point.status();
  return point->position;
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

}}  // namespace tessera::abi_0_1
