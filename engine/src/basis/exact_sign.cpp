#include "basis/exact_sign.h"

#include <array>
#include <cassert>
#include <cstddef>

#include "basis/double_double.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t max_terms = 32;

/// Writes the eight terms whose sum is a * b exactly, or those of -a * b.
void write_product(const DoubleDouble& a, const DoubleDouble& b, double sign, double* terms) {
  const DoubleDouble products[] = {two_product(a.high, sign * b.high), two_product(a.high, sign * b.low),
                                   two_product(a.low, sign * b.high), two_product(a.low, sign * b.low)};
  for (const DoubleDouble& product : products) {
    *terms++ = product.high;
    *terms++ = product.low;
  }
}

}  // namespace

int sign_of_sum(std::span<const double> terms) {
  assert(terms.size() <= max_terms);
  // Grow-Expansion (Shewchuk, fig. 6): the components do not overlap and grow in magnitude, so that the last one that
  // is not 0 has the sign of the sum.
  std::array<double, max_terms> expansion;
  std::size_t size = 0;
  for (double carry : terms) {
    for (std::size_t k = 0; k < size; ++k) {
      const DoubleDouble sum = two_sum(carry, expansion[k]);
      expansion[k] = sum.low;
      carry = sum.high;
    }
    expansion[size++] = carry;
  }
  for (std::size_t k = size; k-- > 0;)
    if (expansion[k] != 0) return expansion[k] > 0 ? 1 : -1;
  return 0;
}

int exact_orientation(const ParameterPoint& a, const ParameterPoint& b, const ParameterPoint& c) {
  std::array<double, 16> terms;
  write_product(two_sum(a.u, -c.u), two_sum(b.v, -c.v), 1, terms.data());
  write_product(two_sum(a.v, -c.v), two_sum(b.u, -c.u), -1, terms.data() + 8);
  return sign_of_sum(terms);
}

}}  // namespace tessera::abi_0_1
