// SISL's s1958, which finds the nearest point of a surface, as a program of its own, like sisl_grid.cpp.

#include <cmath>
#include <vector>

#include "sisl_program.h"

namespace {

/// The distance of a point; NaN if SISL gives up.
double nearest(SISLSurf* surface, double* point, double tolerance) {
  double parameters[2], distance = 0;
  int status = 0;
  s1958(surface, point, 3, 0, tolerance, parameters, &distance, &status);
  return status < 0 ? std::nan("") : distance;
}

}  // namespace

int main() {
  SislPointTask task;
  if (!read(&task, 1) || task.side < 4 || task.points < 1) return 1;
  const auto side = static_cast<std::size_t>(task.side), count = static_cast<std::size_t>(task.points);
  std::vector<double> net(3 * side * side), points(3 * count), distances(count);
  if (!read(net.data(), net.size()) || !read(points.data(), points.size())) return 1;
  SISLSurf* surface = surface_of(task.side, net);
  if (surface == nullptr) return 1;
  for (char command = 0; read(&command, 1);) {
    const double start = processor_seconds();
    for (std::size_t k = 0; k < count; ++k) distances[k] = nearest(surface, &points[3 * k], task.tolerance);
    const double seconds = processor_seconds() - start;
    if (!write(&seconds, 1) || !write(distances.data(), distances.size())) return 1;
  }
  freeSurf(surface);
  return 0;
}
