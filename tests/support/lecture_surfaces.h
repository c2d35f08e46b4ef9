#pragma once
// The parametric surfaces of the lectures, as expressions over any type of number, with their inverses.

#include <array>
#include <cmath>
#include <numbers>

#include "tessera/generic_callable.h"

namespace tessera::test {

inline constexpr double pi = std::numbers::pi;

struct Plane {
  template <class T>
  std::array<T, 3> operator()(const T& u, const T& v) const {
    return {u, 1 - u, v};
  }
  static constexpr Domain domain{-1, 2, 0, 3};
  static std::array<double, 2> inverse(const Vec3& p) { return {p.x, p.z}; }
};

struct Cylinder {
  template <class T>
  std::array<T, 3> operator()(const T& u, const T& v) const {
    using std::cos, std::sin;
    return {cos(u), sin(u), v};
  }
  static constexpr Domain domain{0, 2 * pi, -1, 1};
  static std::array<double, 2> inverse(const Vec3& p) {
    const double angle = std::atan2(p.y, p.x);
    return {angle < 0 ? angle + 2 * pi : angle, p.z};
  }
};

struct Paraboloid {
  template <class T>
  std::array<T, 3> operator()(const T& u, const T& v) const {
    return {2 * u, 2 * v, u * u + v * v};
  }
  static constexpr Domain domain{-1, 1, -1, 1};
  static std::array<double, 2> inverse(const Vec3& p) { return {p.x / 2, p.y / 2}; }
};

/// Over the unit disc: derivatives are infinite at its rim.
struct RootHemisphere {
  template <class T>
  std::array<T, 3> operator()(const T& x, const T& y) const {
    using std::sqrt;
    return {x, y, sqrt(1 - x * x - y * y)};
  }
  static std::array<double, 2> inverse(const Vec3& p) { return {p.x, p.y}; }
};

/// Over the unit disc.
struct RationalHemisphere {
  template <class T>
  std::array<T, 3> operator()(const T& x, const T& y) const {
    const T square = x * x + y * y;
    return {2 * x / (1 + square), 2 * y / (1 + square), (1 - square) / (1 + square)};
  }
  static std::array<double, 2> inverse(const Vec3& p) { return {p.x / (1 + p.z), p.y / (1 + p.z)}; }
};

struct Torus {
  template <class T>
  std::array<T, 3> operator()(const T& u, const T& v) const {
    using std::cos, std::sin;
    const T r = 3 + cos(v);
    return {r * cos(u), r * sin(u), sin(v)};
  }
  static constexpr Domain domain{0, 2 * pi, 0, 2 * pi};
};

}  // namespace tessera::test
