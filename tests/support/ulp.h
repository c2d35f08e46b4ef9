#pragma once
// Errors in units: a precision's unit in the last place of 1, times the largest |coefficient| of a patch.

#include <gtest/gtest.h>

#include "tessera/bezier_patch.h"

namespace tessera::test {

inline constexpr double float_unit = 0x1p-23;
inline constexpr double double_unit = 0x1p-52;

/// The largest |component| of a patch's control points relative to `origin`.
inline double largest_coefficient(const BezierPatch& patch, const Vec3& origin = {}) {
  double largest = 0;
  for (const Vec3& p : patch.points()) largest = std::max(largest, max_abs(p - origin));
  return largest;
}

/// |value - expected| in units of `unit`; infinite if it is not a number.
inline double error_in_units(const Vec3& value, const Vec3& expected, double unit) {
  const double error = max_abs(value - expected) / unit;
  return std::isfinite(max_abs(value)) && error == error ? error : std::numeric_limits<double>::infinity();
}

/// For EXPECT_TRUE: each component of `value` lies within `limit` units of `expected`.
inline ::testing::AssertionResult within_units(const Vec3& value, const Vec3& expected, double unit, double limit) {
  // NaN compares false, so the test is for nearness rather than for distance.
  const auto near = [&](double a, double b) { return std::abs(a - b) <= limit * unit; };
  if (near(value.x, expected.x) && near(value.y, expected.y) && near(value.z, expected.z))
    return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "(" << value.x << ", " << value.y << ", " << value.z << ") is "
                                       << error_in_units(value, expected, unit) << " units from (" << expected.x << ", "
                                       << expected.y << ", " << expected.z << "), allowed are " << limit;
}

}  // namespace tessera::test
