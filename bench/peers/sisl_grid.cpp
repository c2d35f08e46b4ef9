// SISL's s1506 over a grid of a bicubic B-spline surface, as a program of its own: SISL is under the AGPL, so nothing
// of Tessera is linked here, and Tessera's programs use this one through pipes (sisl_protocol.h).

#include <vector>

#include "sisl_program.h"

namespace {

int serve(const SislTask& task, SISLSurf* surface, std::vector<double>& t) {
  const auto count = static_cast<std::size_t>(task.count), vectors = std::size_t{task.tangents ? 3u : 1u};
  std::vector<double> values(3 * vectors * count * count), normals(task.tangents ? 3 * count * count : 3);
  for (char command = 0; read(&command, 1);) {
    if (command == 'r') {
      int status = 0;
      const double start = processor_seconds();
      s1506(surface, task.tangents ? 1 : 0, task.count, t.data(), task.count, t.data(), values.data(), normals.data(),
            &status);
      const double seconds = processor_seconds() - start;
      if (status < 0 || !write(&seconds, 1)) return 1;
    } else {
      std::uint64_t place[2];
      double point[9] = {};
      if (!read(place, 2) || place[0] >= count || place[1] >= count) return 1;
      const double* from = values.data() + 3 * vectors * (place[1] * count + place[0]);
      for (std::size_t k = 0; k < 3 * vectors; ++k) point[k] = from[k];
      if (!write(point, 9)) return 1;
    }
  }
  return 0;
}

}  // namespace

int main() {
  SislTask task;
  if (!read(&task, 1) || task.side < 4 || task.count < 1) return 1;
  const auto side = static_cast<std::size_t>(task.side);
  std::vector<double> net(3 * side * side), t(static_cast<std::size_t>(task.count));
  if (!read(net.data(), net.size()) || !read(t.data(), t.size())) return 1;
  SISLSurf* surface = surface_of(task.side, net);
  if (surface == nullptr) return 1;
  const int status = serve(task, surface, t);
  freeSurf(surface);
  return status;
}
