#pragma once
// The patch that both programs use: z = 1 - x^2 over the square [-1,1]^2, which a Bezier patch of degrees (2,1) holds
// exactly.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <tessera/bezier_patch.h>
#include <tessera/patch_set.h>

/// Ends the program with a message unless `holds`.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "consumer: %s\n", what);
  std::exit(1);
}

/// The value; without one, ends the program with the status' message.
template <class T>
T value_of(tessera::Result<T> result) {
  if (!result) require(false, result.status().message().c_str());
  return *std::move(result);
}

inline void require(const tessera::Status& status) { require(status.ok(), status.message().c_str()); }

inline double dome_height(double x) { return 1 - x * x; }

inline tessera::PatchSet make_dome() {
  // x = 2u - 1 is (-1, 0, 1) in Bernstein form of degree 2, and 1 - x^2 is (0, 2, 0).
  const std::array<tessera::Vec3, 6> points{{{-1, -1, 0}, {-1, 1, 0}, {0, -1, 2}, {0, 1, 2}, {1, -1, 0}, {1, 1, 0}}};
  const std::array patches{value_of(tessera::BezierPatch::polynomial(2, 1, points))};
  return value_of(tessera::PatchSet::make(patches));
}
