#pragma once
// Valid input, and seeded mutations of it: of numbers, of counts, of choices.

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/infinity.h"
#include "support/random_patches.h"
#include "tessera/geometry.h"

namespace tessera::test {

/// Passes every number of a valid description through, and changes a few.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {
    static constexpr std::array rates{0.0, 0.01, 0.05, 0.3};
    rate_ = rates[random_() % rates.size()];
  }

  Random& random() { return random_; }
  bool chance(double share) { return uniform(random_, 0, 1) < share; }
  std::size_t below(std::size_t count) { return random_() % count; }

  double number(double value) { return chance(rate_) ? mutated(value) : value; }
  Vec3 point(const Vec3& p) { return {number(p.x), number(p.y), number(p.z)}; }
  Domain domain(const Domain& d) { return {number(d.u0), number(d.u1), number(d.v0), number(d.v1)}; }
  int integer(int value) {
    static constexpr std::array others{
        0, -1, 1, 2, 16, 4097, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    return chance(rate_) ? others[below(others.size())] : value;
  }
  template <class T>
  T choice(T value, int count) {
    return chance(rate_) ? static_cast<T>(below(static_cast<std::size_t>(count) + 1)) : value;
  }
  std::vector<double> list(std::vector<double> values) {
    for (double& value : values) value = number(value);
    change_count(values, 0.5);
    if (chance(rate_) && values.size() > 1) std::swap(values[below(values.size())], values[below(values.size())]);
    return values;
  }
  std::vector<Vec3> list(std::vector<Vec3> points) {
    for (Vec3& p : points) p = point(p);
    change_count(points, Vec3{});
    if (chance(rate_) && !points.empty()) points[below(points.size())] = points[below(points.size())];
    if (chance(rate_ / 4) && !points.empty()) std::fill(points.begin(), points.end(), points[0]);
    return points;
  }

 private:
  double mutated(double value) {
    static constexpr std::array others{
        0.0,   -0.0,  1.0,    -1.0,   5e-324,  -5e-324,  2e-308,   1e-45,
        1e-30, 1e30,  1e38,   4e38,   1e300,   -1e300,   infinity, -infinity,
        1e16,  -1e16, 1e-100, 1e-101, 1.7e308, -1.7e308, 1e-9,     std::numeric_limits<double>::quiet_NaN()};
    switch (below(4)) {
      case 0:
        return others[below(others.size())];
      case 1:
        return std::nextafter(value, others[below(others.size())]);
      case 2:
        return std::ldexp(value, static_cast<int>(below(200)) - 100);
      default:
        return -value;
    }
  }
  template <class T>
  void change_count(std::vector<T>& values, const T& another) {
    if (!chance(rate_)) return;
    if (chance(0.5))
      values.push_back(another);
    else if (!values.empty())
      values.pop_back();
  }

  Random random_;
  double rate_ = 0;
};

}  // namespace tessera::test
