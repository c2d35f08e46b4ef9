// Nearest points by SISL's s1958, in a process of its own (sisl_points.cpp), which measures its own time. It searches
// from one point in many.

#include <memory>

#include "peers/nearest_task.h"
#include "peers/sisl_answers.h"

namespace tessera::bench { namespace {

constexpr std::size_t step = 997;  // a prime

std::shared_ptr<SislAnswers> start(const NearestTask& task) {
  std::vector<double> numbers;
  for (std::size_t k = 0; k < task.points.size(); k += step) {
    const Vec3& p = task.points[k];
    numbers.insert(numbers.end(), {p.x, p.y, p.z});
  }
  const std::size_t points = numbers.size() / 3;
  const SislPointTask header{task.side(), static_cast<std::int32_t>(points), 1e-9 * task.size};
  return std::make_shared<SislAnswers>(TESSERA_SISL_POINTS, header, task.net, numbers, points);
}

const bool registered = [] {
  nearest_peers().push_back({"SISL", [](const NearestTask& task) {
                               const auto search = start(task);
                               return NearestRun{"SISL " TESSERA_SISL_VERSION, "s1958", step,
                                                 [=] { return search->run(); },
                                                 [=](std::size_t point) { return (*search)[point / step]; }};
                             }});
  return true;
}();

}}  // namespace tessera::bench
