#include "eval/border_weights.h"

#include <array>

#include "basis/bernstein.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

AlignedVector<float> symmetric_weights(int degree, int rate) {
  AlignedVector<float> weights;
  weights.reserve(static_cast<std::size_t>((rate + 1) * (degree + 1)));
  for (int k = 0; k <= rate; ++k) {
    std::array<double, max_degree + 1> t{1}, s{1};
    for (std::size_t i = 1; i <= static_cast<std::size_t>(degree); ++i) {
      t[i] = t[i - 1] * (static_cast<double>(k) / rate);
      s[i] = s[i - 1] * (static_cast<double>(rate - k) / rate);
    }
    for (int i = 0; i <= degree; ++i)
      weights.push_back(static_cast<float>(binomial(degree, i) *
                                           (t[static_cast<std::size_t>(i)] * s[static_cast<std::size_t>(degree - i)])));
  }
  return weights;
}

}}  // namespace tessera::abi_0_1
