// The rays by SISL's s1856, in a process of its own (sisl_rays.cpp), which measures its own time. It casts one ray in
// many.

#include <memory>

#include "peers/ray_task.h"
#include "peers/sisl_answers.h"

namespace tessera::bench { namespace {

constexpr std::size_t step = 509;  // a prime, to spread rays over the picture

std::shared_ptr<SislAnswers> start(const RayTask& task) {
  std::vector<double> numbers;
  for (std::size_t k = 0; k < task.camera.rays(); k += step) {
    const Ray ray = task.camera.ray(k);
    const Vec3 &o = ray.origin, &d = ray.direction;
    numbers.insert(numbers.end(), {o.x, o.y, o.z, d.x, d.y, d.z});
  }
  const std::size_t rays = numbers.size() / 6;
  const SislRayTask header{task.side(), static_cast<std::int32_t>(rays), 1e-9 * task.size};
  return std::make_shared<SislAnswers>(TESSERA_SISL_RAYS, header, task.net, numbers, rays);
}

const bool registered = [] {
  ray_peers().push_back({"SISL", [](const RayTask& task) {
                           const auto casting = start(task);
                           return std::vector<RayRun>{{"SISL " TESSERA_SISL_VERSION, "s1856, all hits", step,
                                                       [=] { return casting->run(); },
                                                       [=](std::size_t ray) { return (*casting)[ray / step]; }}};
                         }});
  return true;
}();

}}  // namespace tessera::bench
