// Meshes of trimmed faces: within their bound in both directions, without cracks between patches.

#include <algorithm>
#include <functional>
#include <numbers>

#include "plane/plane_reference.h"
#include "support/triangle_distance.h"
#include "tess/proven_mesh_of.h"
#include "tess_trim/trimmed_face.h"
#include "trim/trim_shapes.h"

namespace tessera::test { namespace {

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

Vec3 position(const Mesh& mesh, std::uint32_t vertex) {
  const float* p = &mesh.positions[3 * std::size_t{vertex}];
  return mesh.origin + Vec3{p[0], p[1], p[2]};
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
std::pair<double, double> distances(const Face& face, const Kept& kept, const Mesh& mesh) {
  const PatchGrid& grid = face.grid;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  double of_mesh = 0, of_face = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 4; ++k) {
      const double a = uniform(random), b = uniform(random) * (1 - a), shares[3] = {a, b, 1 - a - b};
      Vec3 x{};
      for (std::size_t c = 0; c < 3; ++c) x = x + shares[c] * position(mesh, mesh.indices[3 * t + c]);
      of_mesh = std::max(of_mesh, distance_to_kept(grid, kept, x, parameters(face, mesh, t, shares)));
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

/// Expects triangles that share their edges, and as many open ones as the plan says.
MeshReport expect_joined(const Face& face, const Mesh& mesh) {
  MeshReport report = value_of(check(mesh));
  EXPECT_EQ(report.non_manifold_edges + report.inconsistent_edges + report.t_junctions + report.degenerate_triangles,
            0u);
  EXPECT_EQ(report.open_edges, face.open_edges);
  return report;
}

/// Expects a mesh within its bound, and its bound within the tolerance; with this many components less holes.
void expect_good(const BSplineSurface& surface, const std::vector<TrimLoop>& loops, const Kept& kept, double tolerance,
                 std::ptrdiff_t euler) {
  Face face(surface, loops);
  const Mesh mesh = face.mesh(tolerance);
  ASSERT_GT(mesh.triangle_count(), 0u);
  EXPECT_LE(face.bound, tolerance);
  EXPECT_EQ(euler_number(expect_joined(face, mesh)), euler);
  const auto [of_mesh, of_face] = distances(face, kept, mesh);
  EXPECT_LE(of_mesh, face.bound);
  EXPECT_LE(of_face, face.bound);
}

TEST(TrimmedFace, OfAPlaneWithHolesKeepsItsBound) {
  const std::vector<TrimLoop> loops{rectangle(0, 4, 0, 3), circle({1, 1}, 0.7), circle({3, 1.7}, 0.9)};
  for (const double tolerance : {0.3, 1e-2, 1e-4})
    expect_good(plane(), loops, outside_of({{{1, 1}, 0.7}, {{3, 1.7}, 0.9}}), tolerance, -1);
}

TEST(TrimmedFace, OfAHoleAcrossPatchesKeepsItsBound) {
  const std::vector<TrimLoop> loops{circle({1.9, 1.4}, 1.15, true)};
  for (const double tolerance : {0.3, 1e-2, 1e-3})
    expect_good(wavy(), loops, outside_of({{{1.9, 1.4}, 1.15}}), tolerance, 0);
}

TEST(TrimmedFace, OfADiscWithinPatchesKeepsItsBound) {
  for (const double radius : {0.04, 0.3, 1.3})
    expect_good(wavy(), {circle({2, 1}, radius)}, outside_of({{{2, 1}, radius}}, true), 1e-2, 1);
}

TEST(TrimmedFace, OfACylinderKeepsItsBound) {
  const std::vector<TrimLoop> loops{rectangle(0, 4, 0, 3), circle({1.5, 1.5}, 1)};
  for (const double tolerance : {1e-1, 1e-2, 1e-3})
    expect_good(cylinder(), loops, outside_of({{{1.5, 1.5}, 1}}), tolerance, 0);
}

/// A circle of equal arcs, each a curve of its own.
TrimLoop arcs(const ParameterPoint& centre, double radius, int count) {
  const double step = 2 * std::numbers::pi / count, middle = std::cos(step / 2);
  const auto at = [&](double angle, double r) {
    return Vec3{centre.u + r * std::cos(angle), centre.v + r * std::sin(angle), 0};
  };
  TrimLoop loop;
  for (int k = 0; k < count; ++k) {
    const std::vector<Vec3> points{at(k * step, radius), at((k + 0.5) * step, radius / middle),
                                   at((k + 1) % count * step, radius)};
    loop.curves.push_back(value_of(Curve::bezier(points, std::vector<double>{1, middle, 1})));
  }
  return loop;
}

// A chord over many pieces ends where one of them does. At 1e-3 the circle has 72 chords, as long as 5.6 of 400 pieces;
// chords of 5 pieces are 80, a ninth more.
TEST(TrimmedFace, OfLoopsInManyPiecesHasFewMoreTriangles) {
  Face many(plane(), {arcs({2, 1.5}, 1, 400)}), few(plane(), {circle({2, 1.5}, 1)});
  for (const double tolerance : {1e-1, 1e-2, 1e-3})
    EXPECT_LE(8 * many.mesh(tolerance).triangle_count(), 9 * few.mesh(tolerance).triangle_count()) << tolerance;
  for (const double tolerance : {0.3, 1e-2, 1e-4})
    expect_good(plane(), {arcs({2, 1.5}, 1, 400)}, outside_of({{{2, 1.5}, 1}}, true), tolerance, 1);
  expect_good(wavy(), {arcs({2, 1}, 1.3, 400)}, outside_of({{{2, 1}, 1.3}}, true), 1e-2, 1);
}

// Faces of equal loops share what is made of them, unless their surfaces or the kept sides differ.
TEST(TrimmedFace, KeepsBesideOthersOfItsLoopsWhatItKeepsAlone) {
  const TrimLoop disc = circle({1, 1}, 0.7), hole = circle({1, 1}, 0.7, true);
  const Affine moved = Affine::translated({0, 0, 5});
  const std::vector<ModelSurface> faces{{"a", plane(), {}, std::vector{disc}},
                                        {"b", plane(), {}, std::vector{hole}},
                                        {"c", plane(), moved, std::vector{disc}},
                                        {"d", wavy(), {}, std::vector{disc}},
                                        {"e", plane(), {}, std::vector{hole}}};
  const auto triangles = [](const PatchSet& set) {
    return value_of(Tessellation::make(set, {.tolerance = 1e-2})).capacity().triangles;
  };
  std::size_t patches = 0, cut = 0, sum = 0;
  for (const ModelSurface& face : faces) {
    const PatchSet alone = value_of(make_patch_set(Model{"", {face}}));
    patches += alone.patch_count(), cut += alone.cut_count(), sum += triangles(alone);
  }
  const PatchSet all = value_of(make_patch_set(Model{"", faces}));
  EXPECT_EQ(all.patch_count(), patches);
  EXPECT_EQ(all.cut_count(), cut);
  EXPECT_EQ(triangles(all), sum);
}

// Whole patches take the same way as those of a face without loops: the same bytes.
TEST(TrimmedFace, OfLoopsAlongPatchBordersIsWhole) {
  Face whole(wavy(), {rectangle(0, 4, 0, 3)}), plain(wavy(), {});
  EXPECT_EQ(whole.set.cut_count(), 0u);
  const Mesh a = whole.mesh(1e-2), b = plain.mesh(1e-2);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.indices, b.indices);
  Face part(wavy(), {rectangle(1, 3, 0, 2)});
  EXPECT_EQ(part.set.patch_count(), 4u);
  EXPECT_EQ(part.set.cut_count(), 0u);
  expect_joined(part, part.mesh(1e-2));
}

/// The bits of the positions of the triangles of some patches, in their order.
std::vector<float> positions_of(const Mesh& mesh, const std::function<bool(std::uint32_t)>& wanted) {
  std::vector<float> bits;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::size_t c = 0; c < 3 && wanted(mesh.patches[t]); ++c)
      for (std::size_t k = 0; k < 3; ++k) bits.push_back(mesh.positions[3 * mesh.indices[3 * t + c] + k]);
  return bits;
}

// Away from the hole nothing changes: patches that touch no cut one keep their triangles, bit for bit.
TEST(TrimmedFace, LeavesOtherPatchesAsTheyAre) {
  Face trimmed(wavy(), {circle({0.5, 0.5}, 0.2, true)}), plain(wavy(), {});
  ASSERT_EQ(trimmed.set.cut_count(), 1u);
  ASSERT_TRUE(trimmed.set.is_cut(0));
  trimmed.model.surfaces[0].trims = {};
  const PatchSetOptions same{.origin = trimmed.set.origin()};
  plain.set = value_of(make_patch_set(plain.model, same));
  const auto is_far = [](std::uint32_t patch) { return patch != 0 && patch != 1 && patch != 3; };
  EXPECT_EQ(positions_of(trimmed.mesh(1e-3), is_far), positions_of(plain.mesh(1e-3), is_far));
}

// The vertices of some patches come from doubles, cut or whole, and those of others from floats.
TEST(TrimmedFace, FarFromTheOriginKeepsItsBoundWithoutCracks) {
  for (const ParameterPoint& centre : {ParameterPoint{1.9, 1.4}, ParameterPoint{0.7, 2.2}, ParameterPoint{3.2, 0.8}}) {
    const std::vector<TrimLoop> loops{circle(centre, 0.6, true)};
    Face face(wavy(198), loops);
    face.set = value_of(make_patch_set(face.model, {.origin = Vec3{}}));
    const Mesh mesh = face.mesh(1e-3);
    const Tessellation plan = value_of(Tessellation::make(face.set, {.tolerance = 1e-3}));
    const auto is_f64 = proven_mesh_of(plan).plan().patches().rare->f64_patches;
    ASSERT_EQ(is_f64.size(), 12u);
    EXPECT_FALSE(is_f64[0]);
    EXPECT_TRUE(is_f64[11]);
    EXPECT_LE(face.bound, 1e-3);
    EXPECT_EQ(euler_number(expect_joined(face, mesh)), 0);
    const auto [of_mesh, of_face] = distances(face, outside_of({{centre, 0.6}}), mesh);
    EXPECT_LE(of_mesh, face.bound);
    EXPECT_LE(of_face, face.bound);
  }
}

// A far face that needs doubles changes nothing of a near one, nor the other way round.
TEST(TrimmedFace, KeepsItsBitsWithoutOtherFaces) {
  const std::vector<TrimLoop> loops{circle({1.9, 1.4}, 0.6, true)};
  Face near(wavy(), loops), far(wavy(1000), loops), both(wavy(), loops);
  both.model.surfaces.push_back(far.model.surfaces[0]);
  for (Face* face : {&near, &far, &both}) face->set = value_of(make_patch_set(face->model, {.origin = Vec3{}}));
  const auto all = [](std::uint32_t) { return true; };
  const Mesh mesh = both.mesh(2e-3);
  EXPECT_EQ(positions_of(mesh, [](std::uint32_t k) { return k < 12; }), positions_of(near.mesh(2e-3), all));
  EXPECT_EQ(positions_of(mesh, [](std::uint32_t k) { return k >= 12; }), positions_of(far.mesh(2e-3), all));
  EXPECT_EQ(euler_number(expect_joined(both, mesh)), 0);
}

// Whole patches that give vertices to cut ones follow them: a near camera sees all borders closer than a pixel's share.
TEST(TrimmedFace, FarFromTheOriginKeepsPixels) {
  std::size_t mixed = 0;
  for (double height = 0.2; height < 20; height *= 1.15) {
    Face face(wavy(10000), {circle({1.9, 1.4}, 0.6, true)});
    face.set = value_of(make_patch_set(face.model, {.origin = Vec3{}}));
    const View view{.eye = {10002.9, 2.5, 1 + height}, .target = {10002.9, 2.4, 0}, .width = 640, .height = 480};
    const Result<Tessellation> plan = Tessellation::make(face.set, {.pixels = PixelTolerance{4, view}});
    ASSERT_TRUE(plan) << height << ": " << plan.status().message();
    const auto is_f64 = proven_mesh_of(*plan).plan().patches().rare->f64_patches;
    mixed += std::ranges::count(is_f64, 0) > 0;
    EXPECT_LE(plan->pixels(), 4 * (1 + 1e-6));
  }
  EXPECT_GT(mixed, 0u);
}

// Discs apart from each other, kept or cut away: with centres on lines between patches, or touching these lines.
TEST(TrimmedFace, OfRandomDiscsHasTheirAreaAndNoCracks) {
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
    SCOPED_TRACE(round);
    Face face(wavy(), loops);
    const Mesh mesh = face.mesh(tolerance);
    ASSERT_LE(face.bound, tolerance);
    const auto count = static_cast<std::ptrdiff_t>(discs.size());
    ASSERT_EQ(euler_number(expect_joined(face, mesh)), are_holes ? 1 - count : count);
    // Lengths on the surface are at least those of the parameters: slivers are no wider than the tolerance.
    ASSERT_NEAR(plane_area(face, mesh), are_holes ? 12 - area : area, length_of_borders * tolerance + 1e-5);
  }
}

}}  // namespace tessera::test
