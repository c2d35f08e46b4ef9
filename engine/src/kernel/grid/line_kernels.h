#pragma once
// Jobs and kernels for other parts of grids: borders, patch-contiguous results, and blends of border curves.

#include <cstddef>
#include <cstdint>

#include "kernel/isa/block_lanes.h"
#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// Border curves of a block, lanes = patches, evaluated so that the parameter's direction does not change a bit.
template <class T>
struct BorderJob {
  const T* control = nullptr;       ///< the first control point, `[component][lane]`
  std::ptrdiff_t control_step = 0;  ///< elements from one control point of the border to the next
  int degree = 0;
  bool rational = false;
  const T* weights = nullptr;  ///< `[k][degree + 1]`, bitwise symmetric: weights[k][i] == weights[count-1-k][degree-i]
  int count = 0;
  T* position = nullptr;  ///< `[k][component][lane]`
};

/// Results of a block's lanes on their way to one array each, from piece to piece of the grid. Values that do not yet
/// fill a whole aligned vector wait here.
template <class T>
struct LineState {
  static constexpr int values = 64 / static_cast<int>(sizeof(T));
  alignas(64) T carry[block_lanes][values];  ///< of the vector at `next`, known up to `end`: the input of shift_in()
  alignas(64) T head[block_lanes][values];   ///< once `next` is beyond `first`: the vector there, which another lane
                                             ///< may share
  T* first[block_lanes];  ///< the vector in which the lane begins, at value `begin`; null where that is 0
  T* next[block_lanes];
  int begin[block_lanes], end[block_lanes];
};

/// The next values of all lanes.
template <class T>
struct LineJob {
  LineState<T>* state = nullptr;
  /// Value k of lane l is at rows[k * step + l]; aligned to 64 bytes. Another 15 rows must be readable; they are
  /// ignored.
  const T* rows = nullptr;
  std::ptrdiff_t step = block_lanes;
  std::ptrdiff_t count = 0;
  int lane_count = block_lanes;  ///< lanes beyond it have the values and the memory of one before
  bool streaming = false;        ///< non-temporal stores, as in GridJob
};

/// Rows of a transfinite grid: g1_j C1_i + g2_j C2_i + f1_i K1_j + f2_i K2_j at record i * column_count + j.
template <class T>
struct BlendJob {
  const T* rows = nullptr;     ///< `[i][8]`: C1 and C2, three components each, then f1 and f2
  const T* columns = nullptr;  ///< `[8][column_step]`: g1, g2, then K1 and K2, three components each; 64-byte aligned
  std::ptrdiff_t column_step = 0;  ///< at least column_count, a multiple of 16: whole vectors are read
  std::ptrdiff_t row_count = 0, column_count = 0;
  T* out[3] = {nullptr, nullptr, nullptr};  ///< component c of record k goes to out[c][k * stride]
  std::ptrdiff_t stride = 1;
};

struct LineKernels {
  void (*border_f32)(const BorderJob<float>&);
  /// Patch-contiguous results: begin with each lane's memory, put the pieces in order, and end with the rest.
  void (*begin_lines_f32)(LineState<float>& state, float* const* memory);
  void (*begin_lines_f64)(LineState<double>& state, double* const* memory);
  void (*put_lines_f32)(const LineJob<float>&);
  void (*put_lines_f64)(const LineJob<double>&);
  void (*end_lines_f32)(const LineState<float>& state, int lane_count, bool streaming);
  void (*end_lines_f64)(const LineState<double>& state, int lane_count, bool streaming);
  Isa (*blend_f32)(const BlendJob<float>&);
  Isa (*blend_f64)(const BlendJob<double>&);
};

}}}  // namespace tessera::abi_0_1::kernel
