#pragma once
// Sets and grids for tests of evaluation: what each test would otherwise write again.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/aligned.h"
#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"

namespace tessera::test {

template <class T>
constexpr Precision precision_of = sizeof(T) == 4 ? Precision::single_precision : Precision::double_precision;

inline PatchSet set_of(const std::vector<BezierPatch>& patches, PatchSetOptions options = {}) {
  return value_of(PatchSet::from(patches, options));
}

/// Patches of every mix of degrees up to `degree`, polynomial and rational, in shuffled order: several groups, partial blocks.
inline std::vector<BezierPatch> mixed_patches(Random& random, int degree, int copies = 1) {
  std::vector<BezierPatch> patches;
  for (int copy = 0; copy < copies; ++copy)
    for (int m = 1; m <= degree; ++m)
      for (int n = 1; n <= degree; ++n) {
        patches.push_back(random_polynomial(random, m, n));
        patches.push_back(random_rational(random, m, n));
      }
  std::shuffle(patches.begin(), patches.end(), random);
  return patches;
}

/// Patch-contiguous outputs in four arrays of triples.
template <class T>
struct GridBuffers {
  std::vector<T> position, du, dv, normal;

  explicit GridBuffers(const GridPlan& plan, T fill = T(-7))
      : position(3 * plan.capacity(), fill), du(position), dv(position), normal(position) {}
  GridViews<T> views() {
    return {View3<T>::interleaved(position), View3<T>::interleaved(du), View3<T>::interleaved(dv), View3<T>::interleaved(normal)};
  }
  bool operator==(const GridBuffers&) const = default;
};

template <class T>
Vec3 vector_at(const std::vector<T>& values, std::size_t record) {
  return {values[3 * record], values[3 * record + 1], values[3 * record + 2]};
}

}  // namespace tessera::test
