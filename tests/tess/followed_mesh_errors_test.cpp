// Meshes that cannot follow: bad edits, views of another topology, and edits that no mesh within the limits keeps.

#include <cmath>
#include <limits>

#include "support/synthetic_sets.h"
#include "tess/followed_mesh.h"

namespace tessera::test { namespace {

TEST(FollowedMesh, AnUpdateMakesUpForOneThatFailed) {
  TessellationOptions options{.tolerance = 0.003};
  options.max_triangles = good(Tessellation::make(set_of(wavy_field(6, 6)), options)).capacity().triangles + 20;
  Animated body(wavy_field(6, 6), options);
  const Mesh before = body.mesh;
  const Edits rough = moved(body.set, 1,
                            [](const Vec3&p) {
                              return Vec3{p.x, p.y, p.z * 9};
                            }),
              smooth = moved(body.set, 2,
                             [](const Vec3&p) {
                               return Vec3{p.x, p.y, p.z * 1.0001};
                             }),
              rest = moved(body.set, 1, [](const Vec3&p) {
                return Vec3{p.x, p.y, p.z * 1.0001};
              });
  for (const Edits& edits : {rough, smooth}) {  // half of the patches are still rough the second time
    const auto failed = body.plan.update(body.set, edits, body.mesh.views());
    EXPECT_EQ(failed.status().code(), StatusCode::invalid_argument);
    EXPECT_NE(failed.status().message().find("the limits are"), std::string::npos) << failed.status().message();
    EXPECT_EQ(body.mesh.positions, before.positions);
    EXPECT_EQ(body.plan.capacity().triangles, before.triangle_count());
  }
  body.run(rest);
  body.expect_as_anew();
  EXPECT_LE(body.plan.bound(), 0.003 * (1 + 1e-6));
}

TEST(FollowedMesh, BadEditsAreRefusedBeforeAnythingIsWritten) {
  for (const TessellationOptions& options :
       {TessellationOptions{.tolerance = 0.05}, TessellationOptions{.rates = UniformRates{3, 3}}}) {
    Animated body(mixed_patches(7, 40), options);
    const Mesh before = body.mesh;
    const auto refused = [&](const Edits& edits, StatusCode code, std::ptrdiff_t index) {
      const Status status = body.plan.update(body.set, edits, body.mesh.views()).status();
      EXPECT_EQ(status.code(), code) << status.message();
      EXPECT_EQ(status.index(), index);
      EXPECT_EQ(body.mesh.positions, before.positions);
      EXPECT_EQ(body.set.revision(), 0u);
    };
    const Edits fine = swollen(body.set, 3, 0.1);
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
      Edits edits = fine;
      edits.points.back().y = bad;
      refused(edits, StatusCode::non_finite, std::ptrdiff_t(edits.patch.size()) - 1);
    }
    Edits edits = fine;
    edits.patch[3] = 40;
    refused(edits, StatusCode::invalid_argument, 3);
    edits.patch[3] = edits.patch[1];
    refused(edits, StatusCode::invalid_argument, 3);
    edits = fine;
    edits.points.pop_back();
    refused(edits, StatusCode::count_mismatch, -1);
    const auto code_of = [&](PatchSet& set, const MeshViews& views) {
      return body.plan.update(set, fine, views).status().code();
    };
    MeshViews views = body.mesh.views();
    views.position.size -= 1;
    EXPECT_EQ(code_of(body.set, views), StatusCode::buffer_too_small);
    EXPECT_EQ(code_of(body.set, {}), StatusCode::invalid_argument);
    PatchSet other = set_of(wavy_field(2, 2));
    EXPECT_EQ(code_of(other, body.mesh.views()), StatusCode::stale);
    EXPECT_EQ(body.mesh.positions, before.positions);
    EXPECT_EQ(body.set.revision(), 0u);
    body.run(fine);
    EXPECT_FALSE(body.run({}).topology);
    EXPECT_EQ(body.set.revision(), 1u);
  }
}

TEST(FollowedMesh, ViewsOfAnotherTopologyAreRefused) {
  Animated body(wavy_field(4, 4), {.tolerance = 0.01});
  Mesh old = body.mesh;
  for (const double by : {4.0, 0.05}) {  // more vertices, then fewer
    ASSERT_TRUE(body.run(moved(body.set, 1, [by](const Vec3& p) { return Vec3{p.x, p.y, by * p.z}; })).topology);
    const Mesh before = old;
    const std::uint64_t revision = body.set.revision();
    const Edits edits = moved(body.set, 2, [](const Vec3& p) { return p; });
    const Status status = body.plan.update(body.set, edits, old.views()).status();
    EXPECT_EQ(status.code(), by > 1 ? StatusCode::buffer_too_small : StatusCode::count_mismatch) << status.message();
    EXPECT_EQ(old.positions, before.positions);
    EXPECT_EQ(body.set.revision(), revision);
    old = body.mesh;
  }
}

}}  // namespace tessera::test
