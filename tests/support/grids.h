#pragma once
// Sets and grids for tests of evaluation, shared by these tests.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "base/aligned.h"
#include "eval/quantity_table.h"
#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"

namespace tessera::test {

template <class T>
constexpr Precision precision_of = sizeof(T) == 4 ? Precision::single_precision : Precision::double_precision;

inline PatchSet set_of(const std::vector<BezierPatch>& patches, PatchSetOptions options = {}) {
  return value_of(PatchSet::make(patches, options));
}

/// Patches of every mix of degrees up to `degree`, polynomial and rational, in shuffled order: several groups, partial
/// blocks.
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
  QuantityViews<T> views() {
    return {View3<T>::interleaved(position), View3<T>::interleaved(du), View3<T>::interleaved(dv),
            View3<T>::interleaved(normal)};
  }
  bool operator==(const GridBuffers&) const = default;
};

/// Every output of a grid in an array of its own, patch-contiguous; memory of outputs that are not requested keeps
/// `fill`.
template <class T>
struct AllBuffers {
  std::vector<std::vector<T>> values;  ///< in the order of for_each_value_quantity
  std::vector<NormalKind> normal_kind;
  std::vector<CurvatureKind> curvature_kind;

  explicit AllBuffers(const GridPlan& plan, T fill = T(-7)) : AllBuffers(plan.capacity(), fill) {}
  explicit AllBuffers(std::size_t records, T fill = T(-7))
      : normal_kind(records, NormalKind{9}), curvature_kind(records, CurvatureKind{9}) {
    for_each_value_quantity(
        [&](const auto& output) { values.emplace_back(static_cast<std::size_t>(output.width) * records, fill); });
  }
  QuantityViews<T> views() {
    QuantityViews<T> out;
    std::size_t k = 0;
    for_each_value_quantity([&](const auto& output) {
      auto& view = output.of(out);
      view = std::remove_reference_t<decltype(view)>::interleaved(values[k++]);
    });
    out.normal_kind = View1<NormalKind>::interleaved(normal_kind);
    out.curvature_kind = View1<CurvatureKind>::interleaved(curvature_kind);
    return out;
  }
  bool operator==(const AllBuffers&) const = default;
};

template <class T>
Vec3 read(const View3<T>& view, std::size_t record) {
  return {view.at(record, 0), view.at(record, 1), view.at(record, 2)};
}

template <class T>
Vec3 vector_at(const std::vector<T>& values, std::size_t record) {
  return {values[3 * record], values[3 * record + 1], values[3 * record + 2]};
}

}  // namespace tessera::test
