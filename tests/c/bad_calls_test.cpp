// Calls that cannot be served: each gets an error, and nothing is written.

#include <atomic>

#include "c/c_objects.h"
#include "support/errors.h"

namespace tessera::test { namespace {

TEST(CBadCalls, StructsOfAnotherSize) {
  const Handle<tsr_set> set = set_of(wavy_field(1, 1));
  tsr_set_info info{};
  expect_c_error(tsr_set_describe(set.get(), &info), TSR_INVALID_ARGUMENT, "tsr_set_info: struct_size is 0, expected");
  info.struct_size = sizeof info + 8;
  expect_c_error(tsr_set_describe(set.get(), &info), TSR_INVALID_ARGUMENT, "tsr_set_info: struct_size is");
  EXPECT_EQ(info.patches, 0u);
  tsr_plan_options options{};
  tsr_plan* plan = nullptr;
  expect_c_error(tsr_plan_new(&plan, set.get(), &options, nullptr), TSR_INVALID_ARGUMENT, "tsr_plan_options");
  tsr_run run{};
  expect_c_error(tsr_plan_new(&plan, set.get(), nullptr, &run), TSR_INVALID_ARGUMENT, "tsr_run: struct_size");
}

TEST(CBadCalls, OptionsOutOfRange) {
  const Handle<tsr_model> model = model_of(wavy_field(1, 1));
  const Handle<tsr_set> set = set_of(model.get());
  tsr_plan* plan = nullptr;
  tsr_plan_options options;
  const auto refused = [&](auto change, const std::string& words) {
    tsr_plan_defaults(&options);
    options.tolerance = 1e-2;
    change();
    expect_c_error(tsr_plan_new(&plan, set.get(), &options, nullptr), TSR_INVALID_ARGUMENT, words);
    EXPECT_EQ(plan, nullptr);
  };
  refused([&] { options.tolerance = 0; }, "tolerance");
  refused([&] { options.tolerance = -1; }, "tolerance");
  refused([&] { options.tolerance = not_a_number; }, "tolerance");
  refused([&] { options.flags = 1u << 20; }, "flags");
  refused([&] { options.weld = not_a_number; }, "weld");
  refused([&] { options.crease_angle = 9; }, "crease");
  refused([&] { options.rate_u = 3; }, "rate");
  refused([&] { options.pixels = 1, options.width = -1; }, "-1 x 800 pixels");
  tsr_set_options packing;
  tsr_set* made = nullptr;
  tsr_set_defaults(&packing);
  packing.shape = 0;
  expect_c_error(tsr_set_new(&made, model.get(), &packing, nullptr), TSR_INVALID_ARGUMENT, "the model has 0 shapes");
  tsr_set_defaults(&packing);
  packing.flags = 64;
  expect_c_error(tsr_set_new(&made, model.get(), &packing, nullptr), TSR_INVALID_ARGUMENT, "flags");
  tsr_run run = sized<tsr_run>();
  run.threads = -2;
  expect_c_error(tsr_set_new(&made, model.get(), nullptr, &run), TSR_INVALID_ARGUMENT, "threads is -2");
  for (const std::int32_t threads : {TSR_MAX_THREADS + 1, 10'000'000, INT32_MAX}) {
    run.threads = threads;
    expect_c_error(tsr_set_new(&made, model.get(), nullptr, &run), TSR_INVALID_ARGUMENT,
                   "threads is " + std::to_string(threads) + ", expected 0 to 1024");
  }
  tsr_scene_options scene_options;
  tsr_scene_defaults(&scene_options);
  scene_options.pieces = 3;
  tsr_scene* scene = nullptr;
  expect_c_error(tsr_scene_new(&scene, set.get(), &scene_options, nullptr), TSR_INVALID_ARGUMENT, "3");
}

TEST(CBadCalls, MembersThatMeanNothingElse) {
  const Handle<tsr_model> model = model_of(wavy_field(1, 1));
  const Handle<tsr_set> set = set_of(model.get(), TSR_SET_POINTS | TSR_SET_DOUBLE);
  const Handle<tsr_scene> scene = scene_of(set.get());
  const auto refused = [](tsr_status found, const std::string& words) {
    expect_c_error(found, TSR_INVALID_ARGUMENT, words);
  };
  tsr_run run = sized<tsr_run>();
  run.reserved = 1;
  refused(tsr_scene_refit(scene.get(), &run), "tsr_run: reserved is 1, expected 0");
  tsr_set_options packing;
  tsr_set_defaults(&packing);
  packing.reserved = 4;
  tsr_set* made = nullptr;
  refused(tsr_set_new(&made, model.get(), &packing, nullptr), "tsr_set_options: reserved is 4");
  tsr_plan_options options;
  tsr_plan_defaults(&options);
  options.tolerance = 1, options.reserved = 1u << 31;
  tsr_plan* plan = nullptr;
  refused(tsr_plan_new(&plan, set.get(), &options, nullptr), "tsr_plan_options: reserved is 2147483648");
  tsr_scene_options casting;
  tsr_scene_defaults(&casting);
  casting.is_editable = 2;
  tsr_scene* cast = nullptr;
  refused(tsr_scene_new(&cast, set.get(), &casting, nullptr), "is_editable is 2, expected 0 or 1");
  const double half = 0.5;
  for (const auto& [is_double, reserved] : {std::pair(2, 0), std::pair(-1, 0), std::pair(1, 1)}) {
    const std::string words = reserved ? "reserved is 1" : "is_double is " + std::to_string(is_double);
    tsr_jets jets = sized<tsr_jets>();
    jets.is_double = is_double, jets.reserved = reserved;
    refused(tsr_set_grid(set.get(), &half, 1, &half, 1, &jets, nullptr), "tsr_jets: " + words);
    const tsr_in at{&half, 1, 0, 0};
    refused(tsr_set_evaluate(set.get(), nullptr, &at, &at, &jets, nullptr), "tsr_jets: " + words);
    const std::vector<double> three{0, 0, 1};
    tsr_rays rays = sized<tsr_rays>();
    tsr_hits_out hits = sized<tsr_hits_out>();
    rays.origin = rays.direction = in_of(three, 3);
    rays.is_double = is_double, rays.reserved = reserved;
    refused(tsr_scene_closest(scene.get(), &rays, &hits, nullptr), "tsr_rays: " + words);
    rays.is_double = 1, rays.reserved = 0;
    hits.is_double = is_double, hits.reserved = reserved;
    refused(tsr_scene_closest(scene.get(), &rays, &hits, nullptr), "tsr_hits_out: " + words);
  }
}

TEST(CBadCalls, ShortAndMisalignedMemory) {
  const Handle<tsr_plan> plan = plan_of(set_of(wavy_field(2, 2)).get(), 1e-2);
  MeshMemory memory(plan.get());
  const std::vector<float> before = memory.positions;
  tsr_mesh mesh = memory.mesh();
  const auto refused = [&](tsr_status code, const std::string& words) {
    expect_c_error(tsr_plan_write(plan.get(), &mesh, nullptr), code, words);
    EXPECT_EQ(memory.positions, before);
    mesh = memory.mesh();
  };
  --mesh.position.count;
  refused(TSR_BUFFER_TOO_SMALL, "");
  --mesh.triangle_count;
  refused(TSR_BUFFER_TOO_SMALL, "");
  mesh.position.data = nullptr;
  refused(TSR_INVALID_ARGUMENT, "position");
  mesh.triangles = nullptr;
  refused(TSR_INVALID_ARGUMENT, "triangles is a null pointer");
  mesh.position.data = reinterpret_cast<char*>(memory.positions.data()) + 1;
  refused(TSR_INVALID_ARGUMENT, "position: addresses must be multiples of 4");
  mesh.position.record = 13;
  refused(TSR_INVALID_ARGUMENT, "position: addresses must be multiples of 4");
  mesh.position.record = -12;
  refused(TSR_INVALID_ARGUMENT, "");
  mesh.triangle_count = SIZE_MAX;
  refused(TSR_INVALID_ARGUMENT, "more faces than memory holds");
  expect_c_error(tsr_plan_write(plan.get(), nullptr, nullptr), TSR_INVALID_ARGUMENT, "mesh is a null pointer");
}

TEST(CBadCalls, EditsOfOtherSizes) {
  const std::vector<BezierPatch> patches = wavy_field(2, 2);
  const Handle<tsr_set> set = set_of(patches);
  std::vector<Vec3> points(patches[0].points().begin(), patches[0].points().end());
  std::uint32_t patch = 0;
  expect_c_error(tsr_set_edit(set.get(), &patch, 1, &points[0].x, 15), TSR_COUNT_MISMATCH,
                 "16 control points, found 15");
  patch = 4;
  expect_c_error(tsr_set_edit(set.get(), &patch, 1, &points[0].x, 16), TSR_INVALID_ARGUMENT, "patch 4 is none", 0);
  patch = 0, points[3].z = infinity;
  expect_c_error(tsr_set_edit(set.get(), &patch, 1, &points[0].x, 16), TSR_NON_FINITE, "", 0);
  expect_c_error(tsr_set_edit(set.get(), nullptr, 1, &points[0].x, 16), TSR_INVALID_ARGUMENT, "patches is a null");
  EXPECT_C(tsr_set_edit(set.get(), nullptr, 0, nullptr, 0));
  tsr_set_info info = sized<tsr_set_info>();
  ASSERT_C(tsr_set_describe(set.get(), &info));
  EXPECT_EQ(info.revision, 0u);
}

TEST(CBadCalls, RaysWithoutMemoryOrOfOtherCounts) {
  const Handle<tsr_scene> scene = scene_of(set_of(wavy_field(1, 1)).get());
  const std::vector<double> origin(30, 1.0), direction(30, 1.0), far(9, 1.0);
  std::vector<double> t(10);
  tsr_rays rays = sized<tsr_rays>();
  rays.is_double = 1, rays.origin = in_of(origin, 3), rays.direction = in_of(direction, 3), rays.tfar = in_of(far, 1);
  tsr_hits_out hits = sized<tsr_hits_out>();
  hits.is_double = 1, hits.t = out_of(t, 1);
  tsr_hits* all = nullptr;
  expect_c_error(tsr_scene_closest(scene.get(), &rays, &hits, nullptr), TSR_COUNT_MISMATCH, "");
  expect_c_error(tsr_scene_all(&all, scene.get(), &rays, nullptr), TSR_COUNT_MISMATCH, "fewer records than direction");
  rays.tfar = {}, rays.origin.data = nullptr;
  expect_c_error(tsr_scene_closest(scene.get(), &rays, &hits, nullptr), TSR_INVALID_ARGUMENT,
                 "origin is a null pointer");
  rays.origin = in_of(origin, 3), hits.t.count = 9;
  expect_c_error(tsr_scene_closest(scene.get(), &rays, &hits, nullptr), TSR_BUFFER_TOO_SMALL, "");
  hits.t = {};
  expect_c_error(tsr_scene_closest(scene.get(), &rays, &hits, nullptr), TSR_INVALID_ARGUMENT, "");
  rays.direction.count = 0;
  EXPECT_C(tsr_scene_all(&all, scene.get(), &rays, nullptr));
  EXPECT_C(tsr_release(all));
}

TEST(CBadCalls, CancelledOnes) {
  const Handle<tsr_set> set = set_of(wavy_field(20, 20));
  const std::uint8_t stop = 1;
  tsr_run run = sized<tsr_run>();
  run.cancel = &stop;
  tsr_plan_options options;
  tsr_plan_defaults(&options);
  options.tolerance = 1e-4;
  tsr_plan* plan = nullptr;
  expect_c_error(tsr_plan_new(&plan, set.get(), &options, &run), TSR_CANCELLED, "cancelled");
  std::atomic<int> calls = 0;
  run.cancel = nullptr, run.threads = 2, run.user = &calls;
  run.progress = [](double, void* user) { ++*static_cast<std::atomic<int>*>(user); };
  ASSERT_C(tsr_plan_new(&plan, set.get(), &options, &run));
  EXPECT_GT(calls, 0);
  EXPECT_C(tsr_release(plan));
}

}}  // namespace tessera::test
