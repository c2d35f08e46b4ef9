// Nearest points of surfaces with closed formulas, what is flagged, edits, arrays, and wrong input.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

#include "support/random_patches.h"
#include "support/ray_classes.h"
#include "support/torus.h"
#include "tessera/model.h"
#include "tessera/nearest_points.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

PatchSet set_of(const std::vector<BezierPatch>& patches) { return value_of(PatchSet::make(patches)); }

/// A square in the plane z = height.
BezierPatch square(double height, double size = 1) {
  return polynomial(1, 1, {{0, 0, height}, {0, size, height}, {size, 0, height}, {size, size, height}});
}

TEST(Nearest, OfASphereAlongTheRadius) {
  const PatchSet set = set_of(sphere());
  const PointScene scene = value_of(PointScene::make(set));
  Random random(1);
  for (int k = 0; k < 2000; ++k) {
    const double radius = k % 2 == 0 ? uniform(random, 0.05, 4) : 1 + rays::power(random, 1e-15, 0.5);
    const Vec3 direction = rays::unit_vector(random), point = radius * direction;
    const NearestPoint found = scene.nearest(point);
    ASSERT_EQ(found.kind, NearestKind::found);
    EXPECT_TRUE(found.flags.certified);
    EXPECT_FALSE(found.flags.ambiguous || found.flags.border);
    EXPECT_NEAR(found.distance, std::abs(length(point) - 1), 2e-15 * (1 + radius));
    EXPECT_LE(length(found.position - normalized(point)), 1e-14 / std::min(radius, 1.0));
    EXPECT_NEAR(std::abs(dot(found.normal, direction)), 1, 1e-12);
  }
}

/// Distances in the half plane of an axis: (distance from the axis, height).
double segment_distance(double x0, double z0, double x1, double z1, double x, double z) {
  const double dx = x1 - x0, dz = z1 - z0;
  const double share = std::clamp(((x - x0) * dx + (z - z0) * dz) / (dx * dx + dz * dz), 0.0, 1.0);
  return std::hypot(x - x0 - share * dx, z - z0 - share * dz);
}

template <class Distance>
void expect_revolved(const BSplineSurface& surface, const Axis& axis, const Distance& expected) {
  Model model;
  model.surfaces.push_back({.name = std::string("revolved"), .surface = surface});
  const PatchSet set = value_of(make_patch_set(model));
  const PointScene scene = value_of(PointScene::make(set));
  const double size = set.box().diagonal();
  Random random(8);
  std::size_t certified = 0;
  constexpr std::size_t count = 2000;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 point = axis.origin + rays::power(random, 0.01, 20) * uniform_vector(random, -1, 1);
    const Vec3 from = point - axis.origin;
    const double height = dot(from, axis.direction), radius = length(from - height * axis.direction);
    const NearestPoint found = scene.nearest(point);
    ASSERT_EQ(found.kind, NearestKind::found);
    EXPECT_NEAR(found.distance, expected(radius, height), 1e-14 * (size + length(from)));
    certified += found.flags.certified;
  }
  EXPECT_GE(certified * 100, count * 97);  // beside the axis the surface is as far away all around
}

TEST(Nearest, OfSurfacesOfRevolution) {
  const Axis axis{.origin = {0.3, -0.2, 0.5}, .direction = normalized({0.2, -0.5, 1}), .zero = {1, 0, 0}};
  expect_revolved(value_of(make_nurbs_torus(axis, 1, 0.3)), axis,
                  [](double x, double z) { return std::abs(std::hypot(x - 1, z) - 0.3); });
  const Vec3 across = normalized(axis.zero - dot(axis.zero, axis.direction) * axis.direction);
  const auto place = [&](double x, double z) { return axis.origin + x * across + z * axis.direction; };
  for (const double top : {1.0, 0.25}) {  // a cylinder, a cone
    const Curve profile = value_of(Curve::bezier(std::vector<Vec3>{place(1, -1), place(top, 1)}));
    expect_revolved(value_of(make_surface_of_revolution(profile, axis)), axis,
                    [&](double x, double z) { return segment_distance(1, -1, top, 1, x, z); });
  }
}

