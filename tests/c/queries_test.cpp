// Nearest points, solids, measures and sections through C: those of C++ bit for bit, and bodies with known numbers.

#include <numbers>
#include <random>

#include "c/query_objects.h"

namespace tessera::test { namespace {

constexpr std::size_t point_count = 400;

/// Points about the field and above it; one is not finite.
std::vector<Vec3> points_at(int size) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-1, static_cast<float>(size) + 1), height(-3, 3);
  std::vector<Vec3> points(point_count);
  for (Vec3& point : points) point = {place(random), place(random), height(random)};
  points[7].y = not_a_number;
  return points;
}

template <class T>
void expect_nearest(const NearestMemory<T>& found, std::size_t k, const NearestPoint& wanted) {
  EXPECT_EQ(found.kind[k], static_cast<std::uint8_t>(wanted.kind));
  EXPECT_EQ(found.distance[k], static_cast<T>(wanted.distance));
  const int flags = wanted.flags.certified * TSR_NEAREST_CERTIFIED + wanted.flags.ambiguous * TSR_NEAREST_AMBIGUOUS +
                    wanted.flags.border * TSR_NEAREST_BORDER +
                    wanted.flags.degenerate_normal * TSR_NEAREST_DEGENERATE_NORMAL;
  EXPECT_EQ(found.flags[k], flags);
  if (wanted.kind != NearestKind::found) {
    EXPECT_EQ(found.patch[k], 0xffffffffu);
    return;
  }
  EXPECT_EQ(found.patch[k], wanted.patch);
  EXPECT_EQ(found.surface[k], wanted.surface);
  EXPECT_EQ(found.uv[2 * k], static_cast<T>(wanted.u));
  EXPECT_EQ(found.uv[2 * k + 1], static_cast<T>(wanted.v));
  EXPECT_EQ(found.patch_uv[2 * k + 1], static_cast<T>(wanted.patch_v));
  EXPECT_EQ(found.position[3 * k + 2], static_cast<T>(wanted.position.z));
  EXPECT_EQ(found.normal[3 * k], static_cast<T>(wanted.normal.x));
}

template <class P, class N>
void check_nearest() {
  constexpr double reach = 2.5;
  const std::vector<BezierPatch> patches = wavy_field(4, 4);
  const std::vector<Vec3> points = points_at(4);
  const PatchSet set = value_of(PatchSet::make(patches));
  const PointScene scene = value_of(PointScene::make(set));
  const Handle<tsr_point_scene> of = point_scene_of(set_of(patches).get());
  const PointMemory<P> memory(points);
  const P farthest = static_cast<P>(reach);
  tsr_query_points from = memory.points();
  from.max_distance = {&farthest, 1, 0, 0};
  NearestMemory<N> found(point_count);
  const tsr_nearest_out to = found.out();
  ASSERT_C(tsr_point_scene_nearest(of.get(), &from, &to, nullptr));
  std::size_t near = 0;
  for (std::size_t k = 0; k < point_count; ++k) {
    const NearestPoint wanted = scene.nearest(points[k], reach);
    expect_nearest(found, k, wanted);
    near += wanted.kind == NearestKind::found;
  }
  EXPECT_GT(near, point_count / 2);
  EXPECT_LT(near, point_count - 1);
  EXPECT_EQ(found.kind[7], TSR_NEAREST_INVALID_POINT);
}

TEST(CPoints, NearestPointsAreThoseOfCpp) {
  check_nearest<double, double>();
  check_nearest<float, double>();
  check_nearest<double, float>();
  check_nearest<float, float>();
}

TEST(CPoints, FlagsAreTheBitsOfCpp) {
  const std::pair<NearestFlags, int> flags[] = {{{.certified = true}, TSR_NEAREST_CERTIFIED},
                                                {{.ambiguous = true}, TSR_NEAREST_AMBIGUOUS},
                                                {{.border = true}, TSR_NEAREST_BORDER},
                                                {{.degenerate_normal = true}, TSR_NEAREST_DEGENERATE_NORMAL}};
  for (const auto& [flag, bit] : flags) {
    std::uint8_t bits = 0;
    std::memcpy(&bits, &flag, 1);
    EXPECT_EQ(bits & 15, bit);
  }
}

