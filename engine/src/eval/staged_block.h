#pragma once
// A block's outputs on their way from lanes to patch-contiguous views.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "base/aligned.h"
#include "eval/grid_outputs.h"

namespace tessera {

/// Evaluates a block piece by piece into a stage of 64 KiB and moves each piece to its place, one patch a lane.
/// Where all wanted views of numbers are fields of one gapless record (positions and normals interleaved, say), the
/// stage has that record's order, and whole records are moved; otherwise each view goes its own way. Lives on a task's
/// stack; allocates nothing.
template <class T>
class StagedBlock {
 public:
  StagedBlock(const kernel::KernelTable& kernels, const GridViews<T>& out) : kernels_(kernels), out_(out) {
    for_each_value_output<T>([&](const auto& output) {
      const auto& view = out.*output.view;
      if (view.empty()) return;
      Field& field = fields_[wanted_++];
      std::copy(view.component.begin(), view.component.end(), field.component.begin());
      field.stride = view.stride;
      field.width = output.width;
      field.job = output.job;
      record_width_ += output.width;
    });
    piece_ = std::min(most_samples, stage_values / (lanes * std::max(record_width_, 1)));
    find_record();
    if (record_) return;
    int first = 0;
    for (Field& field : fields()) {
      field.first = first;
      first += field.width * piece_;
    }
  }

  /// Evaluates `job` over its whole grid into records [patch * samples, (patch + 1) * samples) of each lane's patch.
  Isa run(kernel::GridJob<T> job, const std::uint32_t* lane_patches, int lane_count, std::size_t samples) {
    const int count_u = job.u_end, count_v = job.v_end;
    const int piece_v = std::min(count_v, piece_);
    const int piece_u = std::max(1, piece_ / count_v);
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
        move_kinds(lane_patches, lane_count, samples, first, count);
      }
    }
    return isa;
  }

 private:
  static constexpr int lanes = kernel::block_lanes;
  static constexpr int stage_values = static_cast<int>(65536 / sizeof(T));
  static constexpr int most_samples = static_cast<int>(16384 / (3 * lanes * sizeof(T)));
  static constexpr std::size_t most_fields = std::size(vector_outputs<T>) + std::size(scalar_outputs<T>);

  /// A wanted view.
  struct Field {
    std::array<T*, 3> component{};
    std::ptrdiff_t stride = 1;
    int width = 3;
    T* kernel::GridJob<T>::*job = nullptr;
    int first = 0;  ///< its place in the record, or in the stage, in rows of lanes

    bool packed() const { return width == 1 || (component[1] == component[0] + 1 && component[2] == component[0] + 2); }
  };
  std::span<Field> fields() { return {fields_.data(), static_cast<std::size_t>(wanted_)}; }

  /// One record holds all views if their stride is its width and they fill it without a gap.
  void find_record() {
    if (wanted_ == 0) return;
    T* first = fields_[0].component[0];
    for (const Field& field : fields()) first = std::min(first, field.component[0]);
    std::array<bool, 3 * most_fields> filled{};
    for (Field& field : fields()) {
      const std::ptrdiff_t offset = field.component[0] - first;
      if (!field.packed() || field.stride != record_width_ || offset + field.width > record_width_) return;
      field.first = static_cast<int>(offset);
      for (int c = 0; c < field.width; ++c)
        if (std::exchange(filled[static_cast<std::size_t>(offset + c)], true)) return;
    }
    record_ = first;
  }

  void place_outputs(kernel::GridJob<T>& job) {
    for (const Field& field : fields()) job.*field.job = stage_.data() + std::ptrdiff_t{field.first} * lanes;
    job.vector_step = (record_ ? record_width_ : 3) * lanes;
    job.scalar_step = (record_ ? record_width_ : 1) * lanes;
    std::size_t kind = 0;
    for_each_kind_output<T>([&](const auto& output) {
      job.*output.job = (out_.*output.view).empty() ? nullptr : kinds_[kind].data();
      ++kind;
    });
  }

  void move_out(const std::uint32_t* lane_patches, int lane_count, std::size_t samples, std::size_t first,
                std::size_t count) {
    if (record_) {
      const auto width = static_cast<std::size_t>(record_width_);
      return move({.rows = stage_.data(), .row_step = lanes, .count = count * width, .lane_count = lane_count},
                  lane_patches, [&](std::size_t patch) { return record_ + (patch * samples + first) * width; });
    }
    for (const Field& field : fields()) {
      const T* rows = stage_.data() + std::ptrdiff_t{field.first} * lanes;
      const auto width = static_cast<std::size_t>(field.width);
      if (field.packed() && field.stride == field.width) {
        move({.rows = rows, .row_step = lanes, .count = width * count, .lane_count = lane_count}, lane_patches,
             [&](std::size_t patch) { return field.component[0] + (patch * samples + first) * width; });
        continue;
      }
      for (std::size_t c = 0; c < width; ++c) {
        move({.rows = rows + static_cast<std::ptrdiff_t>(c) * lanes,
              .row_step = field.width * lanes,
              .count = count,
              .lane_count = lane_count,
              .stride = field.stride},
             lane_patches, [&](std::size_t patch) {
               return field.component[c] + static_cast<std::ptrdiff_t>(patch * samples + first) * field.stride;
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

  void move_kinds(const std::uint32_t* lane_patches, int lane_count, std::size_t samples, std::size_t first,
                  std::size_t count) {
    std::size_t stage = 0;
    for_each_kind_output<T>([&](const auto& output) {
      const auto& view = out_.*output.view;
      const std::uint8_t* kinds = kinds_[stage++].data();
      if (view.empty()) return;
      using Kind = std::remove_cvref_t<decltype(view.at(0, 0))>;
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(lane_count); ++lane)
        for (std::size_t k = 0; k < count; ++k)
          view.at(lane_patches[lane] * samples + first + k, 0) = static_cast<Kind>(kinds[k * lanes + lane]);
    });
  }

  const kernel::KernelTable& kernels_;
  const GridViews<T>& out_;
  std::array<Field, most_fields> fields_{};
  T* record_ = nullptr;  ///< the first value of the shared record, if there is one
  int wanted_ = 0;
  int record_width_ = 0;  ///< values of all wanted views
  int piece_ = 0;         ///< samples staged at once
  alignas(cache_line) std::array<T, stage_values> stage_;
  alignas(cache_line) std::array<std::array<std::uint8_t, static_cast<std::size_t>(most_samples) * lanes>, 2> kinds_;
};

}  // namespace tessera
