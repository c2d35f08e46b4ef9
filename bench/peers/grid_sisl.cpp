// The grid by SISL's s1506, in a process of its own (sisl_grid.cpp), which measures its own time.

#include <memory>

#include "peers/child_process.h"
#include "peers/grid_task.h"
#include "peers/sisl_protocol.h"

namespace tessera::bench { namespace {

/// The program sisl_grid, started for one task.
class Process {
 public:
  explicit Process(const GridTask& task) : process_(TESSERA_SISL_GRID) {
    std::vector<double> numbers;
    for (const Vec3& p : task.net) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    for (std::size_t k = 0; k < task.count(); ++k) numbers.push_back(task.parameter(k));
    const SislTask header{task.side(), static_cast<std::int32_t>(task.count()), task.tangents ? 1 : 0};
    process_.send(&header, 1);
    process_.send(numbers.data(), numbers.size());
  }

  double run() {
    double seconds = 0;
    process_.send("r", 1);
    process_.receive(&seconds, 1);
    return seconds;
  }
  GridValue read_point(std::size_t i, std::size_t j) {
    const std::uint64_t place[2] = {i, j};
    double p[9];
    process_.send("v", 1);
    process_.send(place, 2);
    process_.receive(p, 9);
    return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]}};
  }

 private:
  ChildProcess process_;
};

const bool registered = [] {
  grid_peers().push_back({"SISL", [](const GridTask& task) {
                            const auto process = std::make_shared<Process>(task);
                            return std::vector<GridRun>{
                                {"SISL " TESSERA_SISL_VERSION, "s1506", true, [=] { return process->run(); },
                                 [=](std::size_t i, std::size_t j) { return process->read_point(i, j); }}};
                          }});
  return true;
}();

}}  // namespace tessera::bench
