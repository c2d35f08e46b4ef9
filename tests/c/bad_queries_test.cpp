// Queries that cannot be served: each gets an error, and nothing is written.

#include "c/query_objects.h"

namespace tessera::test { namespace {

TEST(CBadQueries, HandlesOfOtherKindsAndNull) {
  const Handle<tsr_set> set = set_of(cube());
  const Handle<tsr_scene> scene = scene_of(set.get());
  tsr_point_scene* points = nullptr;
  tsr_solid* solid = nullptr;
  tsr_measures* measures = nullptr;
  tsr_sections* sections = nullptr;
  const double normal[3] = {0, 0, 1};
  void* const wrong = scene.get();
  expect_c_error(tsr_point_scene_new(&points, static_cast<tsr_set*>(wrong), nullptr), TSR_INVALID_HANDLE,
                 "expected the handle of a set, found a scene");
  expect_c_error(tsr_point_scene_new(nullptr, set.get(), nullptr), TSR_INVALID_ARGUMENT, "scene is a null pointer");
  expect_c_error(tsr_solid_new(&solid, nullptr, nullptr), TSR_INVALID_HANDLE, "the handle of a scene is null");
  expect_c_error(tsr_solid_new(nullptr, scene.get(), nullptr), TSR_INVALID_ARGUMENT, "solid is a null pointer");
  expect_c_error(tsr_measures_new(&measures, static_cast<tsr_model*>(wrong), nullptr, nullptr), TSR_INVALID_HANDLE,
                 "expected the handle of a model");
  expect_c_error(tsr_sections_new(&sections, nullptr, normal, nullptr, 0, nullptr, nullptr), TSR_INVALID_HANDLE,
                 "null");
  expect_c_error(tsr_sections_new(&sections, set.get(), nullptr, normal, 1, nullptr, nullptr), TSR_INVALID_ARGUMENT,
                 "normal is a null pointer");
  expect_c_error(tsr_sections_new(&sections, set.get(), normal, nullptr, 1, nullptr, nullptr), TSR_INVALID_ARGUMENT,
                 "offsets is a null pointer");
  expect_c_error(tsr_point_scene_describe(static_cast<tsr_point_scene*>(wrong), nullptr), TSR_INVALID_HANDLE,
                 "expected the handle of a scene of points, found a scene");
  EXPECT_EQ(tsr_measures_fault(nullptr, 0, nullptr), nullptr);
  tsr_point_scene* const released = point_scene_of(set.get()).release();
  ASSERT_C(tsr_release(released));
  expect_c_error(tsr_point_scene_refit(released, nullptr), TSR_INVALID_HANDLE, "released");
  EXPECT_EQ(points, nullptr);
  EXPECT_EQ(solid, nullptr);
  EXPECT_EQ(measures, nullptr);
  EXPECT_EQ(sections, nullptr);
}

TEST(CBadQueries, PointsWithoutMemoryOrOfOtherCounts) {
  const Handle<tsr_point_scene> scene = point_scene_of(set_of(cube()).get());
  const PointMemory<double> memory(std::vector<Vec3>(3, Vec3{1, 1, 5}));
  const std::vector<double> reach(2, 9.0);
  NearestMemory<double> found(3);
  tsr_query_points points = memory.points();
  tsr_nearest_out nearest = found.out();
  const auto refused = [&](tsr_status code, const std::string& words) {
    expect_c_error(tsr_point_scene_nearest(scene.get(), &points, &nearest, nullptr), code, words);
    EXPECT_EQ(found.kind, std::vector<std::uint8_t>(3, 77));
    points = memory.points(), nearest = found.out();
  };
  points.struct_size = 8, refused(TSR_INVALID_ARGUMENT, "tsr_query_points: struct_size is 8");
  nearest.struct_size = 0, refused(TSR_INVALID_ARGUMENT, "tsr_nearest_out: struct_size is 0");
  points.is_double = 2, refused(TSR_INVALID_ARGUMENT, "tsr_query_points: is_double is 2");
  nearest.reserved = 1, refused(TSR_INVALID_ARGUMENT, "tsr_nearest_out: reserved is 1");
  points.patches = -1, refused(TSR_INVALID_ARGUMENT, "patches must be at least 0");
  points.patches = (1 << 20) + 1, refused(TSR_INVALID_ARGUMENT, "from 1 to 2^20");
  points.patches = 2, refused(TSR_BUFFER_TOO_SMALL, "");
  points.position.data = nullptr, refused(TSR_INVALID_ARGUMENT, "position is a null pointer");
  points.max_distance = in_of(reach, 1), refused(TSR_COUNT_MISMATCH, "max_distance");
  nearest.distance.count = 2, refused(TSR_BUFFER_TOO_SMALL, "distance");
  nearest.uv.count = 2, refused(TSR_BUFFER_TOO_SMALL, "");
  points.position.record = 12, refused(TSR_INVALID_ARGUMENT, "position: addresses must be multiples of 8");
  points.position.record = -24, refused(TSR_INVALID_ARGUMENT, "");
  nearest = sized<tsr_nearest_out>(), refused(TSR_INVALID_ARGUMENT, "no output");
  expect_c_error(tsr_point_scene_nearest(scene.get(), nullptr, &nearest, nullptr), TSR_INVALID_ARGUMENT, "points is");
  expect_c_error(tsr_point_scene_nearest(scene.get(), &points, nullptr, nullptr), TSR_INVALID_ARGUMENT, "nearest is");
  points.position.count = 0;
  EXPECT_C(tsr_point_scene_nearest(scene.get(), &points, &nearest, nullptr));
}

TEST(CBadQueries, LargestDistancesThatAreNone) {
  const Handle<tsr_point_scene> scene = point_scene_of(set_of(cube()).get());
  const PointMemory<double> memory(std::vector<Vec3>(4, Vec3{1, 1, 5}));
  const std::vector<double> reach{-1, not_a_number, 1, 4};
  NearestMemory<double> found(4);
  tsr_query_points points = memory.points();
  points.max_distance = in_of(reach, 1);
  const tsr_nearest_out nearest = found.out();
  ASSERT_C(tsr_point_scene_nearest(scene.get(), &points, &nearest, nullptr));
  EXPECT_EQ(found.kind, (std::vector<std::uint8_t>{TSR_NEAREST_INVALID_POINT, TSR_NEAREST_INVALID_POINT,
                                                   TSR_NEAREST_NONE, TSR_NEAREST_FOUND}));
  EXPECT_EQ(found.distance[2], infinity);
  EXPECT_EQ(found.distance[3], 3);
}

TEST(CBadQueries, SolidsAndTheirPoints) {
  const Handle<tsr_set> set = set_of(cube());
  tsr_scene_options editable;
  tsr_scene_defaults(&editable);
  editable.is_editable = 1;
  tsr_scene* made = nullptr;
  ASSERT_C(tsr_scene_new(&made, set.get(), &editable, nullptr));
  const Handle<tsr_scene> rays(made);
  const Handle<tsr_solid> solid = solid_of(made);
  const Handle<tsr_point_scene> scene = point_scene_of(set.get()), other = point_scene_of(set_of(cube()).get());
  const PointMemory<double> memory(std::vector<Vec3>(2, Vec3{1, 1, 5}));
  tsr_query_points points = memory.points();
  std::vector<std::uint8_t> side(2, 7);
  std::vector<double> distance(2, 7);
  tsr_sides_out sides = sized<tsr_sides_out>();
  tsr_out out = out_of(distance, 1);
  const auto refused = [&](tsr_status code, const std::string& words) {
    expect_c_error(tsr_solid_contains(solid.get(), &points, &sides, nullptr), code, words);
  };
  refused(TSR_INVALID_ARGUMENT, "neither side nor is_certified has memory");
  sides.side = out_of(side, 1), --sides.side.count;
  refused(TSR_BUFFER_TOO_SMALL, "side holds 1 records, there are 2");
  sides.side = out_of(side, 1), sides.side.record = -1;
  refused(TSR_INVALID_ARGUMENT, "side: the stride of records must be above 0");
  sides.side = out_of(side, 1), points.max_distance = points.position;
  refused(TSR_INVALID_ARGUMENT, "max_distance must be a null pointer");
  points = memory.points(), sides.struct_size = 3;
  refused(TSR_INVALID_ARGUMENT, "tsr_sides_out: struct_size is 3");
  expect_c_error(tsr_solid_contains(solid.get(), nullptr, &sides, nullptr), TSR_INVALID_ARGUMENT, "points is a null");
  expect_c_error(tsr_solid_contains(solid.get(), &points, nullptr, nullptr), TSR_INVALID_ARGUMENT, "sides is a null");
  expect_c_error(tsr_solid_distances(solid.get(), other.get(), &points, &out, nullptr), TSR_STALE, "different sets");
  expect_c_error(tsr_solid_distances(solid.get(), scene.get(), &points, nullptr, nullptr), TSR_INVALID_ARGUMENT,
                 "distances is a null");
  expect_c_error(tsr_solid_winding_numbers(solid.get(), &points, nullptr, nullptr), TSR_INVALID_ARGUMENT,
                 "numbers is a null");
  expect_c_error(tsr_solid_winding_numbers(solid.get(), nullptr, &out, nullptr), TSR_INVALID_ARGUMENT, "points is a");
  --out.count;
  expect_c_error(tsr_solid_winding_numbers(solid.get(), &points, &out, nullptr), TSR_BUFFER_TOO_SMALL,
                 "numbers holds 1");
  expect_c_error(tsr_solid_distances(solid.get(), scene.get(), &points, &out, nullptr), TSR_BUFFER_TOO_SMALL,
                 "distances holds 1");
  // After an edit the solid is stale, also when its scenes were refitted.
  const std::vector<BezierPatch> patches = cube();
  const std::uint32_t first = 0;
  ASSERT_C(tsr_set_edit(set.get(), &first, 1, &patches[0].points()[0].x, 4));
  sides = sized<tsr_sides_out>(), sides.side = out_of(side, 1), out = out_of(distance, 1);
  refused(TSR_STALE, "");
  expect_c_error(tsr_solid_distances(solid.get(), scene.get(), &points, &out, nullptr), TSR_STALE, "");
  ASSERT_C(tsr_scene_refit(made, nullptr));
  ASSERT_C(tsr_point_scene_refit(scene.get(), nullptr));
  refused(TSR_STALE, "");
  expect_c_error(tsr_solid_distances(solid.get(), scene.get(), &points, &out, nullptr), TSR_STALE, "");
  expect_c_error(tsr_solid_winding_numbers(solid.get(), &points, &out, nullptr), TSR_STALE, "");
  EXPECT_EQ(side, std::vector<std::uint8_t>(2, 7));
  EXPECT_C(tsr_solid_contains(solid_of(made).get(), &points, &sides, nullptr));
  EXPECT_EQ(side, std::vector<std::uint8_t>(2, TSR_SIDE_OUTSIDE));
  EXPECT_EQ(distance, std::vector<double>(2, 7));
}

TEST(CBadQueries, MeasuresThatWereNotAskedForOrCannotBe) {
  const Handle<tsr_model> model = model_of(cube());
  tsr_measure_options options;
  tsr_measures* made = nullptr;
  const auto refused = [&](auto change, const std::string& words) {
    tsr_measure_defaults(&options);
    change();
    expect_c_error(tsr_measures_new(&made, model.get(), &options, nullptr), TSR_INVALID_ARGUMENT, words);
    EXPECT_EQ(made, nullptr);
  };
  refused([&] { options.flags = 0; }, "flags is 0");
  refused([&] { options.flags = 64; }, "flags is 64");
  refused([&] { options.reserved = 1; }, "reserved is 1");
  refused([&] { options.accuracy = not_a_number; }, "accuracy");
  refused([&] { options.accuracy = 1; }, "accuracy");
  refused([&] { options.max_cells = 0; }, "cells");
  expect_c_error(tsr_measures_new(nullptr, model.get(), nullptr, nullptr), TSR_INVALID_ARGUMENT, "measures is a null");
  tsr_measure_defaults(&options);
  options.flags = TSR_MEASURE_BODIES;
  ASSERT_C(tsr_measures_new(&made, model.get(), &options, nullptr));
  const Handle<tsr_measures> measures(made);
  tsr_area area = sized<tsr_area>();
  tsr_box box = sized<tsr_box>();
  tsr_body body = sized<tsr_body>();
  expect_c_error(tsr_measures_area(made, -1, &area), TSR_INVALID_ARGUMENT, "lacks TSR_MEASURE_AREAS");
  expect_c_error(tsr_measures_box(made, &box), TSR_INVALID_ARGUMENT, "lacks TSR_MEASURE_BOX");
  expect_c_error(tsr_measures_body(made, -1, &body), TSR_INVALID_ARGUMENT, "no solid and no closed shell");
  expect_c_error(tsr_measures_body(made, 0, &body), TSR_INVALID_ARGUMENT, "body 0 is none", 0);
  expect_c_error(tsr_measures_body(made, -2, &body), TSR_INVALID_ARGUMENT, "body -2 is none", -2);
  const Handle<tsr_measures> all = measures_of(model.get());
  expect_c_error(tsr_measures_area(all.get(), 6, &area), TSR_INVALID_ARGUMENT, "surface 6 is none", 6);
  area.struct_size = 1;
  expect_c_error(tsr_measures_area(all.get(), 5, &area), TSR_INVALID_ARGUMENT, "tsr_area: struct_size is 1");
}

TEST(CBadQueries, SectionsByBadPlanesAndIntoShortMemory) {
  const Handle<tsr_set> set = set_of(cube());
  const double up[3] = {0, 0, 1}, none[3] = {0, 0, 0}, broken[3] = {0, 0, not_a_number};
  const std::vector<double> offsets{1, not_a_number};
  tsr_sections* made = nullptr;
  tsr_section_options options;
  const auto refused = [&](const double* normal, std::size_t count, const std::string& words, std::int64_t index = -1) {
    expect_c_error(tsr_sections_new(&made, set.get(), normal, offsets.data(), count, &options, nullptr),
                   TSR_INVALID_ARGUMENT, words, index);
    EXPECT_EQ(made, nullptr);
    tsr_section_defaults(&options);
  };
  tsr_section_defaults(&options);
  refused(none, 1, "normal"), refused(broken, 1, "normal"), refused(up, 2, "offset", 1);
  options.tolerance = not_a_number, refused(up, 1, "tolerance");
  options.tolerance = -1, refused(up, 1, "tolerance");
  options.contact = not_a_number, refused(up, 1, "contact");
  options.max_gap = not_a_number, refused(up, 1, "gap");
  options.limit = 3, refused(up, 1, "limit is 3, expected 0 to 2");
  options.max_points = 2, refused(up, 1, "points");
  options.struct_size = 9, refused(up, 1, "tsr_section_options: struct_size is 9");
  EXPECT_C(tsr_sections_new(&made, set.get(), up, nullptr, 0, nullptr, nullptr));
  EXPECT_C(tsr_release(made));
  const Handle<tsr_sections> sections = sections_of(set.get(), up, {1}, 1e-3);
  tsr_plane_section plane = sized<tsr_plane_section>();
  expect_c_error(tsr_sections_plane(sections.get(), 1, &plane), TSR_INVALID_ARGUMENT, "plane 1 is none, there are 1");
  tsr_sections_info info = sized<tsr_sections_info>();
  ASSERT_C(tsr_sections_describe(sections.get(), &info));
  std::vector<std::uint64_t> first(info.polylines, 9);
  std::vector<double> position(3 * info.points, 9.0), uv(2 * info.points - 1, 9.0);
  tsr_sections_out out = sized<tsr_sections_out>();
  out.first = out_of(first, 1);
  expect_c_error(tsr_sections_read(sections.get(), &out), TSR_BUFFER_TOO_SMALL, "first holds 1 records, there are 2");
  out.first = {}, out.position = out_of(position, 3), out.uv = out_of(uv, 2);
  expect_c_error(tsr_sections_read(sections.get(), &out), TSR_BUFFER_TOO_SMALL, "uv holds");
  EXPECT_EQ(position, std::vector<double>(3 * info.points, 9.0));
  expect_c_error(tsr_sections_read(sections.get(), nullptr), TSR_INVALID_ARGUMENT, "out is a null pointer");
}

TEST(CBadQueries, CancelledOnes) {
  const Handle<tsr_model> model = model_of(wavy_field(12, 12));
  const Handle<tsr_set> set = set_of(model.get());
  const std::uint8_t stop = 1;
  tsr_run run = sized<tsr_run>();
  run.cancel = &stop;
  const double up[3] = {0, 0, 1}, offset = 0.1;
  tsr_point_scene* points = nullptr;
  tsr_measures* measures = nullptr;
  tsr_sections* sections = nullptr;
  expect_c_error(tsr_point_scene_new(&points, set.get(), &run), TSR_CANCELLED, "cancelled");
  expect_c_error(tsr_measures_new(&measures, model.get(), nullptr, &run), TSR_CANCELLED, "cancelled");
  expect_c_error(tsr_sections_new(&sections, set.get(), up, &offset, 1, nullptr, &run), TSR_CANCELLED, "cancelled");
  double last = 0;
  run.cancel = nullptr, run.threads = 1, run.user = &last;
  run.progress = [](double share, void* user) {
    double& before = *static_cast<double*>(user);
    EXPECT_GE(share, before);
    EXPECT_LE(share, 1);
    before = share;
  };
  ASSERT_C(tsr_measures_new(&measures, model.get(), nullptr, &run));
  EXPECT_C(tsr_release(measures));
  EXPECT_GT(last, 0.6);
}

}}  // namespace tessera::test
