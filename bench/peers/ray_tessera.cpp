#include "ray_tessera.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <limits>
#include <memory>

#include "peers/interleaved.h"
#include "support/synthetic_sets.h"

namespace tessera::bench {
namespace {

class Casting {
 public:
  Casting(const RayTask& task, const RaySceneOptions& options)
      : scene_(test::value_of(RayScene::make(task.set, options))), hits_(task.camera.rays()) {
    for (std::size_t k = 0; k < task.camera.rays(); ++k) rays_.push_back(task.camera.ray(k));
  }
  double run() {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    tbb::task_arena arena(1);
    Status status;
    const double seconds = arena.execute([&] { return seconds_of([&] { status = scene_.closest(rays_, hits_); }); });
    return status.ok() ? seconds : -1;
  }
  double t(std::size_t ray) const {
    return hits_[ray].kind == HitKind::hit ? hits_[ray].t : std::numeric_limits<double>::infinity();
  }

 private:
  RayScene scene_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
};

RayRun run_of(const RayTask& task, const char* way, const RaySceneOptions& options) {
  const auto casting = std::make_shared<Casting>(task, options);
  return {"Tessera " TESSERA_VERSION, way, 1, [=] { return casting->run(); },
          [=](std::size_t ray) { return casting->t(ray); }};
}

}  // namespace

std::vector<RayRun> tessera_ray_runs(const RayTask& task) {
  return {run_of(task, "exact", {.mode = RayMode::exact}),
          run_of(task, "grid, refined", {.mode = RayMode::grid, .rate = facets_per_side}),
          run_of(task, "grid, facets alone", {.mode = RayMode::grid, .rate = facets_per_side, .refine = false})};
}

}  // namespace tessera::bench
