// Meshes that follow the control points of spline surfaces: the same bytes as a set and a mesh of the moved spline.

#include <algorithm>
#include <cmath>
#include <limits>

#include <oneapi/tbb/global_control.h>

#include "support/allocations.h"
#include "support/random_splines.h"
#include "tess/tessellate_support.h"
#include "tessera/model.h"

namespace tessera::test { namespace {

BSplineSurface with_points(const BSplineSurface& of, const std::vector<Vec3>& points) {
  if (of.is_rational())
    return good(BSplineSurface::rational(of.degree_u(), of.knots_u(), of.degree_v(), of.knots_v(), points, of.weights(),
                                         of.domain()));
  return good(
      BSplineSurface::polynomial(of.degree_u(), of.knots_u(), of.degree_v(), of.knots_v(), points, of.domain()));
}

/// A surface whose control points lie over a grid, with heights that vary.
BSplineSurface landscape(int degree_u, int degree_v, bool rational, std::uint64_t seed) {
  Random random(seed);
  const BSplineSurface made = random_surface(random, degree_u, degree_v, {.inner = 9}, {.inner = 7}, rational);
  std::vector<Vec3> points(made.points().begin(), made.points().end());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double x = double(k / made.count_v()), y = double(k % made.count_v());
    points[k] = {x, y, std::sin(x) + 0.5 * std::cos(2 * y) + uniform(random, 0, 0.1)};
  }
  return with_points(made, points);
}

/// A model of a spline, a patch, and another spline that is placed.
struct Followed {
  std::vector<BSplineSurface> splines;
  std::vector<Affine> placements{Affine{}, Affine::translated({0, 0, 9})};
  std::vector<std::vector<Vec3>> points;
  PatchSet set;
  Tessellation plan;
  Mesh mesh;

