#pragma once
// Handles of the C interface that release themselves, and the surfaces that its tests use.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/tessera_c.h"

namespace tessera::test {

struct Release {
  void operator()(void* handle) const { EXPECT_EQ(tsr_release(handle), TSR_OK) << tsr_last_message(nullptr); }
};
template <class T>
using Handle = std::unique_ptr<T, Release>;

/// Expects success, with the message of the failure.
#define EXPECT_C(call) EXPECT_EQ(call, TSR_OK) << tsr_last_message(nullptr)
#define ASSERT_C(call) ASSERT_EQ(call, TSR_OK) << tsr_last_message(nullptr)

/// Expects that a call failed with this code and index, and that its message holds these words.
inline void expect_c_error(tsr_status found, tsr_status code, const std::string& words, std::int64_t index = -1) {
  std::int64_t of = 0;
  const std::string message = tsr_last_message(&of);
  EXPECT_EQ(found, code) << message;
  if (found == TSR_OK) return;
  EXPECT_EQ(of, index) << message;
  EXPECT_NE(message.find(words), std::string::npos) << message;
}

/// A struct whose size is set.
template <class T>
T sized() {
  T made{};
  made.struct_size = sizeof made;
  return made;
}

template <class T>
tsr_out out_of(std::vector<T>& memory, std::size_t components) {
  return {memory.data(), memory.size() / components, 0, 0};
}
template <class T>
tsr_in in_of(const std::vector<T>& memory, std::size_t components) {
  return {memory.data(), memory.size() / components, 0, 0};
}

inline tsr_bspline bspline_of(const BezierPatch& patch) {
  tsr_bspline made = sized<tsr_bspline>();
  made.degree_u = patch.degree_u(), made.degree_v = patch.degree_v();
  made.count_u = static_cast<std::size_t>(made.degree_u) + 1,
  made.count_v = static_cast<std::size_t>(made.degree_v) + 1;
  made.points = &patch.points()[0].x;
  made.weights = patch.is_rational() ? patch.weights().data() : nullptr;
  return made;
}

inline Handle<tsr_model> model_of(const std::vector<BezierPatch>& patches) {
  std::vector<tsr_bspline> surfaces;
  for (const BezierPatch& patch : patches) surfaces.push_back(bspline_of(patch));
  tsr_model* model = nullptr;
  EXPECT_C(tsr_model_new(&model, surfaces.data(), surfaces.size()));
  return Handle<tsr_model>(model);
}

inline Handle<tsr_set> set_of(const tsr_model* model, std::uint32_t flags = 0, std::int64_t shape = -1) {
  tsr_set_options options;
  tsr_set_defaults(&options);
  options.flags = flags, options.shape = shape;
  tsr_set* set = nullptr;
  EXPECT_C(tsr_set_new(&set, model, &options, nullptr));
  return Handle<tsr_set>(set);
}
inline Handle<tsr_set> set_of(const std::vector<BezierPatch>& patches, std::uint32_t flags = 0) {
  return set_of(model_of(patches).get(), flags);
}

inline Handle<tsr_plan> plan_of(const tsr_set* set, double tolerance, std::uint32_t flags = 0) {
  tsr_plan_options options;
  tsr_plan_defaults(&options);
  options.tolerance = tolerance, options.flags = flags;
  tsr_plan* plan = nullptr;
  EXPECT_C(tsr_plan_new(&plan, set, &options, nullptr));
  return Handle<tsr_plan>(plan);
}

inline Handle<tsr_scene> scene_of(const tsr_set* set) {
  tsr_scene* scene = nullptr;
  EXPECT_C(tsr_scene_new(&scene, set, nullptr, nullptr));
  return Handle<tsr_scene>(scene);
}

/// A mesh's memory, and the struct that shows it.
struct MeshMemory {
  explicit MeshMemory(const tsr_plan* plan) {
    tsr_plan_info info = sized<tsr_plan_info>();
    EXPECT_C(tsr_plan_describe(plan, &info));
    positions.resize(3 * info.vertices), parameters.resize(2 * info.vertices);
    if (info.has_normals) normals.resize(3 * info.vertices);
    triangles.resize(3 * info.triangles), patches.resize(info.triangles);
    quads.resize(4 * info.quads), quad_patches.resize(info.quads);
  }
  tsr_mesh mesh() {
    tsr_mesh made = sized<tsr_mesh>();
    made.position = out_of(positions, 3), made.parameter = out_of(parameters, 2);
    if (!normals.empty()) made.normal = out_of(normals, 3);
    made.triangles = triangles.data(), made.triangle_patches = patches.data();
    made.triangle_count = patches.size();
    if (!quads.empty()) made.quads = quads.data(), made.quad_patches = quad_patches.data();
    made.quad_count = quad_patches.size();
    return made;
  }
  std::vector<float> positions, normals, parameters;
  std::vector<std::uint32_t> triangles, patches, quads, quad_patches;
};

}  // namespace tessera::test