/// All points of a circle of latitude are as far away, and none of them is the nearest. The limit of work ends some
/// proofs, but the nearest point is found before.
TEST(Nearest, OfASphereFromItsAxis) {
  const PatchSet set = set_of(sphere());
  const PointScene scene = value_of(PointScene::make(set));
  for (int k = 1; k < 500; ++k) {
    for (const double beside : {0.0, 1e-12, 1e-6, 1e-4}) {
      const double height = (k < 250 ? 1 : -1) * (0.02 + 0.97 * (k % 250) / 250);
      const NearestPoint found = scene.nearest({beside, 0.5 * beside, height});
      ASSERT_EQ(found.kind, NearestKind::found);
      EXPECT_NEAR(found.distance, 1 - std::hypot(beside, 0.5 * beside, height), 1e-13) << height;
      EXPECT_GT(found.position.z * height, 0.9 * std::abs(height)) << height;
    }
  }
}

TEST(Nearest, OfAPlaneStraightDownOrOnItsBorder) {
  const PatchSet set = set_of({square(0)});
  const PointScene scene = value_of(PointScene::make(set));
  Random random(2);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 point = uniform_vector(random, -1, 2);
    const Vec3 foot{std::clamp(point.x, 0.0, 1.0), std::clamp(point.y, 0.0, 1.0), 0};
    const NearestPoint found = scene.nearest(point);
    EXPECT_TRUE(found.flags.certified);
    EXPECT_LE(length(found.position - foot), 1e-15);
    EXPECT_NEAR(found.distance, length(point - foot), 1e-15);
    EXPECT_EQ(found.flags.border, point.x != foot.x || point.y != foot.y);
  }
}

TEST(Nearest, SeveralThatAreAsNearAreFlagged) {
  const PatchSet planes = set_of({square(0), square(1)});
  const PointScene between = value_of(PointScene::make(planes));
  const NearestPoint middle = between.nearest({0.3, 0.6, 0.5});
  EXPECT_TRUE(middle.flags.ambiguous && middle.flags.certified);
  EXPECT_EQ(middle.patch, 0u);
  EXPECT_FALSE(between.nearest({0.3, 0.6, 0.5001}).flags.ambiguous);
  EXPECT_EQ(between.nearest({0.3, 0.6, 0.5001}).patch, 1u);

  const PatchSet ball = set_of(sphere());
  const NearestPoint centre = value_of(PointScene::make(ball)).nearest({0, 0, 0});
  EXPECT_EQ(centre.kind, NearestKind::found);
  EXPECT_TRUE(centre.flags.ambiguous);
  EXPECT_NEAR(centre.distance, 1, 1e-15);
  EXPECT_TRUE(std::isfinite(centre.position.x + centre.normal.x + centre.u));
}

TEST(Nearest, BeyondTheLargestDistanceIsNone) {
  const PatchSet set = set_of({square(0)});
  const PointScene scene = value_of(PointScene::make(set));
  EXPECT_EQ(scene.nearest({0.5, 0.5, 0.2}, 0.1).kind, NearestKind::none);
  EXPECT_TRUE(scene.nearest({0.5, 0.5, 0.2}, 0.1).flags.certified);
  EXPECT_EQ(scene.nearest({0.5, 0.5, 0.2}, 0.3).kind, NearestKind::found);
  EXPECT_EQ(scene.nearest({0.5, 0.5, 0}, 0).kind, NearestKind::found);
}

