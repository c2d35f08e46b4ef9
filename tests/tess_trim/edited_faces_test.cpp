// Random edits of sets with trimming loops and edges of shapes, and cut patches beside welded ones.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "support/random_patches.h"
#include "support/sampled_distance.h"
#include "tess_trim/closed_shape.h"
#include "tess_trim/trimmed_face.h"

namespace tessera::test { namespace {

Mesh written(const PatchSet& set, const Tessellation& plan) {
  Mesh mesh = value_of(plan.allocate());
  const Status status = plan.run(set, mesh.views());
  EXPECT_TRUE(status.ok()) << status.message();
  return mesh;
}

/// Expects points of the mesh within the bound, and the gap, of their patches.
void expect_within_bounds(const PatchSet& set, const Tessellation& plan, const Mesh& mesh, Random& random) {
  const SampledMesh sampled(mesh, set.patch_count(), false);
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    if (sampled.faces(k).empty()) continue;
    const double most = double(plan.bounds()[k]) + plan.gap() + 1e-7 * set.box().diagonal();
    for (int sample = 0; sample < 8; ++sample) {
      const auto& face = sampled.faces(k)[static_cast<std::size_t>(random() % sampled.faces(k).size())];
      double a = uniform(random, 0, 1), b = uniform(random, 0, 1);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const Vec3 p = a * face.corners[0] + b * face.corners[1] + (1 - a - b) * face.corners[2];
      EXPECT_LE(distance_to_patch(set.patch(k), p, most), most) << "patch " << k;
    }
  }
}

/// The vertices of a surface's patch where a parameter (0: u, 1: v) is `at`.
std::set<std::array<float, 3>> vertices_at(const Mesh& mesh, std::uint32_t patch, std::size_t parameter, float at) {
  std::set<std::array<float, 3>> on;
  for (std::size_t k = 0; k < mesh.indices.size(); ++k) {
    const std::size_t vertex = mesh.indices[k];
    if (mesh.patches[k / 3] != patch || mesh.parameters[2 * vertex + parameter] != at) continue;
    on.insert({mesh.positions[3 * vertex], mesh.positions[3 * vertex + 1], mesh.positions[3 * vertex + 2]});
  }
  return on;
}

/// A cut patch and a whole one have a border of the same bits, and the whole one is welded to a third, whose border
/// runs the other way and lies `apart`.
TEST(EditedFaces, CutPatchesFollowNeighboursThatAreWelded) {
  const double apart = 1e-3;
  for (const bool turned : {false, true}) {
    const auto curved = [](double y) { return 0.3 * y * (1 - y) * (1 + y); };
    std::vector<Vec3> cut, whole, third;
    for (int i = 0; i <= 3; ++i)
      for (int j = 0; j <= 3; ++j) {
        const double x = i / 3.0, y = j / 3.0, back = turned ? 1 - y : y;
        cut.push_back({x, y, x * curved(y)});
        whole.push_back({1 + x, y, (1 - x) * curved(y)});
        third.push_back({1 - apart, back, curved(back) + x});  // comes before the others in the order of points
      }
    const std::vector<double> knots{0, 0, 0, 0, 1, 1, 1, 1};
    Model model;
    model.surfaces.push_back(
        {.name = {},
         .surface = value_of(BSplineSurface::polynomial(3, knots, 3, knots, cut)),
         .trims = std::vector<TrimLoop>{space_polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
                                        circle_loop(0.4, 0.5, 0.2, true)}});
    model.surfaces.push_back({.name = {}, .surface = polynomial(3, 3, whole)});
    model.surfaces.push_back({.name = {}, .surface = polynomial(3, 3, third)});
    const PatchSet set = value_of(make_patch_set(model));
    const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = 0.02, .joining = {.weld = 2 * apart}}));
    EXPECT_EQ(plan.welded_borders(), 1u);
    const Mesh mesh = written(set, plan);
    const auto of_cut = vertices_at(mesh, 0, 0, 1);
    EXPECT_GE(of_cut.size(), 3u);
    EXPECT_EQ(of_cut, vertices_at(mesh, 1, 0, 0)) << turned;
    EXPECT_EQ(of_cut, vertices_at(mesh, 2, 0, 0)) << turned;
    EXPECT_GE(double(plan.bounds()[0]), apart);
    Random random(3);
    for (int k = 0; k < 20; ++k) expect_within_bounds(set, plan, mesh, random);
  }
}

Shape plate() { return joined(drilled_plate(), 1e-6); }

/// Updates of sets with loops and edges plan anew: a plan that divides as a new one is the new one.
template <class Make>
void follow_edits(const Make& make, std::uint64_t seed, int edits) {
  Random random(seed);
  PatchSet set = make();
  const double size = set.box().diagonal();
  TessellationOptions options{.tolerance = size * std::pow(10.0, uniform(random, -3, -1.5)), .spare = 0};
  options.joining.share_vertices = seed % 2;
  if (seed % 3 == 0) options.joining.crease_angle = 0.3;
  options.quads = seed % 5 == 0;
  if (seed % 4 == 3) options.precision = Precision::double_precision;
  auto made = Tessellation::make(set, options);
  if (!made) return;
  Mesh mesh = written(set, *made);
  for (int k = 0; k < edits; ++k) {
    const auto patch = static_cast<std::uint32_t>(random() % set.patch_count());
    std::vector<Vec3> points(set.patch(patch).points().begin(), set.patch(patch).points().end());
    const Vec3 by = size * std::pow(10.0, uniform(random, -6, -2)) * uniform_vector(random, -1, 1);
    points[static_cast<std::size_t>(random() % points.size())] += by;
    const auto change = made->update(set, PatchEdits{std::span(&patch, 1), points}, mesh.views());
    if (!change) return;  // no mesh keeps the tolerance
    const Mesh anew = written(set, *made);
    if (!change->topology) {
      EXPECT_EQ(mesh.positions, anew.positions);
      EXPECT_EQ(mesh.normals, anew.normals);
    }
    mesh = anew;
    expect_within_bounds(set, *made, mesh, random);
    const auto fresh = Tessellation::make(set, options);
    ASSERT_TRUE(fresh.ok()) << fresh.status().message();
    if (fresh->capacity().triangles != made->capacity().triangles) continue;  // it keeps segments as good as the best
    const Mesh other = written(set, *fresh);
    if (mesh.indices == other.indices) {
      EXPECT_EQ(mesh.positions, other.positions);
    }
  }
}

TEST(EditedFaces, UpdatesKeepBoundsAndAreLikeNewPlans) {
  const char* const wanted = std::getenv("TESSERA_EDITS");
  const std::uint64_t sets = wanted ? std::strtoull(wanted, nullptr, 10) / 8 : 12;
  const auto face = [] {
    return Face(wavy(), {space_polygon({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}}), circle_loop(1.7, 1.4, 0.6, true)})
        .set;
  };
  for (std::uint64_t seed = 1; seed <= sets; ++seed) {
    SCOPED_TRACE("set " + std::to_string(seed));
    if (seed % 2) follow_edits([] { return value_of(make_patch_set(plate())); }, seed, 8);
    follow_edits(face, seed, 8);
  }
}

}}  // namespace tessera::test
