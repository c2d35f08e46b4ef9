#include "measure/shell_orientation.h"

#include <algorithm>
#include <functional>
#include <utility>

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

/// Sets of faces, each turned or not relative to the first of its set.
class SignedUnion {
 public:
  explicit SignedUnion(std::size_t count) : parents_(count), signs_(count, 1) {
    for (std::size_t k = 0; k < count; ++k) parents_[k] = static_cast<std::uint32_t>(k);
  }
  /// Returns the first face of the set, and the sign relative to it.
  std::pair<std::uint32_t, int> find(std::uint32_t face) {
    int sign = 1;
    while (parents_[face] != face) {
      const std::uint32_t above = parents_[face];
      signs_[face] *= signs_[above];  // halves the path: roots have the sign 1
      parents_[face] = parents_[above];
      sign *= signs_[face];
      face = parents_[face];
    }
    return {face, sign};
  }
  /// Joins two sets, or returns whether the faces of one have the sign `turn` relative to each other.
  bool join(std::uint32_t a, std::uint32_t b, int turn) {
    const auto [root_a, sign_a] = find(a);
    const auto [root_b, sign_b] = find(b);
    if (root_a == root_b) return sign_a * sign_b == turn;
    const auto [low, high] = std::minmax({root_a, root_b});
    parents_[high] = low;
    signs_[high] = sign_a * sign_b * turn;
    return true;
  }

 private:
  std::vector<std::uint32_t> parents_;
  std::vector<int> signs_;  ///< relative to the parent
};

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

Result<OrientedShell> oriented_shell(const Shape& shape, const std::vector<std::uint32_t>& shell,
                                     const std::vector<LoopDirections>& directions,
                                     const std::vector<EdgeSlit>& slits) {
  const std::vector<std::vector<Use>> uses = uses_of(shape, shell, directions);
  std::vector<std::size_t> joining;
  double total = 0, against = 0;
  for (std::size_t edge = 0; edge < uses.size(); ++edge) {
    const std::vector<Use>& of = uses[edge];
    if (of.size() != 2 || shape.edges[edge].degenerate || of[0].place == of[1].place) continue;
    joining.push_back(edge);
    total += slits[edge].length;
  }
  std::ranges::stable_sort(joining, std::greater<>(), [&](std::size_t edge) { return slits[edge].length; });
  SignedUnion faces(shell.size());
  std::size_t worst = 0;
  OrientedShell oriented;
  for (const std::size_t edge : joining) {
    const Use &a = uses[edge][0], &b = uses[edge][1];
    const int turn = a.direction == b.direction ? -1 : 1;
    if (faces.join(a.place, b.place, turn)) continue;
    if (against == 0) worst = edge;
    against += slits[edge].length;
    oriented.conflicts.push_back({shell[a.place], shell[b.place]});
  }
  constexpr double share = 0.01;  // loops that are slivers have no reliable direction
  if (against > share * total)
    return Status(StatusCode::invalid_argument,
                  "its faces cannot be oriented: those of edge " + std::to_string(worst) + " are on different sides");
  std::vector<std::uint32_t> part(shell.size(), no_id);
  for (std::uint32_t place = 0; place < shell.size(); ++place) {
    const auto [root, sign] = faces.find(place);
    if (part[root] == no_id) part[root] = oriented.parts++;
    oriented.faces.push_back({shell[place], sign, part[root]});
  }
  return oriented;
}

}}  // namespace tessera::abi_0_1