TEST(Nearest, FarPointsKeepTheirDirection) {
  const PatchSet set = set_of(Torus(6).patches(false));
  const PointScene scene = value_of(PointScene::make(set));
  for (const double far : {1e3, 1e6, 1e12, 1e100}) {
    const NearestPoint found = scene.nearest({far, 0.5 * far, 0});
    EXPECT_EQ(found.kind, NearestKind::found);
    EXPECT_NEAR(found.distance / (far * std::sqrt(1.25)), 1, 2 / far + 1e-15);
    if (far < 1e7) {
      EXPECT_TRUE(found.flags.certified) << far;
    }
  }
}

TEST(Nearest, DegenerateSurfacesEnd) {
  const std::vector<Vec3> line = {{0, 0, 0}, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}};
  const PatchSet set = set_of({polynomial(1, 1, line), polynomial(1, 1, {{2, 2, 2}, {2, 2, 2}, {2, 2, 2}, {2, 2, 2}})});
  const PointScene scene = value_of(PointScene::make(set));
  const NearestPoint beside = scene.nearest({0.5, 0.5, 0.2});
  EXPECT_EQ(beside.kind, NearestKind::found);
  EXPECT_LE(length(beside.position - Vec3{0.4, 0.4, 0.4}), 1e-7);
  const NearestPoint at_point = scene.nearest({3, 3, 3});
  EXPECT_EQ(at_point.patch, 1u);
  EXPECT_NEAR(at_point.distance, std::sqrt(3.0), 1e-15);
  const PatchSet single = set_of({polynomial(1, 1, {{2, 2, 2}, {2, 2, 2}, {2, 2, 2}, {2, 2, 2}})});
  EXPECT_EQ(PointScene::make(single).status().code(), StatusCode::unsupported);
}

TEST(Nearest, WrongInput) {
  PatchSet set = set_of({square(0)});
  const PointScene scene = value_of(PointScene::make(set));
  for (const Vec3& wrong : {Vec3{nan, 0, 0}, Vec3{0, inf, 0}, Vec3{0, 0, -inf}})
    EXPECT_EQ(scene.nearest(wrong).kind, NearestKind::invalid_point);
  const std::vector<Vec3> points(3, {0.5, 0.5, 1});
  std::vector<NearestPoint> found(2);
  EXPECT_EQ(scene.nearest(points, found).code(), StatusCode::buffer_too_small);
  found.resize(3);
  for (const double wrong : {-1.0, nan})
    EXPECT_EQ(scene.nearest(points, found, wrong).code(), StatusCode::invalid_argument);
  EXPECT_TRUE(scene.nearest(std::span<const Vec3>(), found).ok());
  std::atomic<bool> cancel = true;
  EXPECT_EQ(scene.nearest(points, found, inf, {.cancel = &cancel}).code(), StatusCode::cancelled);
  EXPECT_EQ(PointScene::make(set, {.cancel = &cancel}).status().code(), StatusCode::cancelled);
  ASSERT_TRUE(set.set_control_points(0, square(1).points()).ok());
  EXPECT_EQ(scene.nearest(points, found).code(), StatusCode::stale);
  EXPECT_EQ(scene.nearest({0, 0, 0}).kind, NearestKind::invalid_point);
}

void expect_same(const NearestPoint& a, const NearestPoint& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.patch, b.patch);
  EXPECT_EQ(a.patch_u, b.patch_u);
  EXPECT_EQ(a.patch_v, b.patch_v);
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.flags.ambiguous, b.flags.ambiguous);
}

// Pieces are cut as before an edit, so that other ones may find the last digits.
TEST(Nearest, RefitFollowsEdits) {
  PatchSet set = set_of(wavy_field(6, 6));
  PointScene scene = value_of(PointScene::make(set));
  Random random(3);
  for (int edit = 0; edit < 5; ++edit) {
    for (int k = 0; k < 4; ++k) {
      const auto patch = static_cast<std::uint32_t>(random() % set.patch_count());
      std::vector<Vec3> points(set.patch(patch).points().begin(), set.patch(patch).points().end());
      for (Vec3& p : points) p += 0.3 * uniform_vector(random, -1, 1);
      ASSERT_TRUE(set.set_control_points(patch, points).ok());
    }
    ASSERT_TRUE(scene.refit().ok());
    EXPECT_EQ(scene.revision(), set.revision());
    const PointScene anew = value_of(PointScene::make(set));
    for (int k = 0; k < 300; ++k) {
      const Vec3 point = 3 * uniform_vector(random, -1, 3);
      const NearestPoint a = scene.nearest(point), b = anew.nearest(point);
      EXPECT_TRUE(a.flags.certified);
      EXPECT_NEAR(a.distance, b.distance, a.rounding);
    }
  }
}

