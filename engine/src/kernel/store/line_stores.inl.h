#pragma once
// Stores of the grids' values, lanes = patches: plain ones, or streamed by whole cache lines.
//
// Needs before it, outside of the instruction set's namespace: kernel/grid/grid_kernels.h, kernel/isa/lanes.h.

#include "kernel/store/store.inl.h"

/// Plain stores, streaming ones, or as the job asks.
enum class Way { plain, streaming, asked };

/// The first line of each output among those of a sample.
enum Line : int {
  position_line = 0,
  du_line = 3,
  dv_line = 6,
  normal_line = 9,
  duu_line = 12,
  duv_line = 15,
  dvv_line = 18,
  first_form_line = 21,
  second_form_line = 24,
  first_direction_line = 27,
  second_direction_line = 30,
  gaussian_line = 33,
  mean_line,
  first_curvature_line,
  second_curvature_line,
  line_count
};

/// The number of vectors in a cache line. Except for positions they are stored together. A line that is streamed in
/// parts waits for its rest in one of about ten buffers of the processor; where a sample has more such lines than there
/// are buffers, they go to memory in parts, at a tenth of the speed.
template <class L>
inline constexpr int line_parts = 64 / static_cast<int>(sizeof(typename L::Scalar)) / L::width;

/// The first vectors of each line, until its last one comes.
template <class L, Way How>
struct WaitingLines {
  alignas(64)
      typename L::Scalar line[How == Way::plain || line_parts<L> == 1 ? 1 : int{line_count}][line_parts<L> * L::width];
};

/// Stores one vector of a block's patches; `Group`, a number or a constant, says which.
template <class L, Way How, class Group>
class LineStores {
 public:
  using T = typename L::Scalar;
  static constexpr int parts = line_parts<L>;
  using Waiting = T (*)[parts * L::width];

  LineStores(bool streaming, Waiting waiting, Group group)
      : streaming_(How == Way::streaming || (How == Way::asked && streaming)), waiting_(waiting), group_(group) {}

  [[gnu::always_inline]] void put(int line, T* memory, const typename L::Batch& vector) const {
    const int part = group_ % parts;
    const bool waits = line >= du_line;
    if (How == Way::plain || (How == Way::asked && !streaming_)) {
      L::store(memory, vector);
    } else if (waits && part + 1 < parts) {
      L::store(waiting_[line] + part * L::width, vector);
    } else {
#pragma GCC unroll 4
      for (int k = 0; waits && k + 1 < parts; ++k)
        L::stream(memory - (parts - 1 - k) * L::width, L::load(waiting_[line] + k * L::width));
      L::stream(memory, vector);
    }
  }
  [[gnu::always_inline]] void put(int line, T* memory, const typename L::Batch (&vector)[3]) const {
    for (int c = 0; c < 3; ++c) put(line + c, memory + c * block_lanes, vector[c]);
  }
  /// Returns these stores for code that is compiled once for all ways.
  [[gnu::always_inline]] LineStores<L, Way::asked, int> asked() const { return {streaming_, waiting_, group_}; }

 private:
  bool streaming_;
  Waiting waiting_;
  Group group_;
};

template <class L>
using AskedStores = LineStores<L, Way::asked, int>;

/// Calls use(group) for each vector of a block, with numbers or constants.
template <int Count, bool Constant, class Use>
[[gnu::always_inline]] inline void for_each_group(Use use) {
  if constexpr (Constant) {
    [&]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) {
      (use(std::integral_constant<int, k>()), ...);
    }
    (std::make_integer_sequence<int, Count>());
  } else {
    for (int group = 0; group < Count; ++group) use(group);
  }
}
