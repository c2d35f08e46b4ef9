#pragma once
// The grid kernel and the line kernel in one loop, for positions and normals of bicubic patches where a vector holds a
// block, lanes = patches. Samples go to a ring of rows in the first-level cache. After each sample a few earlier rows
// leave it, so that their shuffles run beside the next sample's multiply-adds.
//
// Needs before it, outside of the instruction set's namespace: kernel/grid/grid_kernels.h, kernel/grid/line_kernels.h,
// kernel/isa/lanes.h.

#include "kernel/grid/grid_kernel.inl.h"
#include "kernel/grid/line_kernel.inl.h"

/// The rows of a ring, `[row][lane]`, on their way to patch-contiguous memory in units: `width` rows of a few lanes.
template <class L>
class LineRing {
 public:
  using T = typename L::Scalar;

  explicit LineRing(const LineJob<T>& job) : job_(job), state_(*job.state), rows_(job.rows) {
    for (int l = 0; l < L::width; ++l) turned_ |= state_.end[l];
  }
  /// Adds a sample of six rows: at most as much as a unit.
  [[gnu::always_inline]] void put_sample() {
    due_ += 6;
    if (due_ < group) return;
    due_ -= group;
    put_unit();
  }
  /// Puts the rest of `count` rows.
  void finish(int count) {
    while (gone_ + L::width <= count) put_unit();
    for (int l = 0; l < L::width; ++l) {
      if (turned_ != 0 && gone_ > 0 && !state_.first[l]) {
        const auto head = L::load(state_.head[l]);
        job_.streaming ? L::stream(state_.next[l], head) : L::store(state_.next[l], head);
      }
      state_.next[l] += gone_;
    }
    LineJob<T> rest = job_;
    rest.count = count - gone_;
    if (rest.count == 0) return;
    for (int l = 0; l < L::width; l += group) put_rest<L, block_lanes>(rest, rows_ + l, l);
  }

 private:
  /// Lanes of a unit: the number of rows that it would have with all lanes.
  static constexpr int group = lane_group<L>;
  static_assert(L::width == block_lanes && 2 * group == L::width && group >= 6);
  /// Rows by which units stay behind: 14 wait for a normal or belong to a unit's other lanes, and more have hardly left
  /// the stores' buffer.
  static constexpr int lag = 32;

  [[gnu::always_inline]] void put_unit() {
    const int l = lane_;
    typename L::Batch column[group];
    load_group<L, block_lanes>(job_, rows_ + l, column);
    if (turned_ != 0) {
#pragma GCC unroll 8
      for (int k = 0; k < group; ++k) {
        auto carry = L::load(state_.carry[l + k]);
        const auto vector = L::shift_in(carry, column[k], L::shift_by(state_.end[l + k]));
        L::store(state_.carry[l + k], carry);
        column[k] = vector;
      }
    }
    if (turned_ != 0 && gone_ == 0) {  // most of them are shared
#pragma GCC unroll 8
      for (int k = 0; k < group; ++k) L::store(state_.head[l + k], column[k]);
    } else if (job_.streaming) {
#pragma GCC unroll 8
      for (int k = 0; k < group; ++k) L::stream(state_.next[l + k] + gone_, column[k]);
    } else {
#pragma GCC unroll 8
      for (int k = 0; k < group; ++k) L::store(state_.next[l + k] + gone_, column[k]);
    }
    lane_ = group - l;
    if (l == 0) return;
    gone_ += L::width;
    rows_ += L::width * block_lanes;
    if (rows_ == job_.rows + mesh_line_rows * block_lanes) rows_ = job_.rows;
  }

  const LineJob<T>& job_;
  LineState<T>& state_;
  int lane_ = 0, due_ = -lag;
  int turned_ = 0;  ///< 0 if all lanes begin with a line: then nothing is joined
  std::ptrdiff_t gone_ = 0;
  const T* rows_;
};

template <class L>
Isa mesh_lines(const GridJob<typename L::Scalar>& job, const LineJob<typename L::Scalar>& lines) {
  constexpr int samples = mesh_line_rows / 6, count = 4;
  const LineStores<L, Way::plain, int> stores(false, nullptr, 0);
  RowCurves<L, 1, 3, count> curves;
  DeferredNormals<L, Wanted::mesh> normals;
  LineRing<L> ring(lines);
  std::ptrdiff_t at = 0;
  int sample = 0;
  Offsets next{0, 0, 0};  // after the sample before, if the ring did not wrap
  const auto* next_net = job.net + count * count * 3 * block_lanes;
  for (int iu = job.u_begin; iu < job.u_end; ++iu) {
    prefetch_lines(next_net, iu * job.prefetched_lines, job.prefetched_lines);
    row_curves<L, 3>(job.net, job.u_weights + std::ptrdiff_t{iu} * 3 * count, count, count, curves);
    for (int iv = job.v_begin; iv < job.v_end; ++iv) {
      Sample<L> now;
      evaluate_sample<L, 1>(curves, job.v_weights + std::ptrdiff_t{iv} * 3 * count, count, now);
      store_position<L>(job, at, now, stores);
      normals.begin(job, now, 0, next, stores);
      ring.put_sample();
      next = {at + job.vector_step, 0, next.byte + block_lanes};
      at = ++sample % samples == 0 ? 0 : next.vector;
    }
  }
  normals.finish(job, 0, next, stores);
  ring.finish(6 * sample);
  return this_isa;
}