TEST(Nearest, ArraysHaveTheNumbersOfSinglePoints) {
  const PatchSet set = set_of(Torus(5).patches(true));
  const PointScene scene = value_of(PointScene::make(set));
  Random random(4);
  constexpr std::size_t count = 700;
  std::vector<float> points;  // a number between the points
  for (std::size_t k = 0; k < 4 * count; ++k) points.push_back(static_cast<float>(uniform(random, -2, 2)));
  points[8] = static_cast<float>(nan);
  const float reach = 0.8f;
  std::vector<double> numbers(12 * count);
  std::vector<std::uint32_t> indices(2 * count);
  std::vector<NearestKind> kinds(count);
  std::vector<NearestFlags> flags(count);
  const std::span<double> memory(numbers);
  const auto column = [&](std::size_t k) { return View1<double>::interleaved(memory, 12, k); };
  const NearestViews<double> out{.kind = View1<NearestKind>::soa({kinds}),
                                 .patch = View1<std::uint32_t>::interleaved(std::span(indices), 2, 0),
                                 .surface = View1<std::uint32_t>::interleaved(std::span(indices), 2, 1),
                                 .u = column(0),
                                 .v = column(1),
                                 .patch_u = column(2),
                                 .patch_v = column(3),
                                 .distance = column(4),
                                 .position = View3<double>::interleaved(memory, 12, 5),
                                 .normal = View3<double>::interleaved(memory, 12, 8),
                                 .flags = View1<NearestFlags>::soa({flags})};
  View1<const float> reaches = View1<const float>::soa({std::span(&reach, 1)});
  reaches.stride = 0;
  const PointViews<float> in{View3<const float>::interleaved(std::span<const float>(points), 4, 0), reaches};
  ASSERT_TRUE(nearest(scene, in, out).ok());
  std::size_t none = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const NearestPoint one = scene.nearest({points[4 * k], points[4 * k + 1], points[4 * k + 2]}, double(reach));
    EXPECT_EQ(kinds[k], one.kind);
    const double* const row = &numbers[12 * k];
    EXPECT_EQ(row[4], one.distance);
    none += one.kind == NearestKind::none;
    EXPECT_EQ(indices[2 * k], one.kind == NearestKind::found ? one.patch : no_id);
    EXPECT_EQ(row[0], one.u);
    EXPECT_EQ(row[3], one.patch_v);
    EXPECT_EQ((Vec3{row[5], row[6], row[7]}), one.position);
    EXPECT_EQ((Vec3{row[8], row[9], row[10]}), one.normal);
    EXPECT_EQ(flags[k].certified, one.flags.certified);
  }
  EXPECT_EQ(kinds[2], NearestKind::invalid_point);
  EXPECT_GT(none, count / 10);
  EXPECT_LT(none, count * 9 / 10);
  EXPECT_EQ(nearest(scene, in, NearestViews<double>{}).code(), StatusCode::invalid_argument);
  NearestViews<double> wrong{.distance = View1<double>::soa({memory.first(count - 1)})};
  EXPECT_EQ(nearest(scene, in, wrong).code(), StatusCode::buffer_too_small);
  PointViews<float> few = in;
  few.max_distance.stride = 1;
  EXPECT_EQ(nearest(scene, few, out).code(), StatusCode::count_mismatch);
}

