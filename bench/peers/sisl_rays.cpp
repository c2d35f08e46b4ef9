// SISL's s1856, which finds all points that a straight line shares with a bicubic B-spline surface, as a program of its
// own, like sisl_grid.cpp. Sends back the nearest point of each ray from its origin on.

#include <sisl.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include "sisl_program.h"

namespace {

/// t of the nearest hit of the ray x y z dx dy dz; infinite for a miss, NaN if SISL gives up.
double closest(SISLSurf* surface, double* ray, double tolerance) {
  int points = 0, curves = 0, status = 0, left = 0, right = 0;
  double* parameters = nullptr;
  SISLIntcurve** lines = nullptr;
  s1856(surface, ray, ray + 3, 3, 0, tolerance, &points, &parameters, &curves, &lines, &status);
  double nearest = status < 0 ? std::nan("") : std::numeric_limits<double>::infinity();
  for (int k = 0; k < points; ++k) {
    double value[3], normal[3];
    int evaluated = 0;
    s1421(surface, 0, parameters + 2 * k, &left, &right, value, normal, &evaluated);
    double along = 0, square = 0;
    for (int c = 0; c < 3; ++c) {
      along += (value[c] - ray[c]) * ray[3 + c];
      square += ray[3 + c] * ray[3 + c];
    }
    if (evaluated >= 0 && along >= 0 && !(along / square > nearest)) nearest = along / square;
  }
  std::free(parameters);
  if (lines != nullptr) freeIntcrvlist(lines, curves);
  return nearest;
}

}  // namespace

int main() {
  SislRayTask task;
  if (!read(&task, 1) || task.side < 4 || task.rays < 1) return 1;
  const auto side = static_cast<std::size_t>(task.side), count = static_cast<std::size_t>(task.rays);
  std::vector<double> net(3 * side * side), rays(6 * count), t(count);
  if (!read(net.data(), net.size()) || !read(rays.data(), rays.size())) return 1;
  SISLSurf* surface = surface_of(task.side, net);
  if (surface == nullptr) return 1;
  for (char command = 0; read(&command, 1);) {
    const double start = processor_seconds();
    for (std::size_t k = 0; k < count; ++k) t[k] = closest(surface, &rays[6 * k], task.tolerance);
    const double seconds = processor_seconds() - start;
    if (!write(&seconds, 1) || !write(t.data(), t.size())) return 1;
  }
  freeSurf(surface);
  return 0;
}
