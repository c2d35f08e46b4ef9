#pragma once
// Parts of the programs by which SISL does its share of a comparison.

#include <sisl.h>
#include <time.h>

#include <cstddef>
#include <cstdio>
#include <vector>

#include "sisl_protocol.h"

template <class T>
bool read(T* values, std::size_t count) {
  return std::fread(values, sizeof(T), count, stdin) == count;
}
template <class T>
bool write(const T* values, std::size_t count) {
  return std::fwrite(values, sizeof(T), count, stdout) == count && std::fflush(stdout) == 0;
}

/// See interleaved.h.
inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Makes a bicubic surface over uniform knots. In SISL the first parameter runs fastest.
inline SISLSurf* surface_of(int n, const std::vector<double>& net) {
  std::vector<double> knots, points;
  for (int k = 0; k < n + 4; ++k) knots.push_back(k - 3);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c) points.push_back(net[static_cast<std::size_t>(3 * (i * n + j) + c)]);
  return newSurf(n, n, 4, 4, knots.data(), knots.data(), points.data(), 1, 3, 1);
}
