#include "surface/callable/differences.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera { namespace {

using Stencil = DifferenceStencil;

struct Derivatives {
  double first, second;
};

template <class F>
Derivatives derivatives(const F& f, double t, double from, double to) {
  const Stencil stencil(t, from, to);
  std::array<double, Stencil::size> values;
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = f(stencil.at[k]);
  return {Stencil::derivative(stencil.first, values, f(t)), Stencil::derivative(stencil.second, values, f(t))};
}

TEST(Differences, StayWithinTheInterval) {
  for (const auto& [from, to] : {std::pair{0.0, 1.0}, {-3.0, 5.0}, {1e6, 1e6 + 1}, {1.0, 1.0 + 1e-9}})
    for (int i = 0; i <= 1000; ++i) {
      const double t = i == 1000 ? to : from + i * (to - from) / 1000;
      for (const double at : Stencil(t, from, to).at) {
        EXPECT_GE(at, from);
        EXPECT_LE(at, to);
      }
    }
}

TEST(Differences, OfConstantsAreZero) {
  for (const double t : {0.0, 0.001, 0.5, 1.0}) {
    const Derivatives d = derivatives([](double) { return 0.1; }, t, 0, 1);
    EXPECT_EQ(d.first, 0);
    EXPECT_EQ(d.second, 0);
  }
}

// f = A sin(k x) has F_n = A k^n. The stated bounds, h = 2^-8 L.
TEST(Differences, KeepTheStatedBounds) {
  for (const double length : {1.0, 1e-3, 100.0})
    for (const double waves : {1.0, 3.0, 20.0}) {
      const double k = waves / length, h = 0x1p-8 * length;
      const auto f = [&](double x) { return std::sin(k * x); };
      for (int i = 0; i <= 1000; ++i) {
        const double t = i == 1000 ? length : i * length / 1000;
        const Derivatives d = derivatives(f, t, 0, length);
        const bool inner = t >= 3 * h && t <= length - 3 * h;
        const double first = inner ? std::pow(h, 6) * std::pow(k, 7) / 140 + 0x1p-42 / length
                                   : std::pow(h, 6) * std::pow(k, 7) / 7 + 0x1p-39 / length;
        const double second = inner ? std::pow(h, 6) * std::pow(k, 8) / 560 + 0x1p-33 / (length * length)
                                    : 0.7 * std::pow(h, 5) * std::pow(k, 7) + 0x1p-29 / (length * length);
        EXPECT_LE(std::abs(d.first - k * std::cos(k * t)), first) << length << " " << waves << " " << i;
        EXPECT_LE(std::abs(d.second + k * k * std::sin(k * t)), second) << length << " " << waves << " " << i;
      }
    }
}

}}  // namespace tessera
