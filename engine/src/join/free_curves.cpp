#include "join/free_curves.h"

#include <algorithm>
#include <array>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A curve that stays within this share of the distance is a point.
constexpr double point_share = 1.0 / 16;

std::uint32_t size_of(const auto& list) { return static_cast<std::uint32_t>(list.size()); }

Result<TrimLoop> outline_of(const Domain& d) {
  const std::array<Vec3, 4> corners{{{d.u0, d.v0, 0}, {d.u1, d.v0, 0}, {d.u1, d.v1, 0}, {d.u0, d.v1, 0}}};
  TrimLoop loop;
  for (std::size_t k = 0; k < 4; ++k) {
    const Result<Curve> side = Curve::bezier(std::array{corners[k], corners[(k + 1) % 4]});
    if (!side) return side.status();
    loop.curves.push_back(*side);
  }
  return loop;
}

/// Names the edges of one loop after the other.
class EdgeNamer {
 public:
  EdgeNamer(Shape& shape, double distance) : shape_(shape), distance_(distance) {}

  Status name(const ModelSurface& face, TrimLoop& loop) {
    std::vector<Vec3> starts, ends;
    for (const Curve& curve : loop.curves) {
      const Result<FacePoint> start = face_point(face, curve, curve.domain().from);
      if (!start) return start.status();
      const Result<FacePoint> end = face_point(face, curve, curve.domain().to);
      if (!end) return end.status();
      starts.push_back(start->position);
      ends.push_back(end->position);
    }
    const std::size_t count = loop.curves.size();
    const std::uint32_t first_edge = size_of(shape_.edges);
    for (std::size_t k = 0; k < count; ++k) {
      loop.coedges.push_back({size_of(shape_.edges)});
      BrepEdge& edge = shape_.edges.emplace_back();
      edge.range = loop.curves[k].domain();
      edge.start = add_vertex(starts[k]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t next = (k + 1) % count;
      shape_.edges[first_edge + k].end =
          length(ends[k] - starts[next]) <= distance_ ? shape_.edges[first_edge + next].start : add_vertex(ends[k]);
    }
    return {};
  }

 private:
  std::uint32_t add_vertex(const Vec3& at) {
    shape_.vertices.push_back({at});
    return size_of(shape_.vertices) - 1;
  }

  Shape& shape_;
  double distance_;
};

}  // namespace

Status name_all_edges(Shape& shape, double distance) {
  EdgeNamer namer(shape, distance);
  for (std::size_t k = 0; k < shape.faces.size(); ++k) {
    ShapeFace& face = shape.faces[k];
    std::vector<TrimLoop> loops = edge_loops(face);
    if (loops.empty()) {
      Result<TrimLoop> outline = outline_of(domain(face.surface));
      if (!outline) return in_face(shape, k, outline.status());
      loops.push_back(*std::move(outline));
    }
    bool named = false;
    for (TrimLoop& loop : loops) {
      if (!loop.coedges.empty() || loop.curves.empty()) continue;
      if (Status status = namer.name(face, loop); !status.ok()) return in_face(shape, k, status);
      named = true;
    }
    if (named) (face.trims->empty() ? face.outline : face.trims) = std::move(loops);
  }
  return {};
}

Result<FreeCurves> find_free_curves(Shape& shape, double distance, Line line, Status& failure) {
  const Result<EdgeUses> uses = edge_uses(shape);
  if (!uses) return uses.status();
  FreeCurves out{distance, line, {}, {}, {}};
  for (std::uint32_t k = 0; k < shape.edges.size(); ++k) {
    BrepEdge& edge = shape.edges[k];
    if (edge.degenerate || (*uses)[k].size() != 1) continue;
    const EdgeUse use = (*uses)[k][0];
    const SpaceCurve curve(shape, use, line, failure);
    if (!failure.ok()) return failure;
    const SpaceCurve::Sample &first = curve.samples().front(), &last = curve.samples().back();
    const bool reversed = edge_loops(shape.faces[use.face])[use.loop].coedges[use.curve].reversed;
    std::uint32_t &start = reversed ? edge.end : edge.start, &end = reversed ? edge.start : edge.end;
    for (const auto& [vertex, sample] : {std::pair(&start, first), std::pair(&end, last)}) {
      if (*vertex != no_id) continue;
      *vertex = size_of(shape.vertices);
      shape.vertices.push_back({sample.point});
    }
    if (curve.extent() <= point_share * distance) {
      out.points.push_back(k);
      out.same_vertices.push_back({start, end});
      continue;
    }
    out.curves.push_back({k,
                          use,
                          curve,
                          std::min(distance, 0.5 * curve.extent()),
                          {{first.t, first.point, start}, {last.t, last.point, end}}});
  }
  return out;
}

}}  // namespace tessera::abi_0_1
