#include "measure/shell_orientation.h"

#include <algorithm>

#include "base/impl_access.h"
#include "base/text.h"
#include "measure/kept_strips.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// How far the outline of a spline may be off the sides of its domain, as a share of it (see model/model_patches.cpp).
constexpr double outline_snap = 0x1p-13;

/// Twice the area that a loop encloses, by its control polygons: its sign is the loop's direction.
double signed_area(const TrimLoop& loop) {
  double sum = 0;
  for (const Curve& curve : loop.curves) {
    const std::span<const Vec3> points = curve.points();
    for (std::size_t k = 0; k + 1 < points.size(); ++k)
      sum += points[k].x * points[k + 1].y - points[k].y * points[k + 1].x;
  }
  return sum;
}

/// A use of an edge, by the place of its face in the shell.
struct Use {
  std::uint32_t place;
  int direction;  ///< 1: with the kept part on its left, the face's border runs along the edge from start to end
};

std::vector<std::vector<Use>> uses_of(const Shape& shape, const std::vector<std::uint32_t>& faces,
                                      const std::vector<LoopDirections>& directions) {
  std::vector<std::vector<Use>> uses(shape.edges.size());
  for (std::uint32_t place = 0; place < faces.size(); ++place) {
    const std::vector<TrimLoop>& loops = edge_loops(shape.faces[faces[place]]);
    for (std::size_t k = 0; k < loops.size(); ++k)
      for (const Coedge& coedge : loops[k].coedges) {
        const int direction = directions.empty() ? 1 : directions[faces[place]][k];
        uses[coedge.edge].push_back({place, coedge.reversed ? -direction : direction});
      }
  }
  return uses;
}

}  // namespace

LoopDirections directions_of(const ShapeFace& face) {
  const std::vector<TrimLoop>& loops = edge_loops(face);
  LoopDirections directions(loops.size(), 0);
  ModelSurface surface = face;
  surface.trims = loops;
  const Result<PatchGrid> grid = to_bezier(surface);
  const Result<Shared<std::vector<TrimLoop>>> mapped = grid_trims(surface);
  if (grid && mapped) {
    TrimOptions options = TrimRegion::Impl::options_of(*grid);
    const bool is_quadric = std::holds_alternative<QuadricPiece>(surface.surface);
    if (face.trims->empty() && !is_quadric) options.snap = outline_snap;
    const Result<TrimRegion> region =
        TrimRegion::Impl::make(**mapped, grid->breaks_u(), grid->breaks_v(), options, TrimRegion::Impl::Use::patches);
    if (region) directions = loop_directions(impl_of(*region), loops.size());
  }
  for (std::size_t k = 0; k < loops.size(); ++k)
    if (directions[k] == 0) directions[k] = (signed_area(loops[k]) > 0) != (loops.size() > 1 && loops[k].hole) ? 1 : -1;
  return directions;
}

std::string open_edges_of(const Shape& shape, const std::vector<std::uint32_t>& faces) {
  const std::vector<std::vector<Use>> uses = uses_of(shape, faces, {});
  std::size_t count = 0;
  std::string list;
  for (std::size_t edge = 0; edge < uses.size(); ++edge) {
    if (uses[edge].size() % 2 == 0 || shape.edges[edge].degenerate) continue;
    constexpr std::size_t listed = 8;
    if (count < listed) list += (count == 0 ? " " : ", ") + std::to_string(edge);
    if (count == listed) list += ", ...";
    ++count;
  }
  if (count > 0) return counted(count, "open edge") + ":" + list;
  for (const std::uint32_t face : faces) {
    const auto names = [](const TrimLoop& loop) { return !loop.coedges.empty(); };
    if (std::ranges::none_of(edge_loops(shape.faces[face]), names))
      return "face " + std::to_string(face) + " names no edges";
  }
  return faces.empty() ? "it has no faces" : "";
}

Result<std::vector<OrientedFace>> oriented_faces(const Shape& shape, const std::vector<std::uint32_t>& shell,
                                                 const std::vector<LoopDirections>& directions) {
  const std::vector<std::vector<Use>> uses = uses_of(shape, shell, directions);
  struct Join {
    std::uint32_t to;
    int turn;  ///< -1: the faces' normals are on different sides
    std::size_t edge;
  };
  std::vector<std::vector<Join>> joins(shell.size());
  for (std::size_t edge = 0; edge < uses.size(); ++edge) {
    const std::vector<Use>& of = uses[edge];
    if (of.size() != 2 || shape.edges[edge].degenerate || of[0].place == of[1].place) continue;
    const int turn = of[0].direction == of[1].direction ? -1 : 1;
    joins[of[0].place].push_back({of[1].place, turn, edge});
    joins[of[1].place].push_back({of[0].place, turn, edge});
  }
  std::vector<OrientedFace> oriented(shell.size());
  std::vector<std::uint32_t> next;
  std::uint32_t part = 0;
  for (std::uint32_t start = 0; start < shell.size(); ++start) {
    if (oriented[start].sign != 0) continue;
    oriented[start] = {shell[start], 1, part};
    next.push_back(start);
    while (!next.empty()) {
      const std::uint32_t at = next.back();
      next.pop_back();
      for (const Join& join : joins[at]) {
        OrientedFace& other = oriented[join.to];
        const int sign = oriented[at].sign * join.turn;
        if (other.sign == 0) {
          other = {shell[join.to], sign, part};
          next.push_back(join.to);
        } else if (other.sign != sign) {
          return Status(StatusCode::invalid_argument, "its faces cannot be oriented: those of edge " +
                                                          std::to_string(join.edge) + " are on different sides");
        }
      }
    }
    ++part;
  }
  return oriented;
}

}}  // namespace tessera::abi_0_1
