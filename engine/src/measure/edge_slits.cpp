#include "measure/edge_slits.h"

#include <algorithm>
#include <array>

#include "model/coedge_parameter.h"
#include "model/face_points.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t samples = 17;
using Points = std::array<Vec3, samples>;

Status sample(const Shape& shape, std::size_t edge, const EdgeUse& use, Points& points) {
  const ShapeFace& face = shape.faces[use.face];
  const TrimLoop& loop = edge_loops(face)[use.loop];
  const Curve& curve = loop.curves[use.curve];
  const Interval& range = shape.edges[edge].range;
  for (std::size_t k = 0; k < samples; ++k) {
    const double x = static_cast<double>(k) / (samples - 1), s = (1 - x) * range.from + x * range.to;
    const Result<FacePoint> point = face_point(face, curve, curve_parameter(loop.coedges[use.curve], curve, s));
    if (!point) return point.status();
    points[k] = point->position;
  }
  return {};
}

Status measure(const Shape& shape, std::size_t edge, std::span<const EdgeUse> uses, EdgeSlit& slit) {
  if (uses.empty()) return {};
  Points first;
  if (Status status = sample(shape, edge, uses[0], first); !status.ok()) return status;
  for (std::size_t k = 0; k < samples; ++k) {
    slit.box.extend(first[k]);
    if (k > 0) slit.length += length(first[k] - first[k - 1]);
  }
  slit.length *= 1.25;  // chords are shorter than the curve
  Points other;
  for (const EdgeUse& use : uses.subspan(1)) {
    if (Status status = sample(shape, edge, use, other); !status.ok()) return status;
    for (std::size_t k = 0; k < samples; ++k) slit.width = std::max(slit.width, length(first[k] - other[k]));
  }
  return {};
}

}  // namespace

Result<std::vector<EdgeSlit>> edge_slits(const Shape& shape, const EdgeUses& uses, const Execution& execution) {
  std::vector<EdgeSlit> slits(shape.edges.size());
  std::vector<Status> found(shape.edges.size());
  Status status = parallel_for(slits.size(), 16, execution, [&](std::size_t begin, std::size_t end) {
    for (std::size_t edge = begin; edge < end; ++edge) found[edge] = measure(shape, edge, uses[edge], slits[edge]);
  });
  if (!status.ok()) return status;
  for (const Status& of : found)
    if (!of.ok()) return of;
  return slits;
}

}}  // namespace tessera::abi_0_1
