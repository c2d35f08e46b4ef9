// The rays by SISL's s1856, in a process of its own (sisl_rays.cpp), which measures its own time. It casts one ray in
// many.

#include <memory>

#include "peers/child_process.h"
#include "peers/ray_task.h"
#include "peers/sisl_protocol.h"

namespace tessera::bench { namespace {

constexpr std::size_t step = 509;  // a prime, to spread rays over the picture

class Casting {
 public:
  explicit Casting(const RayTask& task) : process_(TESSERA_SISL_RAYS) {
    std::vector<double> numbers;
    for (const Vec3& p : task.net) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    for (std::size_t k = 0; k < task.camera.rays(); k += step) {
      const Ray ray = task.camera.ray(k);
      const Vec3 &o = ray.origin, &d = ray.direction;
      numbers.insert(numbers.end(), {o.x, o.y, o.z, d.x, d.y, d.z});
      t_.push_back(0);
    }
    const SislRayTask header{task.side(), static_cast<std::int32_t>(t_.size()), 1e-9 * task.size};
    process_.send(&header, 1);
    process_.send(numbers.data(), numbers.size());
  }
  double run() {
    double seconds = 0;
    process_.send("r", 1);
    process_.receive(&seconds, 1);
    process_.receive(t_.data(), t_.size());
    return seconds;
  }
  double t(std::size_t ray) const { return t_[ray / step]; }

 private:
  ChildProcess process_;
  std::vector<double> t_;
};

const bool registered = [] {
  ray_peers().push_back({"SISL", [](const RayTask& task) {
                           const auto casting = std::make_shared<Casting>(task);
                           return std::vector<RayRun>{{"SISL " TESSERA_SISL_VERSION, "s1856, all hits", step,
                                                       [=] { return casting->run(); },
                                                       [=](std::size_t ray) { return casting->t(ray); }}};
                         }});
  return true;
}();

}}  // namespace tessera::bench
