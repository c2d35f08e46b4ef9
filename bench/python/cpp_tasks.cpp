// The tasks of bench/python/python_report.py in C++. The script loads this library beside the package, so that both run
// in turn in one process and write the same memory. A task returns 0, or prints a message and returns 1.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>

#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"
#include "tessera/io.h"
#include "tessera/model.h"
#include "tessera/ray_scene.h"
#include "tessera/tessellation.h"

namespace {

using namespace tessera;

struct Tasks {
  explicit Tasks(const Model& model)
      : set(test::value_of(make_patch_set(model))),
        points(test::value_of(make_patch_set(model, {.blocks = {.double_points = true}}))),
        map(test::value_of(SurfaceMap::make(points))),
        scene(test::value_of(RayScene::make(set))) {}

  PatchSet set, points;
  SurfaceMap map;
  RayScene scene;
};

int code_of(const Status& status) {
  if (status.ok()) return 0;
  std::fprintf(stderr, "tessera_python_tasks: %s\n", status.message().c_str());
  return 1;
}

template <int N, class T>
VectorView<T, N> view_of(T* memory, std::size_t count) {
  return VectorView<T, N>::interleaved(std::span<T>(memory, N * count));
}

}  // namespace

extern "C" {

[[gnu::visibility("default")]] Tasks* tasks_new(const char* path) {
  return std::make_unique<Tasks>(test::value_of(read_model(path))).release();
}

[[gnu::visibility("default")]] int tasks_mesh(const Tasks* tasks, std::size_t rate, std::size_t vertices,
                                              std::size_t triangles, float* position, float* normal, float* parameter,
                                              std::uint32_t* index, std::uint32_t* patch) {
  const int steps = static_cast<int>(rate);
  const auto plan = Tessellation::make(tasks->set, {.rates = UniformRates{steps, steps}});
  if (!plan) return code_of(plan.status());
  return code_of(plan->run(tasks->set, {.position = view_of<3>(position, vertices),
                                        .normal = view_of<3>(normal, vertices),
                                        .parameter = view_of<2>(parameter, vertices),
                                        .patch = {patch, triangles},
                                        .indices = {index, 3 * triangles}}));
}

[[gnu::visibility("default")]] int tasks_points(const Tasks* tasks, std::size_t count, const double* u, const double* v,
                                                double* position) {
  QuantityViews<double> views;
  views.position = view_of<3>(position, count);
  return code_of(evaluate(tasks->points, tasks->map, {{}, view_of<1>(u, count), view_of<1>(v, count)}, views));
}

[[gnu::visibility("default")]] int tasks_closest(const Tasks* tasks, std::size_t count, const double* origin,
                                                 const double* direction, double* t, double* position, double* normal) {
  HitViews<double> hits;
  hits.t = view_of<1>(t, count), hits.position = view_of<3>(position, count), hits.normal = view_of<3>(normal, count);
  return code_of(
      closest(tasks->scene,
              RayViews<double>{.origin = view_of<3>(origin, count), .direction = view_of<3>(direction, count)}, hits));
}

}  // extern "C"
