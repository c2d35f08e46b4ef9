// The cost of the interface for C: equal work through C and through C++, in turn, in the same memory, best of several.
// Results are compared byte for byte before anything is printed.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string_view>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"
#include "tessera/ray_scene.h"
#include "tessera/tessellation.h"
#include "tessera/tessera_c.h"

namespace tessera::bench { namespace {

constexpr int rounds = 15;

void check(tsr_status status) {
  if (status == TSR_OK) return;
  std::fprintf(stderr, "tessera_c_report: %s\n", tsr_last_message(nullptr));
  std::exit(1);
}
void check(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "tessera_c_report: %s\n", status.message().c_str());
  std::exit(1);
}

template <class Call>
double seconds_of(Call&& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Times both in turn, and prints the best of each. `bytes`: what both write.
template <class InC, class InCpp>
void compare(const char* what, InC&& in_c, InCpp&& in_cpp, void* output, std::size_t bytes) {
  double best_c = 1e30, best_cpp = 1e30;
  std::vector<char> wanted(bytes);
  for (int round = 0; round < rounds; ++round) {
    best_cpp = std::min(best_cpp, seconds_of(in_cpp));
    std::memcpy(wanted.data(), output, bytes);
    std::memset(output, 0, bytes);
    best_c = std::min(best_c, seconds_of(in_c));
    if (std::memcmp(wanted.data(), output, bytes) == 0) continue;
    std::fprintf(stderr, "tessera_c_report: %s: C and C++ write other bytes\n", what);
    std::exit(1);
  }
  std::printf("%-32s %10.2f ms in C %10.2f ms in C++   ratio %.3f\n", what, 1e3 * best_c, 1e3 * best_cpp,
              best_c / best_cpp);
}

/// A set in C and in C++, of the same patches.
struct Sets {
  explicit Sets(int side) : cpp(test::value_of(PatchSet::make(patches_of(side), options()))) {
    const std::vector<BezierPatch> patches = patches_of(side);
    std::vector<tsr_bspline> surfaces;
    for (const BezierPatch& patch : patches) {
      tsr_bspline made{};
      made.struct_size = sizeof made, made.degree_u = made.degree_v = 3, made.count_u = made.count_v = 4;
      made.points = &patch.points()[0].x;
      surfaces.push_back(made);
    }
    tsr_model* model = nullptr;
    check(tsr_model_new(&model, surfaces.data(), surfaces.size()));
    tsr_set_options packing;
    tsr_set_defaults(&packing);
    packing.flags = TSR_SET_POINTS;
    check(tsr_set_new(&c, model, &packing, nullptr));
    check(tsr_release(model));
  }
  Sets(const Sets&) = delete;
  Sets& operator=(const Sets&) = delete;
  ~Sets() { tsr_release(c); }

  static std::vector<BezierPatch> patches_of(int side) { return test::wavy_field(side, side); }
  static PatchSetOptions options() { return {.blocks = {.double_points = true}}; }

  PatchSet cpp;
  tsr_set* c = nullptr;
};

void time_calls(const Sets& sets) {
  tsr_set_info info{};
  info.struct_size = sizeof info;
  tsr_patch_info patch{};
  patch.struct_size = sizeof patch;
  constexpr int calls = 1'000'000;
  double describe = 1e30, retain = 1e30;
  for (int round = 0; round < rounds; ++round) {
    describe = std::min(describe, seconds_of([&] {
                          for (int k = 0; k < calls; ++k) check(tsr_set_patch(sets.c, 0, &patch, nullptr, nullptr));
                        }));
    retain = std::min(retain, seconds_of([&] {
                        for (int k = 0; k < calls; ++k) check(tsr_retain(sets.c)), check(tsr_release(sets.c));
                      }));
  }
  std::printf("%-32s %10.1f ns\n", "a call: tsr_set_patch()", 1e9 * describe / calls);
  std::printf("%-32s %10.1f ns\n", "tsr_retain() and tsr_release()", 1e9 * retain / calls);
}

void time_mesh(const Sets& sets) {
  constexpr int rate = 16;
  const TessellationOptions options{.rates = UniformRates{rate, rate}};
  const Tessellation plan = test::value_of(Tessellation::make(sets.cpp, options));
  Mesh mesh = test::value_of(plan.allocate());
  tsr_plan_options in_c;
  tsr_plan_defaults(&in_c);
  in_c.rate_u = in_c.rate_v = rate;
  tsr_plan* of = nullptr;
  check(tsr_plan_new(&of, sets.c, &in_c, nullptr));
  tsr_mesh out{};
  out.struct_size = sizeof out;
  out.position = {mesh.positions.data(), mesh.vertex_count(), 0, 0};
  out.normal = {mesh.normals.data(), mesh.vertex_count(), 0, 0};
  out.triangles = mesh.indices.data(), out.triangle_count = mesh.triangle_count();
  MeshViews views = mesh.views();
  views.parameter = {}, views.patch = {};
  const std::string what = "mesh, " + std::to_string(mesh.triangle_count()) + " triangles";
  compare(
      what.c_str(), [&] { check(tsr_plan_write(of, &out, nullptr)); }, [&] { check(plan.run(sets.cpp, views)); },
      mesh.positions.data(), mesh.positions.size() * sizeof(float));
  check(tsr_release(of));
}

void time_points(const Sets& sets, std::size_t count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<std::uint32_t> surface(count);
  std::vector<double> u(count), v(count), position(3 * count);
  for (std::size_t k = 0; k < count; ++k) {
    surface[k] = static_cast<std::uint32_t>(random() % sets.cpp.patch_count());
    u[k] = unit(random), v[k] = unit(random);
  }
  const SurfaceMap map = test::value_of(SurfaceMap::make(sets.cpp));
  const SurfaceSamples samples{View1<const std::uint32_t>::interleaved(surface), View1<const double>::interleaved(u),
                               View1<const double>::interleaved(v)};
  QuantityViews<double> views;
  views.position = View3<double>::interleaved(position);
  const tsr_in surfaces{surface.data(), count, 0, 0}, at_u{u.data(), count, 0, 0}, at_v{v.data(), count, 0, 0};
  tsr_jets jets{};
  jets.struct_size = sizeof jets, jets.is_double = 1, jets.position = {position.data(), count, 0, 0};
  const std::string what = std::to_string(count) + " scattered points";
  compare(
      what.c_str(), [&] { check(tsr_set_evaluate(sets.c, &surfaces, &at_u, &at_v, &jets, nullptr)); },
      [&] { check(evaluate(sets.cpp, map, samples, views)); }, position.data(), position.size() * sizeof(double));
}

void time_rays(const Sets& sets, std::size_t count, float side) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(0, side), tilt(-0.5f, 0.5f);
  std::vector<float> origin, direction;
  for (std::size_t k = 0; k < count; ++k) {
    origin.insert(origin.end(), {place(random), place(random), 5.0f});
    direction.insert(direction.end(), {tilt(random), tilt(random), -1.0f});
  }
  std::vector<float> t(count);
  const RayScene scene = test::value_of(RayScene::make(sets.cpp));
  const RayViews<float> rays{.origin = View3<const float>::interleaved(origin),
                             .direction = View3<const float>::interleaved(direction)};
  HitViews<float> hits;
  hits.t = View1<float>::interleaved(t);
  tsr_scene* of = nullptr;
  check(tsr_scene_new(&of, sets.c, nullptr, nullptr));
  tsr_rays from{};
  from.struct_size = sizeof from;
  from.origin = {origin.data(), count, 0, 0}, from.direction = {direction.data(), count, 0, 0};
  tsr_hits_out to{};
  to.struct_size = sizeof to, to.t = {t.data(), count, 0, 0};
  const std::string what = std::to_string(count) + " rays";
  compare(
      what.c_str(), [&] { check(tsr_scene_closest(of, &from, &to, nullptr)); },
      [&] { check(closest(scene, rays, hits)); }, t.data(), t.size() * sizeof(float));
  check(tsr_release(of));
}

}}  // namespace tessera::bench

int main(int argc, char**) {
  if (argc > 1) {
    std::printf(
        "Usage: tessera_c_report\nTimes the same work through C and through C++; all threads of the machine.\n");
    return 2;
  }
  const tessera::bench::Sets sets(100);
  tessera::bench::time_calls(sets);
  tessera::bench::time_mesh(sets);
  tessera::bench::time_points(sets, 1'000'000);
  tessera::bench::time_rays(sets, 1'000'000, 100);
  return 0;
}