/// Whether some place of a point is at these parameters.
bool has_place(std::span<const NearestPoint> places, std::uint32_t patch, double u, double v) {
  return std::ranges::any_of(places, [&](const NearestPoint& one) {
    return one.patch == patch && std::abs(one.patch_u - u) < 1e-7 && std::abs(one.patch_v - v) < 1e-7;
  });
}

// Points of a surface go back to their parameters; those of a border to the parameters of both patches.
TEST(Nearest, PlacesOfPointsOnTheSurface) {
  for (const std::vector<BezierPatch>& patches : {Torus(6).patches(false), Torus(5).patches(true), closed_body()}) {
    const PatchSet set = set_of(patches);
    const PointScene scene = value_of(PointScene::make(set));
    Random random(6);
    std::vector<Vec3> points;
    std::vector<SeamPlace> from;
    for (int k = 0; k < 600; ++k) {
      SeamPlace place;
      place.patch = random() % patches.size();
      place.u = uniform(random, 0, 1), place.v = uniform(random, 0, 1);
      if (k % 3 == 0) place.u = static_cast<double>(random() % 2);
      if (k % 9 == 0) place.v = static_cast<double>(random() % 2);
      from.push_back(place);
      points.push_back(de_casteljau(patches[place.patch], place.u, place.v));
    }
    SurfacePlaces found;
    ASSERT_TRUE(scene.places(points, 1e-9, found).ok());
    ASSERT_EQ(found.first.size(), points.size() + 1);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto places = std::span(found.places).subspan(found.first[k], found.first[k + 1] - found.first[k]);
      EXPECT_TRUE(has_place(places, static_cast<std::uint32_t>(from[k].patch), from[k].u, from[k].v)) << k;
      EXPECT_EQ(places.size(), k % 9 == 0 ? places.size() : k % 3 == 0 ? 2u : 1u) << k;
      if (k % 9 == 0) {
        EXPECT_GE(places.size(), 3u) << k;
      }
      for (const NearestPoint& one : places) {
        EXPECT_TRUE(one.flags.certified);
        EXPECT_LE(one.distance, 1e-14);
      }
    }
  }
}

TEST(Nearest, PlacesAtAPoleAndOfTwoSheets) {
  const PatchSet ball = set_of(sphere());
  const PointScene scene = value_of(PointScene::make(ball));
  SurfacePlaces found;
  const std::vector<Vec3> points{{0, 0, 1}, {0, 0, 1.1}, {nan, 0, 0}};
  ASSERT_TRUE(scene.places(points, 1e-6, found).ok());
  EXPECT_EQ(found.first, (std::vector<std::size_t>{0, 4, 4, 4}));
  // A patch that folds onto itself has two places.
  const PatchSet folded =
      set_of({polynomial(2, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {0, 1, 0}})});
  ASSERT_TRUE(value_of(PointScene::make(folded)).places(std::vector<Vec3>{{0.3, 0.5, 0}}, 1e-9, found).ok());
  EXPECT_EQ(found.places.size(), 2u);
  for (const double wrong : {0.0, -1.0, nan, 1.0})
    EXPECT_EQ(scene.places(points, wrong, found).code(), StatusCode::invalid_argument);
  EXPECT_TRUE(found.first.empty());
}

// The order of work changes nothing.
TEST(Nearest, EqualBytesInAnyBatch) {
  const PatchSet set = set_of(closed_body());
  const PointScene scene = value_of(PointScene::make(set)), other = value_of(PointScene::make(set));
  Random random(5);
  std::vector<Vec3> points;
  for (int k = 0; k < 3000; ++k) points.push_back(2 * uniform_vector(random, -1, 1));
  std::vector<NearestPoint> all(points.size());
  ASSERT_TRUE(scene.nearest(points, all).ok());
  for (std::size_t k = 0; k < points.size(); k += 7) expect_same(all[k], other.nearest(points[k]));
}

}}  // namespace tessera::test
