#pragma once
// Patch-contiguous output of the grid kernel: values of a block, `[value][lane]`, are transposed for a few lanes at a
// time and joined with the rest of each lane's last vector, so that memory receives only whole aligned vectors, plain
// or streamed. Vectors in which one lane ends and the next begins are assembled at the end.
//
// Needs before it, outside of the instruction set's namespace: kernel/grid/line_kernels.h, kernel/isa/lanes.h.

#include "kernel/store/store.inl.h"

/// Lanes that are transposed at a time: 16 bytes of a row, or half a vector of 64 bytes. Fewer would cost more loads,
/// more would cost more shuffles across a vector, which few ports execute.
template <class L>
inline constexpr int lane_group = (L::width * sizeof(typename L::Scalar) == 64 ? 32 : 16) / sizeof(typename L::Scalar);

template <class L>
void begin_lines(LineState<typename L::Scalar>& state, typename L::Scalar* const* memory) {
  using T = typename L::Scalar;
  for (int l = 0; l < block_lanes; ++l) {
    const int place = static_cast<int>(reinterpret_cast<std::uintptr_t>(memory[l]) / sizeof(T) % L::width);
    state.begin[l] = state.end[l] = place;
    state.next[l] = memory[l] - place;
    state.first[l] = place > 0 ? state.next[l] : nullptr;
  }
}

/// The values that the lanes of a group carry.
template <class L>
struct GroupLines {
  typename L::Batch carry[lane_group<L>];
  typename L::Shift shift[lane_group<L>];
  typename L::Scalar* next[lane_group<L>];
};

/// Writes a vector to memory, or to the state if it is a lane's first one and shared.
template <class L>
[[gnu::always_inline]] inline void put_first(const LineJob<typename L::Scalar>& job, int l, typename L::Scalar* memory,
                                             const typename L::Batch& vector) {
  if (memory == job.state->first[l]) {
    L::store(job.state->head[l], vector);
  } else if (job.streaming) {
    L::stream(memory, vector);
  } else {
    L::store(memory, vector);
  }
}

/// Loads the values of `width` rows for the lanes of a group. Step 0 reads the rows' distance from the job.
template <class L, int Step>
[[gnu::always_inline]] inline void load_group(const LineJob<typename L::Scalar>& job, const typename L::Scalar* rows,
                                              typename L::Batch (&column)[lane_group<L>]) {
  const std::ptrdiff_t step = Step > 0 ? Step : job.step;
  L::load_columns([&](int k) { return rows + k * step; }, column);
}

/// Puts the values of fewer than `width` rows.
template <class L, int Step>
[[gnu::always_inline]] inline void put_rest(const LineJob<typename L::Scalar>& job, const typename L::Scalar* rows,
                                            int l) {
  constexpr int width = L::width;
  LineState<typename L::Scalar>& state = *job.state;
  typename L::Batch column[lane_group<L>];
  load_group<L, Step>(job, rows, column);
#pragma GCC unroll 8
  for (int k = 0; k < lane_group<L>; ++k) {
    const auto shift = L::shift_by(state.end[l + k]);
    auto carry = L::load(state.carry[l + k]), vector = L::shift_in(carry, column[k], shift);
    int end = state.end[l + k] + static_cast<int>(job.count % width);
    if (end >= width) {
      put_first<L>(job, l + k, state.next[l + k], vector);
      vector = L::shift_in(carry, column[k], shift);
      state.next[l + k] += width;
      end -= width;
    }
    L::store(state.carry[l + k], L::carried(vector, L::shift_by(end)));
    state.end[l + k] = end;
  }
}