TEST(CPoints, EditsMakeScenesStaleUntilARefit) {
  const std::vector<BezierPatch> patches = wavy_field(2, 2);
  const Handle<tsr_set> set = set_of(patches);
  const Handle<tsr_point_scene> scene = point_scene_of(set.get());
  const PointMemory<double> memory({{0.5, 0.5, 9}});
  const tsr_query_points from = memory.points();
  NearestMemory<double> found(1);
  const tsr_nearest_out to = found.out();
  ASSERT_C(tsr_point_scene_nearest(scene.get(), &from, &to, nullptr));
  const double before = found.distance[0];
  const std::vector<BezierPatch> raised = placed({patches[0]}, 1, {0, 0, 3});
  const std::span<const Vec3> points = raised[0].points();
  const std::uint32_t first = 0;
  ASSERT_C(tsr_set_edit(set.get(), &first, 1, &points[0].x, points.size()));
  expect_c_error(tsr_point_scene_nearest(scene.get(), &from, &to, nullptr), TSR_STALE, "");
  ASSERT_C(tsr_point_scene_refit(scene.get(), nullptr));
  ASSERT_C(tsr_point_scene_nearest(scene.get(), &from, &to, nullptr));
  const PatchSet edited = value_of(PatchSet::make({{raised[0], patches[1], patches[2], patches[3]}}));
  EXPECT_LT(found.distance[0], before - 2);
  EXPECT_EQ(found.distance[0], value_of(PointScene::make(edited)).nearest({0.5, 0.5, 9}).distance);
  tsr_point_scene_info info = sized<tsr_point_scene_info>();
  ASSERT_C(tsr_point_scene_describe(scene.get(), &info));
  EXPECT_EQ(info.revision, 1u);
  EXPECT_GT(info.memory_bytes, 1000u);
}

TEST(CSolid, SidesAndDistancesOfACube) {
  const Handle<tsr_set> set = set_of(cube());
  const Handle<tsr_solid> solid = solid_of(scene_of(set.get()).get());
  const Handle<tsr_point_scene> scene = point_scene_of(set.get());
  tsr_solid_info info = sized<tsr_solid_info>();
  ASSERT_C(tsr_solid_describe(solid.get(), &info));
  EXPECT_TRUE(info.is_closed);
  EXPECT_EQ(info.open_borders, 0u);
  const PointMemory<float> memory({{1.0, 1.25, 0.5}, {2.5, 1, 1}, {1, 1, infinity}, {1, 1, -2}});
  const tsr_query_points from = memory.points();
  std::vector<std::uint8_t> side(4, 9), is_certified(4, 9);
  std::vector<double> distance(4);
  tsr_sides_out sides = sized<tsr_sides_out>();
  sides.side = out_of(side, 1), sides.is_certified = out_of(is_certified, 1);
  ASSERT_C(tsr_solid_contains(solid.get(), &from, &sides, nullptr));
  EXPECT_EQ(side,
            (std::vector<std::uint8_t>{TSR_SIDE_INSIDE, TSR_SIDE_OUTSIDE, TSR_SIDE_INVALID_POINT, TSR_SIDE_OUTSIDE}));
  EXPECT_EQ(is_certified, (std::vector<std::uint8_t>{1, 1, 0, 1}));
  const tsr_out out = out_of(distance, 1);
  ASSERT_C(tsr_solid_distances(solid.get(), scene.get(), &from, &out, nullptr));
  EXPECT_NEAR(distance[0], -0.5, 1e-14);
  EXPECT_NEAR(distance[1], 0.5, 1e-14);
  EXPECT_TRUE(std::isnan(distance[2]));
  EXPECT_NEAR(distance[3], 2, 1e-14);
}

