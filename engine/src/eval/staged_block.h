#pragma once
// A block's outputs on their way from lanes to patch-contiguous views.

#include <algorithm>
#include <array>

#include "base/aligned.h"
#include "kernel/kernel_table.h"
#include "tessera/evaluate.h"

namespace tessera {

/// Evaluates a block piece by piece into a stage of 16 KiB an output and moves each piece to its place, one patch a lane.
/// Where all wanted views are fields of one gapless record (positions and normals interleaved, say), the stage has that record's
/// order, and whole records are moved; otherwise each view goes its own way. Lives on a task's stack; allocates nothing.
template <class T>
class StagedBlock {
 public:
  StagedBlock(const kernel::KernelTable& kernels, const GridViews<T>& out) : kernels_(kernels) {
    for (const View3<T>* view : {&out.position, &out.du, &out.dv, &out.normal}) {
      if (!view->empty()) views_[wanted_++] = *view;
    }
    position_ = slot(out.position);
    du_ = slot(out.du);
    dv_ = slot(out.dv);
    normal_ = slot(out.normal);
    find_record();
  }

  /// Evaluates `job` over its whole grid into records [patch * samples, (patch + 1) * samples) of each lane's patch.
  Isa run(kernel::GridJob<T> job, const std::uint32_t* lane_patches, int lane_count, std::size_t samples) {
    const int count_u = job.u_end, count_v = job.v_end;
    const int piece_v = std::min(count_v, samples_staged);
    const int piece_u = std::max(1, samples_staged / count_v);
    Isa isa = Isa::sse2;
    place_outputs(job);
    for (job.u_begin = 0; job.u_begin < count_u; job.u_begin += piece_u) {
      job.u_end = std::min(count_u, job.u_begin + piece_u);
      for (job.v_begin = 0; job.v_begin < count_v; job.v_begin += piece_v) {
        job.v_end = std::min(count_v, job.v_begin + piece_v);
        if constexpr (sizeof(T) == 4) {
          isa = kernels_.grid_f32(job);
        } else {
          isa = kernels_.grid_f64(job);
        }
        const auto first = static_cast<std::size_t>(job.u_begin) * count_v + job.v_begin;
        const auto count = static_cast<std::size_t>(job.u_end - job.u_begin) * (job.v_end - job.v_begin);
        move_out(lane_patches, lane_count, samples, first, count);
      }
    }
    return isa;
  }

 private:
  static constexpr int lanes = kernel::block_lanes;
  static constexpr std::ptrdiff_t vector_values = 3 * lanes;
  static constexpr int samples_staged = static_cast<int>(16384 / (vector_values * sizeof(T)));

  /// Which of the wanted views this is, or -1.
  int slot(const View3<T>& view) const {
    for (int k = 0; k < wanted_; ++k)
      if (!view.empty() && views_[k].component == view.component) return k;
    return -1;
  }

  static bool packed(const View3<T>& view) {
    return view.component[1] == view.component[0] + 1 && view.component[2] == view.component[0] + 2;
  }

  /// One record holds all views if they share a stride of 3 values a view and fill it without a gap.
  void find_record() {
    T* first = views_[0].component[0];
    for (int k = 1; k < wanted_; ++k) first = std::min(first, views_[k].component[0]);
    std::array<bool, 4> filled{};
    for (int k = 0; k < wanted_; ++k) {
      const View3<T>& view = views_[k];
      const std::ptrdiff_t offset = view.component[0] - first;
      if (!packed(view) || view.stride != 3 * wanted_ || offset % 3 != 0 || offset / 3 >= wanted_ || filled[offset / 3]) return;
      filled[offset / 3] = true;
      field_[k] = static_cast<int>(offset / 3);
    }
    record_ = first;
  }

  void place_outputs(kernel::GridJob<T>& job) {
    const auto place = [&](int view) -> T* {
      if (view < 0) return nullptr;
      return record_ ? stage_.data() + field_[view] * vector_values : stage_.data() + view * vector_values * samples_staged;
    };
    job.position = place(position_);
    job.du = place(du_);
    job.dv = place(dv_);
    job.normal = place(normal_);
    job.sample_step = record_ ? wanted_ * vector_values : vector_values;
  }

  void move_out(const std::uint32_t* lane_patches, int lane_count, std::size_t samples, std::size_t first, std::size_t count) {
    if (record_) {
      const std::size_t width = static_cast<std::size_t>(3 * wanted_);
      return move({.rows = stage_.data(), .row_step = lanes, .count = count * width, .lane_count = lane_count}, lane_patches,
                  [&](std::size_t patch) { return record_ + (patch * samples + first) * width; });
    }
    for (int k = 0; k < wanted_; ++k) {
      const View3<T>& view = views_[k];
      const T* rows = stage_.data() + k * vector_values * samples_staged;
      if (packed(view) && view.stride == 3) {
        move({.rows = rows, .row_step = lanes, .count = 3 * count, .lane_count = lane_count}, lane_patches,
             [&](std::size_t patch) { return view.component[0] + (patch * samples + first) * 3; });
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        move({.rows = rows + c * lanes,
              .row_step = vector_values,
              .count = count,
              .lane_count = lane_count,
              .stride = view.stride},
             lane_patches, [&](std::size_t patch) {
               return view.component[c] + static_cast<std::ptrdiff_t>(patch * samples + first) * view.stride;
             });
      }
    }
  }

  template <class Destination>
  void move(kernel::ScatterJob<T> job, const std::uint32_t* lane_patches, Destination&& destination) {
    T* lane[lanes];
    for (int l = 0; l < job.lane_count; ++l) lane[l] = destination(lane_patches[l]);
    job.lane = lane;
    if constexpr (sizeof(T) == 4) {
      kernels_.scatter_f32(job);
    } else {
      kernels_.scatter_f64(job);
    }
  }

  const kernel::KernelTable& kernels_;
  std::array<View3<T>, 4> views_{};
  std::array<int, 4> field_{};   ///< of each view in the record
  T* record_ = nullptr;          ///< the first value of the shared record, if there is one
  int wanted_ = 0;
  int position_ = -1, du_ = -1, dv_ = -1, normal_ = -1;
  alignas(cache_line) std::array<T, 4 * vector_values * samples_staged> stage_;
};

}  // namespace tessera
