#pragma once
// Scattered samples for tests, and their results.

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "support/grids.h"
#include "tessera/evaluate.h"

namespace tessera::test {

/// Samples by patch in arrays of their own.
template <class T>
struct Samples {
  std::vector<std::uint32_t> patch;
  std::vector<T> u, v;

  std::size_t size() const { return patch.size(); }
  void add(std::size_t of, T s, T t) {
    patch.push_back(static_cast<std::uint32_t>(of));
    u.push_back(s);
    v.push_back(t);
  }
  PatchSamples<T> views() const {
    return {View1<const std::uint32_t>::interleaved(patch), View1<const T>::interleaved(u),
            View1<const T>::interleaved(v)};
  }
  /// Sample k of the result is sample order[k].
  Samples in_order(const std::vector<std::size_t>& order) const {
    Samples result;
    for (const std::size_t k : order) result.add(patch[k], u[k], v[k]);
    return result;
  }
};

/// Patches and parameters at random; one parameter in eight is an end.
template <class T>
Samples<T> random_samples(Random& random, std::size_t patch_count, std::size_t count) {
  const auto parameter = [&] {
    return random() % 8 == 0 ? static_cast<T>(random() % 2)
                             : std::clamp<T>(static_cast<T>(uniform(random, -0.02, 1.02)), 0, 1);
  };
  Samples<T> samples;
  for (std::size_t k = 0; k < count; ++k) {
    const T u = parameter(), v = parameter();
    samples.add(random() % patch_count, u, v);
  }
  return samples;
}

inline std::vector<std::size_t> shuffled_order(Random& random, std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

inline PatchSetOptions with_points() {
  PatchSetOptions options;
  options.blocks = {true, true, false, false, true, true};
  return options;
}

/// Every output of the samples.
template <class T>
AllBuffers<T> all_outputs(const PatchSet& set, const Samples<T>& samples, const PointOptions& options = {},
                          const Execution& execution = {}) {
  AllBuffers<T> out(samples.size());
  const Status status = evaluate(set, samples.views(), out.views(), options, execution);
  EXPECT_TRUE(status.ok()) << status.message();
  return out;
}

}  // namespace tessera::test
