// Meshes of trimmed faces: within their bound in both directions, without cracks between patches.

#include "tess/trimmed/trimmed_face.h"

#include <functional>

#include "support/triangle_distance.h"
#include "tess_trim/plane_reference.h"
#include "tessera/nurbs_surface.h"
#include "trim/trim_shapes.h"

namespace tessera::test {
namespace {

/// The part that loops keep, in closed form.
struct Kept {
  std::function<bool(const ParameterPoint&)> holds;
  std::function<ParameterPoint(const ParameterPoint&)> nearest;  ///< a point of the border, for points beside it
};
/// The domain without round holes, or with a disc alone.
Kept outside_of(std::vector<std::pair<ParameterPoint, double>> discs, bool inside = false) {
  const auto offset = [](const ParameterPoint& p, const ParameterPoint& centre) {
    return std::hypot(p.u - centre.u, p.v - centre.v);
  };
  return {[=](const ParameterPoint& p) {
            for (const auto& [centre, radius] : discs)
              if ((offset(p, centre) < radius) != inside) return false;
            return true;
          },
          [=](const ParameterPoint& p) {
            ParameterPoint best{};
            double least = 1e9;
            for (const auto& [centre, radius] : discs) {
              const double r = offset(p, centre);
              if (std::abs(r - radius) >= least) continue;
              least = std::abs(r - radius);
              best = {centre.u + (p.u - centre.u) * radius / r, centre.v + (p.v - centre.v) * radius / r};
            }
            return best;
          }};
}

PatchGrid wavy_grid() {
  std::vector<Vec3> points;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 6; ++j) points.push_back({double(i), double(j), std::sin(1.3 * i) * std::cos(0.9 * j)});
  const std::vector<double> u{0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4}, v{0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
  return value_of(to_bezier(value_of(BSplineSurface::polynomial(3, u, 3, v, points))));
}
/// A quarter of a cylinder of radius 2, rational along u, over [0, 4] x [0, 3].
PatchGrid cylinder_grid() {
  const std::vector<Vec3> points{{2, 0, 0}, {2, 0, 6}, {2, 2, 0}, {2, 2, 6}, {0, 2, 0}, {0, 2, 6}};
  const double w = std::sqrt(0.5);
  const auto patch = value_of(BezierPatch::rational(2, 1, points, std::vector<double>{1, 1, w, w, 1, 1}));
  return value_of(PatchGrid::make({0, 4}, {0, 3}, {patch}, {}));
}
PatchGrid plane_grid() {
  const auto patch =
      value_of(BezierPatch::polynomial(1, 1, std::vector<Vec3>{{0, 0, 1}, {0, 3, 1}, {4, 0, 1}, {4, 3, 1}}));
  return value_of(PatchGrid::make({0, 4}, {0, 3}, {patch}, {}));
}

RepairedLoops repaired(const PatchGrid& grid, const std::vector<TrimLoop>& loops) {
  const auto axis = [](std::span<const double> lines) {
    return CutAxis{{lines.begin(), lines.end()}, false, 0x1p-44 * (lines.back() - lines.front())};
  };
  return value_of(repair_loops(loops, {axis(grid.breaks_u()), axis(grid.breaks_v())}));
}

Vec3 position(const Mesh& mesh, std::uint32_t vertex) {
  const float* p = &mesh.positions[3 * std::size_t{vertex}];
  return mesh.origin + Vec3{p[0], p[1], p[2]};
}
ParameterPoint parameters(const PatchGrid& grid, const Mesh& mesh, std::size_t triangle, const double (&shares)[3]) {
  const Domain domain = grid.patch_domain(mesh.patches[triangle]);
  ParameterPoint at{};
  for (std::size_t k = 0; k < 3; ++k) {
    const float* p = &mesh.parameters[2 * std::size_t{mesh.indices[3 * triangle + k]}];
    at.u += shares[k] * (domain.u0 + p[0] * (domain.u1 - domain.u0));
    at.v += shares[k] * (domain.v0 + p[1] * (domain.v1 - domain.v0));
  }
  return at;
}

/// The distance of x from the kept part, near `at`: not above the true one's upper bounds, found by Newton's method.
double distance_to_kept(const PatchGrid& grid, const Kept& kept, const Vec3& x, ParameterPoint at) {
  double best = 1e9;
  for (int step = 0; step < 6; ++step) {
    ParameterPoint inside = kept.holds(at) ? at : kept.nearest(at);
    const Domain all = grid.domain();
    inside = {std::clamp(inside.u, all.u0, all.u1), std::clamp(inside.v, all.v0, all.v1)};
    const SurfaceJet jet = *grid.evaluate_jet(inside.u, inside.v);
    const Vec3 d = x - jet.position;
    best = std::min(best, length(d));
    const double uu = dot(jet.du, jet.du), uv = dot(jet.du, jet.dv), vv = dot(jet.dv, jet.dv);
    const double du = dot(jet.du, d), dv = dot(jet.dv, d), det = uu * vv - uv * uv;
    at = {inside.u + (du * vv - dv * uv) / det, inside.v + (dv * uu - du * uv) / det};
  }
  return best;
}

/// The largest distance from random points of the mesh to the kept part, and from kept points to the mesh.
std::pair<double, double> distances(const PatchGrid& grid, const Kept& kept, const Mesh& mesh) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  double of_mesh = 0, of_face = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 4; ++k) {
      const double a = uniform(random), b = uniform(random) * (1 - a), shares[3] = {a, b, 1 - a - b};
      Vec3 x{};
      for (std::size_t c = 0; c < 3; ++c) x = x + shares[c] * position(mesh, mesh.indices[3 * t + c]);
      of_mesh = std::max(of_mesh, distance_to_kept(grid, kept, x, parameters(grid, mesh, t, shares)));
    }
  }
  struct Corners {
    Vec3 p, q, r;
    double size;
  };
  std::vector<Corners> corners;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto at = [&](std::size_t k) { return position(mesh, mesh.indices[3 * t + k]); };
    corners.push_back({at(0), at(1), at(2), std::max(length(at(1) - at(0)), length(at(2) - at(0)))});
  }
  const Domain all = grid.domain();
  for (int k = 0; k < 800; ++k) {
    ParameterPoint at{all.u0 + uniform(random) * (all.u1 - all.u0), all.v0 + uniform(random) * (all.v1 - all.v0)};
    if (!kept.holds(at)) at = kept.nearest(at);  // points of the border are kept
    if (!all.contains(at.u, at.v)) continue;
    const Vec3 x = grid.evaluate_jet(at.u, at.v)->position;
    double least = 1e9;
    for (const auto& [p, q, r, size] : corners)
      if (length(x - p) < least + size) least = std::min(least, distance_to_triangle(x, p, q, r));
    of_face = std::max(of_face, least);
  }
  return {of_mesh, of_face};
}