TEST(CSolid, WindingNumbersOfACubeWithoutALid) {
  std::vector<BezierPatch> patches = cube();
  const Handle<tsr_set> closed = set_of(patches);
  patches.pop_back();
  const Handle<tsr_set> open = set_of(patches);
  const PointMemory<float> memory({{1, 1, 1}, {1, 1, infinity}, {5, 1, -3}});
  const tsr_query_points from = memory.points();
  std::vector<double> number(3);
  const tsr_out out = out_of(number, 1);
  ASSERT_C(tsr_solid_winding_numbers(solid_of(scene_of(closed.get()).get()).get(), &from, &out, nullptr));
  EXPECT_NEAR(number[0], 1, 1e-12);
  EXPECT_TRUE(std::isnan(number[1]));
  EXPECT_NEAR(number[2], 0, 1e-12);
  const Handle<tsr_solid> solid = solid_of(scene_of(open.get()).get());
  ASSERT_C(tsr_solid_winding_numbers(solid.get(), &from, &out, nullptr));
  EXPECT_NEAR(number[0], 5.0 / 6, 1e-8);
  EXPECT_TRUE(std::isnan(number[1]));
  std::vector<std::uint8_t> side(3), is_certified(3, 9);
  tsr_sides_out sides = sized<tsr_sides_out>();
  sides.side = out_of(side, 1), sides.is_certified = out_of(is_certified, 1);
  ASSERT_C(tsr_solid_contains(solid.get(), &from, &sides, nullptr));
  EXPECT_EQ(side, (std::vector<std::uint8_t>{TSR_SIDE_INSIDE, TSR_SIDE_INVALID_POINT, TSR_SIDE_OUTSIDE}));
  EXPECT_EQ(is_certified, std::vector<std::uint8_t>(3, 0));
}

TEST(CMeasures, OfACube) {
  const Handle<tsr_model> loose = model_of(cube());
  tsr_model* joined = nullptr;
  ASSERT_C(tsr_model_join(&joined, loose.get(), 0));
  const Handle<tsr_model> model(joined);
  const Handle<tsr_measures> measures = measures_of(model.get());
  tsr_measures_info info = sized<tsr_measures_info>();
  ASSERT_C(tsr_measures_describe(measures.get(), &info));
  EXPECT_EQ(info.surfaces, 6u);
  EXPECT_EQ(info.bodies, 1u);
  EXPECT_EQ(info.faults, 0u);
  EXPECT_EQ(tsr_measures_fault(measures.get(), 0, nullptr), nullptr);
  tsr_area area = sized<tsr_area>(), face = sized<tsr_area>();
  ASSERT_C(tsr_measures_area(measures.get(), -1, &area));
  ASSERT_C(tsr_measures_area(measures.get(), 5, &face));
  EXPECT_NEAR(area.area, 24, area.area_error);
  EXPECT_NEAR(face.area, 4, face.area_error);
  EXPECT_LT(area.area_error, 1e-8);
  EXPECT_TRUE(area.is_proven);
  EXPECT_NEAR(area.centroid[0], 1, area.centroid_error);
  for (const std::int64_t which : {-1, 0}) {
    tsr_body body = sized<tsr_body>();
    ASSERT_C(tsr_measures_body(measures.get(), which, &body));
    EXPECT_NEAR(body.volume, 8, body.volume_error);
    EXPECT_LT(body.volume_error, 1e-8);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(body.centroid[c], 1, body.centroid_error);
      EXPECT_NEAR(body.inertia[c], 16.0 / 3, body.inertia_error);
      EXPECT_NEAR(body.inertia[3 + c], 0, body.inertia_error);
      EXPECT_NEAR(body.moments[c], 16.0 / 3, body.moments_error);
    }
    EXPECT_TRUE(body.is_proven);
  }
  tsr_box box = sized<tsr_box>();
  ASSERT_C(tsr_measures_box(measures.get(), &box));
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(box.low[c], 0, box.low_error[c]);
    EXPECT_NEAR(box.high[c], 2, box.high_error[c]);
  }
}

/// All members of sections as arrays.
struct SectionMemory {
  explicit SectionMemory(const tsr_sections_info& info)
      : first(info.polylines + 1),
        is_closed(info.polylines),
        bridges_gap(info.points),
        length(info.polylines),
        position(3 * info.points),
        uv(2 * info.points),
        patch(info.points) {}
  tsr_sections_out out() {
    tsr_sections_out made = sized<tsr_sections_out>();
    made.first = out_of(first, 1), made.is_closed = out_of(is_closed, 1), made.length = out_of(length, 1);
    made.position = out_of(position, 3), made.uv = out_of(uv, 2), made.patch = out_of(patch, 1);
    made.bridges_gap = out_of(bridges_gap, 1);
    return made;
  }
  std::vector<std::uint64_t> first;
  std::vector<std::uint8_t> is_closed, bridges_gap;
  std::vector<double> length, position, uv;
  std::vector<std::uint32_t> patch;
};

