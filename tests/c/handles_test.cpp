// Handles: references, released ones, threads that share them, and objects that are in use.

#include <atomic>
#include <thread>

#include "c/c_objects.h"
#include "c/handle_bits.h"

namespace tessera::test { namespace {

TEST(CHandles, ObjectsKeepWhatTheyNeed) {
  Handle<tsr_model> model = model_of(wavy_field(2, 2));
  Handle<tsr_set> set = set_of(model.get());
  Handle<tsr_scene> scene = scene_of(set.get());
  Handle<tsr_plan> plan = plan_of(set.get(), 1e-2);
  model.reset(), set.reset();
  MeshMemory memory(plan.get());
  const tsr_mesh mesh = memory.mesh();
  EXPECT_C(tsr_plan_write(plan.get(), &mesh, nullptr));
  tsr_scene_info info = sized<tsr_scene_info>();
  EXPECT_C(tsr_scene_describe(scene.get(), &info));
  EXPECT_GT(info.memory_bytes, 0u);
}

TEST(CHandles, ReleasedOnesAreErrorsForEver) {
  tsr_model* const model = model_of(wavy_field(1, 1)).release();
  EXPECT_C(tsr_retain(model));
  EXPECT_C(tsr_release(model));
  EXPECT_C(tsr_release(model));
  tsr_model_info info = sized<tsr_model_info>();
  for (int k = 0; k < 3; ++k) {
    expect_c_error(tsr_release(model), TSR_INVALID_HANDLE, "released");
    expect_c_error(tsr_retain(model), TSR_INVALID_HANDLE, "released");
    expect_c_error(tsr_model_describe(model, &info), TSR_INVALID_HANDLE, "released");
    EXPECT_EQ(tsr_model_text(model, TSR_TEXT_UNIT, 0), nullptr);
    const Handle<tsr_model> another = model_of(wavy_field(1, 1));  // takes the place in the table
    EXPECT_NE(another.get(), model);
  }
}

/// Handles of both sizes of pointers, of which this machine has one.
template <class Word>
void expect_parts_of_handles() {
  using Bits = HandleBits<Word>;
  EXPECT_EQ(Bits::place_bits + Bits::round_bits, std::numeric_limits<Word>::digits);
  for (const std::uint32_t place : {1u, 77u, Bits::place_mask})
    for (const std::uint32_t round : {0u, 1u, Bits::round_mask}) {
      const Word handle = Bits::packed(place, round);
      EXPECT_NE(handle, 0u);
      EXPECT_EQ(Bits::place(handle), place);
      EXPECT_TRUE(Bits::is_of_round(handle, round));
      EXPECT_FALSE(Bits::is_of_round(handle, round + 1 - (round == Bits::round_mask ? 2 : 0)));
    }
}

TEST(CHandles, HoldPlaceAndRoundInPointersOfBothSizes) {
  expect_parts_of_handles<std::uint64_t>();
  expect_parts_of_handles<std::uint32_t>();
  EXPECT_EQ(HandleBits<std::uint32_t>::packed(5, 4097), HandleBits<std::uint32_t>::packed(5, 1));
  EXPECT_TRUE(HandleBits<std::uint32_t>::is_of_round(HandleBits<std::uint32_t>::packed(5, 1), 4097));
}

TEST(CHandles, NullAndOtherKindsAreErrors) {
  const Handle<tsr_model> model = model_of(wavy_field(1, 1));
  const Handle<tsr_set> set = set_of(model.get());
  tsr_set_info info = sized<tsr_set_info>();
  expect_c_error(tsr_set_describe(nullptr, &info), TSR_INVALID_HANDLE, "the handle of a set is null");
  expect_c_error(tsr_set_describe(reinterpret_cast<const tsr_set*>(model.get()), &info), TSR_INVALID_HANDLE,
                 "expected the handle of a set, found a model");
  int garbage = 0;
  expect_c_error(tsr_set_describe(reinterpret_cast<const tsr_set*>(&garbage), &info), TSR_INVALID_HANDLE, "is none");
  EXPECT_C(tsr_release(nullptr));
  expect_c_error(tsr_retain(nullptr), TSR_INVALID_HANDLE, "null");
}

TEST(CHandles, ManyThreadsRetainAndReleaseOne) {
  const Handle<tsr_set> set = set_of(wavy_field(1, 1));
  std::atomic<int> faults = 0;
  const auto work = [&] {
    for (int k = 0; k < 20'000; ++k) {
      tsr_set_info info = sized<tsr_set_info>();
      faults += tsr_retain(set.get()) != TSR_OK;
      faults += tsr_set_describe(set.get(), &info) != TSR_OK || info.patches != 1;
      faults += tsr_release(set.get()) != TSR_OK;
    }
  };
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(faults, 0);
}

TEST(CHandles, ReleaseDuringACallOfAnotherThread) {
  for (int round = 0; round < 50; ++round) {
    tsr_set* const set = set_of(wavy_field(4, 4)).release();
    std::atomic<bool> begun = false;
    std::thread caller([&] {
      tsr_set_info info = sized<tsr_set_info>();
      while (tsr_set_describe(set, &info) == TSR_OK) begun = true;
      EXPECT_EQ(info.patches, 16u);
    });
    while (!begun) std::this_thread::yield();
    EXPECT_C(tsr_release(set));
    caller.join();
  }
}

TEST(CHandles, AnEditNeedsTheSetAlone) {
  const std::vector<BezierPatch> patches = wavy_field(1, 1);
  const Handle<tsr_set> set = set_of(patches);
  struct Shared {
    tsr_set* set;
    const BezierPatch* patch;
    tsr_status edit = TSR_OK, read = TSR_OK;
  } shared{set.get(), &patches[0]};
  tsr_run run = sized<tsr_run>();
  run.user = &shared;
  run.progress = [](double, void* user) {
    Shared& of = *static_cast<Shared*>(user);
    const std::uint32_t patch = 0;
    of.edit = tsr_set_edit(of.set, &patch, 1, &of.patch->points()[0].x, 16);
    tsr_set_info info = sized<tsr_set_info>();
    of.read = tsr_set_describe(of.set, &info);
  };
  tsr_scene* scene = nullptr;
  ASSERT_C(tsr_scene_new(&scene, set.get(), nullptr, &run));
  EXPECT_C(tsr_release(scene));
  EXPECT_EQ(shared.edit, TSR_IN_USE);
  EXPECT_EQ(shared.read, TSR_OK);
}

TEST(CHandles, ErrorsBelongToTheirThread) {
  expect_c_error(tsr_model_read(nullptr, "a.json", nullptr), TSR_INVALID_ARGUMENT, "model is a null pointer");
  std::thread([] { EXPECT_STREQ(tsr_last_message(nullptr), ""); }).join();
  EXPECT_STREQ(tsr_last_message(nullptr), "model is a null pointer");
  EXPECT_STREQ(tsr_status_name(TSR_IN_USE), "in_use");
  EXPECT_STREQ(tsr_status_name(-1), "unknown");
  EXPECT_STREQ(tsr_status_name(17), "unknown");
}

}}  // namespace tessera::test