  Followed(std::vector<BSplineSurface> of, const TessellationOptions& options)
      : splines(std::move(of)), set(made()), plan(good(Tessellation::make(set, options))), mesh(mesh_of(set, plan)) {
    for (const BSplineSurface& spline : splines) points.emplace_back(spline.points().begin(), spline.points().end());
  }
  PatchSet made() const {
    Model model;
    Random random(3);
    for (std::size_t k = 0; k < splines.size(); ++k) {
      model.surfaces.push_back({.name = {}, .surface = splines[k], .placement = placements[k]});
      model.surfaces.push_back({.name = {}, .surface = random_polynomial(random, 3, 3)});
    }
    return good(make_patch_set(model, {.origin = Vec3{4, 4, 4}}));
  }
  SurfaceEdits edit(std::size_t k, std::span<const std::uint32_t> moved = {}) const {
    return {.spline = splines[k],
            .points = points[k],
            .moved = moved,
            .surface = static_cast<std::uint32_t>(2 * k),
            .placement = placements[k]};
  }
  /// Follows, and writes the mesh anew if it has another topology.
  bool follow(const std::vector<SurfaceEdits>& edits) {
    const MeshChange change = good(plan.update(set, edits, mesh.views()));
    if (change.topology) mesh = mesh_of(set, plan);
    return change.topology;
  }
  /// Expects the set and the mesh of the splines as they are now.
  void expect_as_anew() {
    for (std::size_t k = 0; k < splines.size(); ++k) splines[k] = with_points(splines[k], points[k]);
    const PatchSet anew = made();
    for (std::size_t k = 0; k < set.patch_count(); ++k)
      EXPECT_TRUE(std::ranges::equal(set.patch(k).points(), anew.patch(k).points())) << "patch " << k;
    EXPECT_EQ(mesh.positions, mesh_of(set, plan).positions);
    EXPECT_EQ(mesh.normals, mesh_of(set, plan).normals);
  }
};

std::vector<std::vector<BSplineSurface>> splines() {
  return {{landscape(3, 3, false, 1), landscape(2, 3, false, 2)},
          {landscape(3, 2, true, 3), landscape(1, 4, false, 4)},
          {landscape(5, 5, true, 5), landscape(7, 6, false, 6)}};
}

TEST(EditedSurfaces, TheSameBitsAsASetMadeAnew) {
  for (const std::size_t threads : {1u, 3u}) {
    const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    for (const auto& pair : splines()) {
      Followed body(pair, {.tolerance = 0.03});
      Random random(7);
      std::size_t changes = 0;
      for (int turn = 0; turn < 6; ++turn) {
        // All points of one, and some of both; knots change their places in memory with each new spline.
        for (Vec3& p : body.points[0]) p.z *= 1.001;
        changes += body.follow({body.edit(0)});
        body.expect_as_anew();
        std::vector<std::uint32_t> moved[2];
        std::vector<SurfaceEdits> edits;
        for (const std::size_t k : {1u, 0u}) {
          for (int n = 0; n < 1 + turn; ++n)
            moved[k].push_back(static_cast<std::uint32_t>(random() % body.points[k].size()));
          for (const std::uint32_t at : moved[k]) body.points[k][at].z += turn == 5 ? 1.0 : 1e-3;
          edits.push_back(body.edit(k, moved[k]));
        }
        changes += body.follow(edits);
        body.expect_as_anew();
      }
      EXPECT_GE(changes, 1u);
      EXPECT_LE(changes, 10u);
    }
  }
}

TEST(EditedSurfaces, PointsFollowEachOtherWithoutANewSpline) {
  Followed body(splines()[1], {.tolerance = 0.03});
  for (std::uint32_t k = 0; k < 40; ++k) {
    const std::vector<std::uint32_t> moved{k, k + 7};
    for (const std::uint32_t at : moved) body.points[0][at].z += 0.01;
    body.follow({body.edit(0, moved)});
  }
  body.expect_as_anew();
}

TEST(EditedSurfaces, ASetTakesThemWithoutAPlan) {
  Followed body(splines()[1], {.tolerance = 0.03});
  for (int turn = 1; turn <= 5; ++turn) {
    const std::vector<std::uint32_t> moved{3, 17};
    for (const std::uint32_t at : moved) body.points[0][at].z += 0.1;
    for (Vec3& p : body.points[1]) p.x *= 1.01;
    const std::vector<SurfaceEdits> edits{body.edit(0, moved), body.edit(1)};
    const Status status = set_control_points(body.set, edits);
    EXPECT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(body.set.revision(), static_cast<std::uint64_t>(turn));
    const MeshChange change = good(body.plan.update(body.set, body.mesh.views()));
    if (change.topology) body.mesh = mesh_of(body.set, body.plan);
    body.expect_as_anew();
  }
  std::vector<Vec3> wrong = body.points[1];
  wrong[0].y = std::numeric_limits<double>::quiet_NaN();
  const std::vector<SurfaceEdits> edits{body.edit(0), {.spline = body.splines[1], .points = wrong, .surface = 2}};
  const Status refused = set_control_points(body.set, edits);
  EXPECT_EQ(refused.code(), StatusCode::non_finite);
  EXPECT_EQ(refused.index(), 1);
  EXPECT_EQ(body.set.revision(), 5u);
  const std::vector<SurfaceEdits> unknown{{.spline = body.splines[0], .points = body.points[0], .surface = 7}};
  EXPECT_EQ(set_control_points(body.set, unknown).code(), StatusCode::invalid_argument);
}

TEST(EditedSurfaces, BadEditsAreRefusedBeforeAnythingIsWritten) {
  Followed body(splines()[0], {.tolerance = 0.03});
  const Mesh before = body.mesh;
  const auto refused = [&](StatusCode code, std::ptrdiff_t index, const std::vector<SurfaceEdits>& edits,
                           const std::string& message) {
    const Status status = body.plan.update(body.set, edits, body.mesh.views()).status();
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_EQ(status.index(), index) << status.message();
    EXPECT_NE(status.message().find(message), std::string::npos) << status.message();
    EXPECT_EQ(body.mesh.positions, before.positions);
    EXPECT_EQ(body.set.revision(), 0u);
  };
  const std::vector<std::uint32_t> far{0, 1000000};
  const std::vector<Vec3> sound = body.points[1], few(sound.begin() + 1, sound.end());
  std::vector<Vec3> bad = sound;
  bad[20].y = std::nan("");
  SurfaceEdits edit = body.edit(1);
  edit.points = few;
  refused(StatusCode::count_mismatch, 1, {body.edit(0), edit}, "control points, found");
  refused(StatusCode::invalid_argument, 1, {body.edit(0), body.edit(1, far)}, "no control point 1000000");
  refused(StatusCode::invalid_argument, 2, {body.edit(1), body.edit(0), body.edit(1)}, "has an edit already");
  edit = body.edit(1);
  edit.surface = 1;
  refused(StatusCode::invalid_argument, 0, {edit}, "not those of this spline");
  edit.surface = 7;
  refused(StatusCode::invalid_argument, 0, {edit}, "not those of this spline");
  edit = body.edit(1);
  edit.points = bad;
  refused(StatusCode::non_finite, 1, {body.edit(0), edit}, "is not finite");
  const std::vector<std::uint32_t> moved{3};
  body.points[1][3].z += 1e-3;  // after the refusal, all is computed anew
  body.follow({body.edit(1, moved)});
  body.expect_as_anew();
}

TEST(EditedSurfaces, NothingIsAllocatedAfterTheFirst) {
  for (const auto& pair : splines()) {
    Followed body(pair, {.tolerance = 0.03, .spare = 100});
    const std::vector<std::uint32_t> some{5, 17, 50};
    const std::vector<SurfaceEdits> all{body.edit(0), body.edit(1)}, few{body.edit(0, some), body.edit(1, some)};
    double by = 1e-7;
    const auto update = [&](const std::vector<SurfaceEdits>& edits) {
      by = -by;
      for (auto& points : body.points)
        for (const std::uint32_t at : some) points[at].z += by;
      const auto change = body.plan.update(body.set, edits, body.mesh.views());
      ASSERT_TRUE(change.ok() && !change->topology) << change.status().message();
    };
    for (int warm_up = 0; warm_up < 20; ++warm_up) update(warm_up % 2 == 0 ? all : few);
    const std::size_t before = allocation_count();
    EXPECT_GT(before, 0u);
    for (int k = 0; k < 5; ++k) {
      update(all);
      update(few);
    }
    EXPECT_EQ(allocation_count(), before);
    body.expect_as_anew();
  }
}

}}  // namespace tessera::test