TEST(CSections, AreThoseOfCpp) {
  const std::vector<BezierPatch> patches = sphere();
  const std::vector<double> offsets{-0.4, 0.25, 3};
  const double normal[3] = {1, 2, -0.5};
  const Handle<tsr_sections> sections = sections_of(set_of(patches).get(), normal, offsets, 1e-3);
  const PatchSet set = value_of(PatchSet::make(patches));
  const Sections wanted = value_of(make_sections(set, {1, 2, -0.5}, offsets, {.tolerance = 1e-3}));
  tsr_sections_info info = sized<tsr_sections_info>();
  ASSERT_C(tsr_sections_describe(sections.get(), &info));
  ASSERT_EQ(info.planes, 3u);
  ASSERT_EQ(info.polylines, wanted.polylines.size());
  ASSERT_EQ(info.points, wanted.points.size());
  EXPECT_EQ(info.tolerance, 1e-3);
  SectionMemory memory(info);
  const tsr_sections_out out = memory.out();
  ASSERT_C(tsr_sections_read(sections.get(), &out));
  EXPECT_EQ(memory.first.back(), wanted.points.size());
  for (std::size_t k = 0; k < wanted.polylines.size(); ++k) {
    EXPECT_EQ(memory.first[k], wanted.polylines[k].first);
    EXPECT_EQ(memory.first[k + 1] - memory.first[k], wanted.polylines[k].count);
    EXPECT_EQ(memory.is_closed[k], wanted.polylines[k].closed);
    EXPECT_EQ(memory.length[k], wanted.polylines[k].length);
  }
  for (std::size_t k = 0; k < wanted.points.size(); ++k) {
    EXPECT_EQ(memory.position[3 * k + 2], wanted.points[k].position.z);
    EXPECT_EQ(memory.uv[2 * k + 1], wanted.points[k].v);
    EXPECT_EQ(memory.patch[k], wanted.points[k].patch);
    EXPECT_EQ(memory.bridges_gap[k], wanted.points[k].bridges_gap);
  }
  for (std::size_t plane = 0; plane < offsets.size(); ++plane) {
    tsr_plane_section section = sized<tsr_plane_section>();
    ASSERT_C(tsr_sections_plane(sections.get(), plane, &section));
    EXPECT_EQ(section.offset, offsets[plane]);
    EXPECT_EQ(section.length, wanted.planes[plane].length);
    EXPECT_EQ(section.bound, wanted.planes[plane].bound);
    const double height = offsets[plane] / std::sqrt(5.25);
    const double circle = 2 * std::numbers::pi * std::sqrt(std::max(0.0, 1 - height * height));
    EXPECT_NEAR(section.length, circle, 0.01);
    EXPECT_EQ(section.polyline_count, circle > 0 ? 1u : 0u);
  }
}

TEST(CSections, OfACubeAlongItsFacesAndContacts) {
  const Handle<tsr_set> set = set_of(cube());
  const double normal[3] = {0, 0, 2};
  const Handle<tsr_sections> sections = sections_of(set.get(), normal, {0, 2}, 0);
  tsr_sections_info info = sized<tsr_sections_info>();
  ASSERT_C(tsr_sections_describe(sections.get(), &info));
  EXPECT_EQ(info.coplanar, 1u);
  std::vector<std::uint32_t> coplanar(1);
  tsr_sections_out out = sized<tsr_sections_out>();
  out.coplanar = out_of(coplanar, 1);
  ASSERT_C(tsr_sections_read(sections.get(), &out));
  EXPECT_EQ(coplanar[0], 4u);
  for (std::size_t plane = 0; plane < 2; ++plane) {
    tsr_plane_section section = sized<tsr_plane_section>();
    ASSERT_C(tsr_sections_plane(sections.get(), plane, &section));
    EXPECT_NEAR(section.length, 8, 1e-9);
    EXPECT_EQ(section.open_count, 0u);
    EXPECT_EQ(section.limit, plane == 0 ? TSR_LIMIT_ABOVE : TSR_LIMIT_BELOW);
  }
}

}}  // namespace tessera::test
