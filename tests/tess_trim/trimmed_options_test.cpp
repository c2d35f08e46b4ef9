// Meshes of trimmed faces: loops that cross, tolerances of every kind, threads, and bad input.

#include <tbb/global_control.h>

#include <map>
#include <numbers>
#include <string>

#include "tess_trim/trimmed_face.h"
#include "tessera/tessellate.h"
#include "trim/trim_shapes.h"

namespace tessera::test { namespace {

// Inside is odd parity: a bow tie keeps both of its triangles, two discs that overlap lose what they share.
TEST(TrimmedFace, OfLoopsThatCrossKeepsWhatAnOddNumberEncloses) {
  Face bow(wavy(), {polygon({{0.1, 0.1}, {0.9, 0.9}, {0.9, 0.1}, {0.1, 0.9}})});
  const Mesh tie = bow.mesh(1e-2);
  EXPECT_NEAR(plane_area(bow, tie), 0.32, 1e-5);
  EXPECT_EQ(value_of(check(tie)).degenerate_triangles, 0u);
  Face discs(plane(), {circle({1.5, 1.5}, 1), circle({2.5, 1.5}, 1)});
  const Mesh rest = discs.mesh(1e-4);
  const double shared = 2 * std::numbers::pi / 3 - std::sqrt(0.75);
  EXPECT_NEAR(plane_area(discs, rest), 2 * std::numbers::pi - 2 * shared, 3e-3);
  EXPECT_LE(discs.bound, 1e-4);
}

TEST(TrimmedFace, KeepsAnglesAndPixels) {
  const std::vector<TrimLoop> loops{circle({1.9, 1.4}, 1.15, true)};
  Face face(wavy(), loops);
  for (const double angle : {0.5, 0.1}) {
    const Tessellation plan = value_of(Tessellation::make(face.set, {.angle = angle}));
    EXPECT_LE(plan.angle(), angle);
    EXPECT_EQ(plan.patches_without_angle(), 0u);
    Mesh mesh = value_of(plan.allocate());
    ASSERT_TRUE(plan.run(face.set, mesh.views()).ok());
    // The rim turns by no more than about the angle from one edge to the next: a circle of at least this many edges.
    const MeshReport report = value_of(check(mesh));
    EXPECT_GT(static_cast<double>(report.open_edges), 2 * std::numbers::pi / angle);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const auto normal = [&](std::size_t c) {
        const float* n = &mesh.normals[3 * std::size_t{mesh.indices[3 * t + c]}];
        return Vec3{double(n[0]), double(n[1]), double(n[2])};
      };
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_LE(length(normal(c) - normal((c + 1) % 3)), 2 * std::sin(angle / 2) + 1e-5);
    }
  }
  const View view{.eye = {2, -8, 6}, .target = {2, 2, 0}, .width = 640, .height = 480};
  for (const double pixels : {2.0, 0.3}) {
    const Tessellation plan = value_of(Tessellation::make(face.set, {.pixels = PixelTolerance{pixels, view}}));
    EXPECT_LE(plan.pixels(), pixels);
    EXPECT_GT(plan.pixels(), 0.0);
  }
}

TEST(TrimmedFace, KeepsBudgetsAndNamesItsParts) {
  Face face(wavy(), {circle({1.9, 1.4}, 1.15, true)});
  for (const std::uint64_t budget : {300, 3000}) {
    const Tessellation plan = value_of(Tessellation::make(face.set, {.budget = budget}));
    EXPECT_LE(plan.capacity().triangles, budget);
    EXPECT_GT(plan.capacity().triangles, budget / 2);
    EXPECT_LE(plan.bound(), plan.tolerance());
  }
  const Mesh mesh = face.mesh(1e-2);
  const auto parts = value_of(parts_by_surface(mesh, face.set, face.model));
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].name, "face");
}

TEST(TrimmedFace, HasQuadsWhereCellsAreWhole) {
  Face face(wavy(), {polygon({{0.3, 0.2}, {3.7, 0.4}, {3.5, 2.8}, {0.5, 2.6}})});
  const Mesh plain = face.mesh({.tolerance = 1e-4});
  const Mesh mesh = face.mesh({.tolerance = 1e-4, .quads = true});
  const std::size_t cuts = face.set.cut_count();
  ASSERT_EQ(cuts, face.set.patch_count() - 2);  // of 4 x 3 patches, 2 are whole
  EXPECT_GT(mesh.quad_count(), mesh.triangle_count());
  EXPECT_EQ(mesh.triangle_count() + 2 * mesh.quad_count(), plain.triangle_count());
  for (std::size_t q = 0; q < mesh.quad_count(); ++q) {
    const auto at = [&](std::size_t corner) { return &mesh.parameters[2 * std::size_t{mesh.quads[4 * q + corner]}]; };
    for (std::size_t axis : {0u, 1u}) {  // opposite sides of a box
      const bool first = at(0)[axis] == at(1)[axis] && at(2)[axis] == at(3)[axis];
      ASSERT_TRUE(first || (at(1)[axis] == at(2)[axis] && at(3)[axis] == at(0)[axis])) << q;
    }
  }
  const Mesh split = value_of(split_quads(mesh));
  EXPECT_NEAR(plane_area(face, split), plane_area(face, plain), 1e-9);
  EXPECT_EQ(value_of(check(mesh)).open_edges, value_of(check(plain)).open_edges);
}

