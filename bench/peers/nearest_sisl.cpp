// Nearest points by SISL's s1958, in a process of its own (sisl_points.cpp), which measures its own time. It searches
// from one point in many.

#include <memory>

#include "peers/child_process.h"
#include "peers/nearest_task.h"
#include "peers/sisl_protocol.h"

namespace tessera::bench { namespace {

constexpr std::size_t step = 997;  // a prime

class Search {
 public:
  explicit Search(const NearestTask& task) : process_(TESSERA_SISL_POINTS) {
    std::vector<double> numbers;
    const auto push = [&](const Vec3& p) { numbers.insert(numbers.end(), {p.x, p.y, p.z}); };
    for (const Vec3& p : task.net) push(p);
    for (std::size_t k = 0; k < task.points.size(); k += step) push(task.points[k]), distances_.push_back(0);
    const SislPointTask header{task.side(), static_cast<std::int32_t>(distances_.size()), 1e-9 * task.size};
    process_.send(&header, 1);
    process_.send(numbers.data(), numbers.size());
  }
  double run() {
    double seconds = 0;
    process_.send("r", 1);
    process_.receive(&seconds, 1);
    process_.receive(distances_.data(), distances_.size());
    return seconds;
  }
  double distance(std::size_t point) const { return distances_[point / step]; }

 private:
  ChildProcess process_;
  std::vector<double> distances_;
};

const bool registered = [] {
  nearest_peers().push_back({"SISL", [](const NearestTask& task) {
                               const auto search = std::make_shared<Search>(task);
                               return NearestRun{"SISL " TESSERA_SISL_VERSION, "s1958", step,
                                                 [=] { return search->run(); },
                                                 [=](std::size_t point) { return search->distance(point); }};
                             }});
  return true;
}();

}}  // namespace tessera::bench