/// Vertices less edges plus triangles: the number of components less that of holes.
std::ptrdiff_t euler_number(const MeshReport& report) {
  const auto edges = static_cast<std::ptrdiff_t>(3 * report.triangles + report.open_edges) / 2;
  return static_cast<std::ptrdiff_t>(report.distinct_positions) - edges + static_cast<std::ptrdiff_t>(report.triangles);
}

/// Expects a mesh within its bound, and its bound within the tolerance; with this many components less holes.
void expect_good(const PatchGrid& grid, const std::vector<TrimLoop>& loops, const Kept& kept, double tolerance,
                 std::ptrdiff_t euler) {
  const auto made = mesh_trimmed_face(grid, repaired(grid, loops), tolerance, {1, 1, 0});
  ASSERT_TRUE(made.ok()) << made.status().message();
  const Mesh& mesh = made->mesh;
  ASSERT_GT(mesh.triangle_count(), 0u);
  EXPECT_LE(made->bound, tolerance);
  const MeshReport report = value_of(check(mesh));
  EXPECT_EQ(report.non_manifold_edges + report.inconsistent_edges + report.t_junctions + report.degenerate_triangles,
            0u);
  EXPECT_EQ(euler_number(report), euler);
  const auto [of_mesh, of_face] = distances(grid, kept, mesh);
  EXPECT_LE(of_mesh, made->bound);
  EXPECT_LE(of_face, made->bound);
}

TEST(TrimmedFace, OfAPlaneWithHolesKeepsItsBound) {
  const std::vector<TrimLoop> loops{rectangle(0, 4, 0, 3), circle({1, 1}, 0.7), circle({3, 1.7}, 0.9)};
  for (const double tolerance : {0.3, 1e-2, 1e-4})
    expect_good(plane_grid(), loops, outside_of({{{1, 1}, 0.7}, {{3, 1.7}, 0.9}}), tolerance, -1);
}

TEST(TrimmedFace, OfAHoleAcrossPatchesKeepsItsBound) {
  const std::vector<TrimLoop> loops{circle({1.9, 1.4}, 1.15, true)};
  for (const double tolerance : {0.3, 1e-2, 1e-3})
    expect_good(wavy_grid(), loops, outside_of({{{1.9, 1.4}, 1.15}}), tolerance, 0);
}

TEST(TrimmedFace, OfADiscWithinPatchesKeepsItsBound) {
  for (const double radius : {0.04, 0.3, 1.3})
    expect_good(wavy_grid(), {circle({2, 1}, radius)}, outside_of({{{2, 1}, radius}}, true), 1e-2, 1);
}

TEST(TrimmedFace, OfACylinderKeepsItsBound) {
  const std::vector<TrimLoop> loops{rectangle(0, 4, 0, 3), circle({1.5, 1.5}, 1)};
  for (const double tolerance : {1e-1, 1e-2, 1e-3})
    expect_good(cylinder_grid(), loops, outside_of({{{1.5, 1.5}, 1}}), tolerance, 0);
}