TEST(TrimmedFace, HasDoublePositionsAndJoinedNormals) {
  Face face(wavy(), {circle({0.5, 0.5}, 0.3, true)});
  const Mesh exact = face.mesh({.tolerance = 1e-4, .precision = Precision::double_precision});
  ASSERT_EQ(exact.model_positions.size(), exact.positions.size());
  for (std::size_t k = 0; k < exact.positions.size(); ++k) {
    const Vec3 origin = exact.origin;
    const double shift = k % 3 == 0 ? origin.x : k % 3 == 1 ? origin.y : origin.z;
    ASSERT_NEAR(exact.model_positions[k], double(exact.positions[k]) + shift, 1e-6);
  }
  // Vertices at one place have one normal, as the surface is smooth.
  const Mesh smooth = face.mesh({.tolerance = 1e-3, .joining = {.crease_angle = 0.1}});
  std::map<std::array<float, 3>, std::array<float, 3>> normals;
  for (std::size_t k = 0; k < smooth.vertex_count(); ++k) {
    const auto triple = [&](const std::vector<float>& of) {
      return std::array{of[3 * k], of[3 * k + 1], of[3 * k + 2]};
    };
    const auto [at, is_new] = normals.emplace(triple(smooth.positions), triple(smooth.normals));
    ASSERT_TRUE(is_new || at->second == triple(smooth.normals)) << k;
  }
}

TEST(TrimmedFace, IsTheSameForAnyNumberOfThreads) {
  const std::vector<TrimLoop> loops{circle({1.9, 1.4}, 1.15, true), circle({3.3, 0.4}, 0.2, true)};
  Face face(wavy(), loops);
  const Mesh many = face.mesh(1e-3);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Mesh alone = Face(wavy(), loops).mesh(1e-3);
  EXPECT_EQ(many.positions, alone.positions);
  EXPECT_EQ(many.indices, alone.indices);
}

TEST(TrimmedFace, OfBadInputIsRefused) {
  Face face(wavy(), {circle({1.9, 1.4}, 1.15, true)});
  for (const double tolerance : {0.0, -1.0, std::nan(""), 1e-12})
    EXPECT_EQ(Tessellation::make(face.set, {.tolerance = tolerance}).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(Tessellation::make(face.set, {.rates = UniformRates{4, 4}}).status().code(), StatusCode::unsupported);
  Tessellation plan = value_of(Tessellation::make(face.set, {.tolerance = 0.1}));
  Mesh mesh = value_of(plan.allocate());
  EXPECT_FALSE(value_of(plan.update(face.set, PatchEdits{}, mesh.views())).topology);
  const PatchSet other = Face(wavy(), {circle({1.9, 1.4}, 1.14, true)}).set;
  EXPECT_EQ(plan.run(other, mesh.views()).code(), StatusCode::stale);
  // A hole as large as the domain leaves no patch.
  Model empty = face.model;
  empty.surfaces[0].trims = std::vector{circle({2, 1.5}, 50, true)};
  EXPECT_EQ(make_patch_set(empty).status().code(), StatusCode::invalid_argument);
}

// The tolerance that the message calls enough has a plan.
TEST(TrimmedFace, OfATooSmallToleranceNamesOneThatIsEnough) {
  Face face(plane(), {circle({1, 1}, 0.7, true)});
  const Status refused = Tessellation::make(face.set, {.tolerance = 1e-12}).status();
  ASSERT_EQ(refused.code(), StatusCode::invalid_argument);
  const std::string& said = refused.message();
  const std::size_t begin = said.rfind("; "), end = said.rfind(" is enough");
  ASSERT_LT(begin, end) << said;
  ASSERT_NE(end, std::string::npos) << said;
  const double enough = std::stod(said.substr(begin + 2));
  EXPECT_LT(enough, 1e-4) << said;
  const Result<Tessellation> plan = Tessellation::make(face.set, {.tolerance = enough});
  ASSERT_TRUE(plan.ok()) << said << "\n" << plan.status().message();
  EXPECT_LE(plan->bound(), enough);
}

// A loop that cannot be used costs its own face alone.
TEST(TrimmedFace, OfAnUnusableLoopIsWholeAndNamed) {
  Face face(wavy(), {});
  Model model{.name = {}, .surfaces = {face.model.surfaces[0], face.model.surfaces[0]}};
  model.surfaces[0].trims = std::vector{circle({1, 1}, 0.5, true)};
  model.surfaces[1].trims = std::vector{circle({1, 1}, 1e101, true)};
  const PatchSet set = value_of(make_patch_set(model));
  ASSERT_EQ(set.trim_faults().size(), 1u);
  EXPECT_EQ(set.trim_faults()[0].index(), 1);
  EXPECT_EQ(set.trim_faults()[0].message().rfind("surface 1 (face): loop 0 ", 0), 0u) << set.trim_faults()[0].message();
  EXPECT_EQ(set.patch_count(), 24u);
  EXPECT_EQ(tessellate(model, {.tolerance = 0.01}).status().message(), set.trim_faults()[0].message());
}

}}  // namespace tessera::test
