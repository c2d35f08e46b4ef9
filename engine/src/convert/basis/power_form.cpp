#include "convert/basis/power_form.h"

#include <cassert>
#include <cstddef>

#include "basis/bernstein.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Transforms one direction: `count` curves of the given degree. Point i of a curve is the `width` values at curve *
/// next + i * step.
void transform_curves(int degree, double* values, std::size_t step, std::size_t width, std::size_t count,
                      std::size_t next) {
  for (std::size_t curve = 0; curve < count; ++curve) {
    double* net = values + curve * next;
    const auto at = [&](int i) { return net + static_cast<std::size_t>(i) * step; };
    for (int order = 1; order <= degree; ++order)
      for (int i = degree; i >= order; --i)
        for (std::size_t c = 0; c < width; ++c) at(i)[c] -= at(i - 1)[c];
    for (int i = 1; i < degree; ++i) {
      const double factor = binomial(degree, i);
      for (std::size_t c = 0; c < width; ++c) at(i)[c] *= factor;
    }
  }
}

}  // namespace

void power_coefficients(int degree_u, int degree_v, int components, std::span<double> net) {
  const std::size_t width = static_cast<std::size_t>(components);
  const std::size_t row = static_cast<std::size_t>(degree_v + 1) * width;
  assert(net.size() == static_cast<std::size_t>(degree_u + 1) * row);
  transform_curves(degree_u, net.data(), row, row, 1, 0);
  transform_curves(degree_v, net.data(), width, width, static_cast<std::size_t>(degree_u + 1), row);
}

}}  // namespace tessera::abi_0_1
