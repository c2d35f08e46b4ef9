#pragma once
// Positions of polynomial patches, one patch after the other in memory, lanes = neighbouring numbers of a grid's row.

#include <cstddef>

#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// The numbers of a vector, and the rows of a grid whose row curves share one vector, three components each.
inline constexpr int flat_lanes = 16, flat_rows = 4;

/// Rows of a grid for patches that follow each other in memory. Tables are aligned to 64 bytes.
struct FlatJob {
  const float* const* nets = nullptr;  ///< per patch: its first coefficient, `[i][j][component]`, block_lanes apart
  int patches = 0;
  int degree_u = 0, degree_v = 0;
  int count_u = 0, count_v = 0;  ///< rows and columns of the part of the grid
  /// `[count_u / flat_rows, rounded up][i][lane]` from the part's first row on: lane l has the weights of row l / 3.
  const float* u_weights = nullptr;
  /// `[vector of a row][j][lane]`: lane l of vector k has the weights of column (16 k + l) / 3.
  const float* v_weights = nullptr;
  float* out = nullptr;           ///< the first number of the first patch
  std::ptrdiff_t patch_step = 0;  ///< numbers from one patch to the next
  bool streaming = false;         ///< non-temporal stores; the caller ends them with finish_streaming
};

struct FlatKernels {
  /// Gives the same bits as GridKernels. Null where it would not pay.
  Isa (*flat_f32)(const FlatJob&);
};

}}}  // namespace tessera::abi_0_1::kernel