// The rectangle as a loop runs along the sides of patches; a smaller one along lines between them.
TEST(TrimmedFace, OfLoopsAlongPatchBordersIsWhole) {
  const PatchGrid grid = wavy_grid();
  const auto whole = mesh_trimmed_face(grid, repaired(grid, {rectangle(0, 4, 0, 3)}), 1e-2, {});
  ASSERT_TRUE(whole.ok()) << whole.status().message();
  EXPECT_EQ(whole->whole_patches, 12u);
  EXPECT_EQ(whole->cut_patches + whole->patches_left_out, 0u);
  const auto part = mesh_trimmed_face(grid, repaired(grid, {rectangle(1, 3, 0, 2)}), 1e-2, {});
  ASSERT_TRUE(part.ok()) << part.status().message();
  EXPECT_EQ(part->whole_patches, 4u);
  EXPECT_EQ(part->patches_left_out, 8u);
  for (const auto* made : {&*whole, &*part}) {
    const MeshReport report = value_of(check(made->mesh));
    EXPECT_EQ(report.non_manifold_edges + report.inconsistent_edges + report.t_junctions, 0u);
  }
}

/// The area of a mesh in the parameters of its face.
double plane_area(const PatchGrid& grid, const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const ParameterPoint a = parameters(grid, mesh, t, {1, 0, 0}), b = parameters(grid, mesh, t, {0, 1, 0}),
                         c = parameters(grid, mesh, t, {0, 0, 1});
    sum += ((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u)) / 2;
  }
  return sum;
}

// Discs apart from each other, kept or cut away: with centres on lines between patches, or touching these lines.
TEST(TrimmedFace, OfRandomDiscsHasTheirAreaAndNoCracks) {
  const PatchGrid grid = wavy_grid();
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int round = 0; round < 80; ++round) {
    std::vector<std::pair<ParameterPoint, double>> discs;
    for (int k = 0; k < 30; ++k) {
      ParameterPoint centre{0.2 + 3.6 * uniform(random), 0.2 + 2.6 * uniform(random)};
      double radius = 0.02 + uniform(random) * (random() % 3 ? 0.3 : 1);
      if (k % 4 == 0) centre.u = std::round(centre.u);
      if (k % 4 == 1) centre.v = std::round(centre.v);
      if (k % 4 == 2) radius = std::max(0.01, std::abs(centre.u - std::round(centre.u)));
      const double room = std::min({centre.u, 4 - centre.u, centre.v, 3 - centre.v});
      bool is_free = room > radius + 0.001;
      for (const auto& [other, size] : discs)
        is_free = is_free && std::hypot(centre.u - other.u, centre.v - other.v) > radius + size + 0.01;
      if (is_free) discs.emplace_back(centre, radius);
    }
    const bool are_holes = round % 2 == 0;
    std::vector<TrimLoop> loops;
    double area = 0, length_of_borders = 0;
    for (const auto& [centre, radius] : discs) {
      loops.push_back(circle(centre, radius, are_holes));
      area += std::numbers::pi * radius * radius;
      length_of_borders += 2 * std::numbers::pi * radius;
    }
    const double tolerance = std::pow(10, -0.5 - 1.5 * uniform(random));
    const auto made = mesh_trimmed_face(grid, repaired(grid, loops), tolerance, {1, 1, 0});
    ASSERT_TRUE(made.ok()) << round << ": " << made.status().message();
    ASSERT_LE(made->bound, tolerance);
    const MeshReport report = value_of(check(made->mesh));
    ASSERT_EQ(report.non_manifold_edges + report.inconsistent_edges + report.t_junctions + report.degenerate_triangles,
              0u)
        << round;
    const auto count = static_cast<std::ptrdiff_t>(discs.size());
    ASSERT_EQ(euler_number(report), are_holes ? 1 - count : count) << round;
    // Lengths on the surface are at least those of the parameters: slivers are no wider than the tolerance.
    ASSERT_NEAR(plane_area(grid, made->mesh), are_holes ? 12 - area : area, length_of_borders * tolerance + 1e-5)
        << round;
  }
}

TEST(TrimmedFace, OfBadInputIsRefused) {
  const PatchGrid grid = wavy_grid();
  for (const double tolerance : {0.0, -1.0, std::nan(""), 1e-12})
    EXPECT_EQ(mesh_trimmed_face(grid, repaired(grid, {rectangle(0, 4, 0, 3)}), tolerance, {}).status().code(),
              StatusCode::invalid_argument);
  const auto crossed =
      mesh_trimmed_face(grid, repaired(grid, {polygon({{0.1, 0.1}, {0.9, 0.83}, {0.9, 0.1}, {0.13, 0.9}})}), 1e-2, {});
  EXPECT_EQ(crossed.status().code(), StatusCode::unsupported);
}

}  // namespace
}  // namespace tessera::test
