// The vertices that plans list along the edges of shapes.

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "tess_trim/closed_shape.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

constexpr double small = 0.01;  // a tolerance

/// The parameters and the positions along one use of an edge, each once.
using Line = std::map<double, std::array<double, 3>>;

std::map<std::pair<std::uint32_t, std::uint32_t>, Line> lines_of(const std::vector<EdgeVertex>& all, const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Line> lines;
  for (const EdgeVertex& one : all) {
    const Vec3 at = vertex(mesh, one.vertex);
    const auto [place, is_new] = lines[{one.edge, one.use}].try_emplace(one.s, std::array{at.x, at.y, at.z});
    EXPECT_EQ(place->second, (std::array{at.x, at.y, at.z})) << "edge " << one.edge << " at " << one.s;
    (void)is_new;
  }
  return lines;
}

void expect_shared_lines(const Shape& shape, const TessellationOptions& options) {
  const PatchSet set = value_of(make_patch_set(shape));
  const Tessellation plan = value_of(Tessellation::make(set, options));
  const Mesh mesh = value_of(plan.run(set));
  const std::vector<EdgeVertex> all = value_of(edge_vertices(plan));
  const auto order = [](const EdgeVertex& of) { return std::tuple(of.edge, of.use, of.s); };
  EXPECT_TRUE(std::ranges::is_sorted(all, {}, order));
  const EdgeUses uses = value_of(edge_uses(shape));
  const auto lines = lines_of(all, mesh);
  std::size_t count = 0;
  for (std::uint32_t edge = 0; edge < shape.edges.size(); ++edge) {
    const Line* first = nullptr;
    std::size_t found = 0;
    for (auto at = lines.lower_bound({edge, 0}); at != lines.end() && at->first.first == edge; ++at, ++found) {
      if (!first) first = &at->second;
      EXPECT_EQ(at->second, *first) << "edge " << edge;
    }
    EXPECT_EQ(found, uses[edge].size()) << "edge " << edge;
    count += found;
    ASSERT_TRUE(first);
    EXPECT_NEAR(first->begin()->first, shape.edges[edge].range.from, 1e-9);
    EXPECT_NEAR(first->rbegin()->first, shape.edges[edge].range.to, 1e-9);
  }
  EXPECT_EQ(count, uses.uses.size());
}

TEST(EdgeVertices, UsesOfAnEdgeHaveThoseOfOneLine) {
  for (const double turn : {0.0, 0.7}) {
    const Shape shape = joined(drilled_plate(1.7, 1.4, 0.6, turn), 1e-6);
    for (const double tolerance : {1.0, small, 1e-4}) {
      TessellationOptions options{.tolerance = tolerance};
      options.joining.edge_vertices = true;
      expect_shared_lines(shape, options);
      options.joining.share_vertices = true;
      expect_shared_lines(shape, options);
    }
  }
}

/// The line along an edge is part of the boundary of its face's triangles: neighbours on it are sides of triangles.
TEST(EdgeVertices, NeighboursAreSidesOfTriangles) {
  const Shape shape = joined(drilled_plate(), 1e-6);
  TessellationOptions options{.tolerance = small};
  options.joining.edge_vertices = true;
  options.joining.share_vertices = true;
  options.parameters = VertexParameters::surface;  // vertices of different faces are apart
  const PatchSet set = value_of(make_patch_set(shape));
  const Tessellation plan = value_of(Tessellation::make(set, options));
  const Mesh mesh = value_of(plan.run(set));
  std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = mesh.indices[t + c], b = mesh.indices[t + (c + 1) % 3];
      sides.insert(std::minmax(a, b));
    }
  const std::vector<EdgeVertex> all = value_of(edge_vertices(plan));
  std::size_t checked = 0;
  for (std::size_t k = 1; k < all.size(); ++k)
    if (all[k].use == all[k - 1].use) {
      EXPECT_TRUE(sides.contains(std::minmax(all[k].vertex, all[k - 1].vertex))) << "edge " << all[k].edge;
      ++checked;
    }
  EXPECT_GT(checked, 60u);
}

TEST(EdgeVertices, AreListedOnlyWhereAskedFor) {
  const PatchSet set = value_of(make_patch_set(joined(drilled_plate(), 1e-6)));
  const auto count = [&](const Joining& joining) {
    const TessellationOptions options{.tolerance = small, .joining = joining};
    return value_of(edge_vertices(value_of(Tessellation::make(set, options)))).size();
  };
  EXPECT_EQ(count({}), 0u);
  EXPECT_GT(count({.edge_vertices = true}), 8u);
  EXPECT_EQ(count({.close_edges = false, .edge_vertices = true}), 0u);
}

}}  // namespace tessera::test
