#include "tessera/edge_matching.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "join/curve_splits.h"
#include "join/joined_loops.h"
#include "tessera/guard.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status check(const Shape& shape, double distance) {
  if (!std::isfinite(distance) || !(distance > 0))
    return Status(StatusCode::invalid_argument,
                  "the distance of edges must be a finite number above 0, not " + text(distance));
  return check_topology(shape);
}

/// Makes shells of the faces that are in no solid's, by the edges that they share, and solids of the closed ones.
Status make_shells(Shape& shape) {
  const auto count = static_cast<std::uint32_t>(shape.faces.size());
  std::vector<bool> in_solid(count, false);
  std::erase_if(shape.shells, [](const Shell& shell) { return shell.solid == no_id; });
  for (const Shell& shell : shape.shells)
    for (const std::uint32_t face : shell.faces) in_solid[face] = true;
  const Result<EdgeUses> uses = edge_uses(shape);
  if (!uses) return uses.status();
  UnionFind joined(count);
  for (std::size_t edge = 0; edge < shape.edges.size(); ++edge) {
    std::uint32_t first = no_id;
    for (const EdgeUse& use : (*uses)[edge]) {
      if (in_solid[use.face]) continue;
      if (first == no_id) first = use.face;
      joined.unite(first, use.face);
    }
  }
  const std::size_t solids = shape.shells.size();
  std::vector<std::size_t> shell_of(count, 0);
  for (std::uint32_t face = 0; face < count; ++face) {
    if (in_solid[face]) continue;
    const std::uint32_t root = joined.find(face).member;
    if (root == face) {
      shell_of[face] = shape.shells.size();
      shape.shells.emplace_back();
    }
    shape.shells[shell_of[root]].faces.push_back(face);
  }
  const Result<std::vector<bool>> closed = closed_shells(shape);
  if (!closed) return closed.status();
  for (std::size_t k = solids; k < shape.shells.size(); ++k)
    if ((*closed)[k]) shape.shells[k].solid = shape.solid_count++;
  return {};
}

/// Joins edges of one use.
Result<Shape> join(Shape shape, double distance, Line line) {
  Status failure;
  Result<FreeCurves> free = find_free_curves(shape, distance, line, failure);
  if (!free) return free.status();
  split_curves(*free, shape.vertices);
  const std::vector<CurvePiece> pieces = list_pieces(*free);
  if (!failure.ok()) return failure;
  std::vector<PiecePair> pairs = list_pairs(*free, pieces);
  UnionFind vertices(shape.vertices.size());
  const std::vector<PieceGroup> groups = group_pieces(*free, pieces, std::move(pairs), vertices);
  Shape joined = with_joined_loops(shape, *free, pieces, groups, vertices, failure);
  if (!failure.ok()) return failure;
  return joined;
}

}  // namespace

Result<Shape> joined_edges(const Shape& given, double distance) {
  return guarded([&]() -> Result<Shape> {
    if (Status status = check(given, distance); !status.ok()) return status;
    Shape shape = given;
    if (Status status = name_all_edges(shape, distance); !status.ok()) return status;
    const auto states_curve = [](const BrepEdge& edge) { return edge.curve.has_value(); };
    if (std::any_of(shape.edges.begin(), shape.edges.end(), states_curve)) {
      Result<Shape> joined = join(std::move(shape), distance, Line::stated);
      if (!joined) return joined;
      shape = *std::move(joined);
    }
    Result<Shape> joined = join(std::move(shape), distance, Line::on_face);
    if (!joined) return joined;
    if (Status status = make_shells(*joined); !status.ok()) return status;
    return joined;
  });
}

Result<double> joining_distance(const Shape& given) {
  return guarded([&]() -> Result<double> {
    constexpr double share = 1e-4;
    constexpr int steps = 4;
    if (Status status = check_topology(given); !status.ok()) return status;
    Shape shape = given;
    if (Status status = name_all_edges(shape, 0); !status.ok()) return status;
    Box3 box;
    for (std::size_t k = 0; k < shape.faces.size(); ++k)
      for (const TrimLoop& loop : edge_loops(shape.faces[k]))
        for (const Curve& curve : loop.curves)
          for (int step = 0; step <= steps; ++step) {
            const double x = static_cast<double>(step) / steps;
            const Result<FacePoint> point =
                face_point(shape.faces[k], curve, (1 - x) * curve.domain().from + x * curve.domain().to);
            if (!point) return in_face(shape, k, point.status());
            box.extend(point->position);
          }
    return share * box.diagonal();
  });
}

Result<Shape> joined_shape(std::span<const ModelSurface> surfaces, double distance) {
  return guarded([&]() -> Result<Shape> {
    Shape shape;
    for (const ModelSurface& surface : surfaces) shape.faces.push_back({surface});
    return joined_edges(shape, distance);
  });
}

}}  // namespace tessera::abi_0_1