/// Puts the values of the group of lanes from l on.
template <class L, int Step>
[[gnu::always_inline]] inline void put_group(const LineJob<typename L::Scalar>& job, int l) {
  constexpr int group = lane_group<L>, width = L::width;
  LineState<typename L::Scalar>& state = *job.state;
  GroupLines<L> out;
  int turned = 0;  // 0 if all lanes continue with a whole vector: then nothing is joined
#pragma GCC unroll 8
  for (int k = 0; k < group; ++k) {
    turned |= state.end[l + k];
    out.shift[k] = L::shift_by(state.end[l + k]);
    out.carry[k] = L::load(state.carry[l + k]);
    out.next[k] = state.next[l + k];
  }
  const auto* rows = job.rows + l;
  const std::ptrdiff_t step = Step > 0 ? Step : job.step;
  const std::ptrdiff_t tiles = job.count / width;
  for (std::ptrdiff_t tile = 0; tile < tiles; ++tile, rows += width * step) {
    typename L::Batch column[group];
    load_group<L, Step>(job, rows, column);
    if (turned != 0) {
#pragma GCC unroll 8
      for (int k = 0; k < group; ++k) column[k] = L::shift_in(out.carry[k], column[k], out.shift[k]);
    }
    if (tile == 0) {
      for (int k = 0; k < group; ++k) put_first<L>(job, l + k, out.next[k], column[k]);
    } else if (job.streaming) {
#pragma GCC unroll 8
      for (int k = 0; k < group; ++k) L::stream(out.next[k] + tile * width, column[k]);
    } else {
#pragma GCC unroll 8
      for (int k = 0; k < group; ++k) L::store(out.next[k] + tile * width, column[k]);
    }
  }
#pragma GCC unroll 8
  for (int k = 0; k < group; ++k) {
    L::store(state.carry[l + k], out.carry[k]);
    state.next[l + k] = out.next[k] + tiles * width;
  }
  if (job.count % width > 0) put_rest<L, Step>(job, rows, l);
}

template <class L, int Step>
void put_groups(const LineJob<typename L::Scalar>& job) {
  for (int l = 0; l < job.lane_count; l += lane_group<L>) put_group<L, Step>(job, l);
}

template <class L>
void put_lines(const LineJob<typename L::Scalar>& job) {
  job.step == block_lanes ? put_groups<L, block_lanes>(job) : put_groups<L, 0>(job);
}

/// Writes parts of vectors, one after the other; neighbours in one vector become one store.
template <class L>
class PartialVectors {
 public:
  using T = typename L::Scalar;
  explicit PartialVectors(bool streaming) : streaming_(streaming), vector_(L::broadcast(0)) {}

  /// Puts values begin .. end - 1 of the vector at `memory`.
  [[gnu::always_inline]] void put(T* memory, const typename L::Batch& vector, int begin, int end) {
    if (memory == memory_ && begin == end_) {
      vector_ = xsimd::select(L::load(place) < L::broadcast(static_cast<T>(begin)), vector_, vector);
    } else {
      finish();
      memory_ = memory;
      vector_ = vector;
      begin_ = begin;
    }
    end_ = end;
    if (begin_ > 0 || end_ < L::width) return;
    streaming_ ? L::stream(memory_, vector_) : L::store(memory_, vector_);
    memory_ = nullptr;
  }
  void finish() {
    if (memory_ == nullptr) return;
    if constexpr (requires { L::store_between; }) {
      L::store_between(memory_, vector_, begin_, end_);
    } else {
      alignas(64) T values[L::width];
      L::store(values, vector_);
      for (int k = begin_; k < end_; ++k) memory_[k] = values[k];
    }
    memory_ = nullptr;
  }

 private:
  alignas(64) static constexpr T place[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  bool streaming_;
  T* memory_ = nullptr;
  int begin_ = 0, end_ = 0;
  typename L::Batch vector_;
};

template <class L>
void end_lines(const LineState<typename L::Scalar>& state, int lane_count, bool streaming) {
  PartialVectors<L> partial(streaming);
  for (int l = 0; l < lane_count; ++l) {
    const bool shared = state.first[l] != nullptr, several = state.next[l] != state.first[l];
    const int begin = several ? 0 : state.begin[l];
    if (shared && several) partial.put(state.first[l], L::load(state.head[l]), state.begin[l], L::width);
    if (begin >= state.end[l]) continue;
    auto carry = L::load(state.carry[l]);
    partial.put(state.next[l], L::shift_in(carry, carry, L::shift_by(state.end[l])), begin, state.end[l]);
  }
  partial.finish();
}
