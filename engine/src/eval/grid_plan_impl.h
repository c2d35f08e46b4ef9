#pragma once
// The inside of a GridPlan: parameters, and the weights of each degree at them.

#include <array>
#include <cstdint>
#include <vector>

#include "base/aligned.h"
#include "kernel/table/kernel_table.h"
#include "tessera/evaluate.h"

namespace tessera { inline namespace abi_0_1 {

/// `[k][order][i]` for parameter k: values, first and second derivatives, degree + 1 of each. One table per degree
/// in use.
template <class T>
using WeightTables = std::array<AlignedVector<T>, max_degree + 1>;

/// Weights of parameters that differ from patch to patch: one table per block, `[k][order][i][lane]`.
template <class T>
struct LaneTables {
  UnsetVector<T> values;
  std::vector<std::size_t> first;
  const T* of(std::size_t block) const { return values.data() + first[block]; }
};

/// The tables of one precision: by degree, or by block where each patch has parameters of its own.
template <class T>
struct GridWeights {
  WeightTables<T> u, v;
  LaneTables<T> u_lanes, v_lanes;
};

/// Tables of the flat kernel by degree, see FlatJob.
struct FlatTables {
  WeightTables<float> u, v;
};

/// Degrees, rationality and patches of a group. A set that the plan runs over must have the same groups.
struct PlannedGroup {
  int degree_u, degree_v;
  bool rational;
  std::size_t blocks, patches;
};

class GridPlan::Impl {
 public:
  std::vector<double> u, v;  ///< `[k]`, or `[patch][k]`
  std::size_t count_u = 0, count_v = 0;
  bool by_patch = false;
  GridPlanOptions options;
  Isa isa = Isa::sse2;
  std::vector<PlannedGroup> groups;
  std::size_t patch_count = 0, block_count = 0;
  GridWeights<float> f32;
  GridWeights<double> f64;
  bool is_flat = false;  ///< the flat kernel evaluates positions if they are the only output
  FlatTables flat;
  /// Whether any parameter lies on the edges u = 0, u = 1, v = 0, v = 1: only there can a collapsed edge be met.
  SideMask edges;
  /// Where each parameter lies: edge_start at 0, edge_end at 1 (see kernel_table.h); `[k]`, or `[block][k][lane]`.
  std::vector<std::uint8_t> u_edges, v_edges;

  std::size_t samples() const { return count_u * count_v; }
  double u_at(std::size_t patch, std::size_t k) const { return u[by_patch ? patch * count_u + k : k]; }
  double v_at(std::size_t patch, std::size_t k) const { return v[by_patch ? patch * count_v + k : k]; }
  template <class T>
  const GridWeights<T>& weights() const {
    if constexpr (sizeof(T) == 4) {
      return f32;
    } else {
      return f64;
    }
  }
};

/// The public evaluate() for callers that keep a set's inner state, which stays in place when the set is moved.
Status evaluate(const PatchSet::Impl& set, const GridPlan& plan, const QuantityViews<float>& out,
                const Execution& execution);

}}  // namespace tessera::abi_0_1
