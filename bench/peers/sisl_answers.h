#pragma once
// A program of SISL's that does all of its work again at each command, for ray_sisl.cpp and nearest_sisl.cpp.

#include <cstddef>
#include <string>
#include <vector>

#include "peers/child_process.h"
#include "peers/sisl_protocol.h"
#include "tessera/geometry.h"

namespace tessera::bench {

/// The numbers that a program sends for each item of its work.
class SislAnswers {
 public:
  /// `task`: SislRayTask or SislPointTask. `net`: the control points. `numbers`: of the items.
  template <class Task>
  SislAnswers(const std::string& program, const Task& task, const std::vector<Vec3>& net,
              const std::vector<double>& numbers, std::size_t items)
      : process_(program), values_(items) {
    process_.send(&task, 1);
    process_.send(net.data(), net.size());
    process_.send(numbers.data(), numbers.size());
  }
  /// Has the work done once; returns its processor time.
  double run() {
    double seconds = 0;
    process_.send("r", 1);
    process_.receive(&seconds, 1);
    process_.receive(values_.data(), values_.size());
    return seconds;
  }
  double operator[](std::size_t item) const { return values_[item]; }

 private:
  ChildProcess process_;
  std::vector<double> values_;
};

}  // namespace tessera::bench
