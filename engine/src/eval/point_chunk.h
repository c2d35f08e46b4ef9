#pragma once
// Evaluates a task's share of scattered samples, chunk by chunk, into the caller's records.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include "base/aligned.h"
#include "block/patch_set_impl.h"
#include "eval/quantity_table.h"
#include "kernel/table/kernel_table.h"
#include "tessera/evaluate.h"

namespace tessera { inline namespace abi_0_1 {

/// Data that all chunks of a call share.
template <class T>
struct PointCall {
  const PatchSet::Impl& set;
  const Coefficients<T>& coefficients;
  const kernel::KernelTable& kernels;
  const QuantityViews<T>& out;
  LocalGeometryOptions geometry;
};

/// The samples of a chunk by patch and local parameters. The pointers lead to the caller's arrays, or to `own_patch`,
/// `own_u` and `own_v`. Each array is readable for kernel::point_padding values beyond the last sample.
template <class T>
struct ChunkSamples {
  static constexpr std::size_t capacity = 2048;
  static constexpr std::size_t padding = kernel::point_padding;
  template <class Value>
  using Memory = std::array<Value, capacity + padding>;

  std::size_t begin = 0, count = 0;  ///< which samples of the call
  const std::uint32_t* patch = nullptr;
  const T* u = nullptr;
  const T* v = nullptr;
  alignas(cache_line) Memory<std::uint32_t> own_patch;
  alignas(cache_line) Memory<T> own_u, own_v;
  /// Divisors of derivatives by local parameters: widths of the patch in the surface's parameters.
  bool scaled = false;
  std::array<double, capacity> width_u, width_v;

  /// Points to the chunk's own memory and fills the padding with the last sample.
  void use_own() {
    patch = padded(own_patch, count);
    u = padded(own_u, count);
    v = padded(own_v, count);
  }
  template <class Value>
  static const Value* padded(Memory<Value>& values, std::size_t count) {
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(count), padding, values[count - 1]);
    return values.data();
  }
};

/// Evaluates chunk after chunk. Lives on a task's stack; allocates nothing.
template <class T>
class PointChunk {
 public:
  using Samples = ChunkSamples<T>;

  explicit PointChunk(const PointCall<T>& call) : call_(call), coefficients_(call.coefficients) {
    prepare_job();
    T* next = stage_.data();
    for_each_value_quantity([&](const auto& quantity) {
      const auto& view = quantity.of(call.out);
      if (view.empty()) return;
      Field& field = fields_[field_count_++];
      field = {next, quantity.width, view.stride, {}, quantity.powers};
      std::copy(view.component.begin(), view.component.end(), field.out.begin());
      quantity.of(job_.grid) = next;
      next += std::ptrdiff_t{quantity.width} * lanes * batch;
    });
    std::size_t kind = 0;
    for_each_kind_quantity([&](const auto& quantity) {
      quantity.of(job_.grid) = quantity.of(call.out).empty() ? nullptr : kinds_[kind].data();
      ++kind;
    });
  }
  PointChunk(const PointChunk&) = delete;
  PointChunk& operator=(const PointChunk&) = delete;

  /// The samples to be filled in before the next run().
  Samples& samples() { return samples_; }

  /// Evaluates the samples to their records.
  Isa run() {
    const auto& groups = call_.set.groups;
    if (groups.size() == 1) return run_all(groups.front());
    std::array<std::uint8_t, Samples::capacity> of_group;
    Isa isa = Isa::sse2;
    for (std::size_t k = 0; k < samples_.count; ++k) of_group[k] = 0;
    for (std::size_t k = 0; k < samples_.count; ++k) {
      if (of_group[k]) continue;  // its group is done
      const BlockGroup& group = call_.set.group_of_block(call_.set.slots[samples_.patch[k]].block);
      isa = run_group(group, k, of_group);
    }
    return isa;
  }

 private:
  static constexpr int lanes = kernel::block_lanes;
  static constexpr int batch = kernel::point_slots;  ///< slots in the stage
  static constexpr std::size_t max_fields = value_quantities;
  static constexpr std::size_t stage_rows = 3 * vector_quantities + scalar_quantities;
  /// Patches beyond this many bytes are fetched ahead, to the first-level cache, and further ahead, to the second.
  static constexpr std::size_t near_bytes = 32 << 10, far_bytes = 1 << 20;

  /// A wanted output.
  struct Field {
    T* stage = nullptr;
    int width = 3;
    std::ptrdiff_t stride = 1;
    std::array<T*, 3> out{};
    ParameterPowers powers;
  };

  void prepare_job() {
    kernel::GridJob<T>& grid = job_.grid;
    if constexpr (sizeof(T) == 8) {
      grid.offset[0] = call_.set.origin.x;
      grid.offset[1] = call_.set.origin.y;
      grid.offset[2] = call_.set.origin.z;
    }
    thresholds_.fill(coefficients_.largest_threshold);
    grid.threshold = thresholds_.data();
    grid.lane_threshold = lane_threshold;
    grid.exact_normal = exact_normal;
    grid.exact_context = this;
    const double min_sine = sizeof(T) == 4 ? 1e-6 : 0, smallest_tolerance = sizeof(T) == 4 ? 1e-4 : 0;
    grid.min_sine = static_cast<T>(std::max(call_.geometry.min_sine, min_sine));
    grid.umbilic_tolerance = static_cast<T>(std::max(call_.geometry.umbilic_tolerance, smallest_tolerance));
  }

  /// Evaluates all samples, which belong to one group: no list is needed.
  Isa run_all(const BlockGroup& group) {
    list_ = nullptr;
    count_ = samples_.count;
    job_.patch = samples_.patch;
    job_.u = samples_.u;
    job_.v = samples_.v;
    return run_list(group);
  }

  /// Evaluates the samples of one group, from `first` on, and marks them in `done`.
  Isa run_group(const BlockGroup& group, std::size_t first, std::array<std::uint8_t, Samples::capacity>& done) {
    count_ = 0;
    for (std::size_t k = first; k < samples_.count; ++k) {
      const PatchSet::Slot& slot = call_.set.slots[samples_.patch[k]];
      if (slot.block - group.first_block >= group.block_count) continue;  // unsigned: below it too
      done[k] = 1;
      listed_patch_[count_] =
          static_cast<std::uint32_t>((slot.block - group.first_block) * PatchSet::lanes + slot.lane);
      listed_u_[count_] = samples_.u[k];
      listed_v_[count_] = samples_.v[k];
      indices_[count_++] = static_cast<std::uint32_t>(k);
    }
    list_ = indices_.data();
    job_.patch = Samples::padded(listed_patch_, count_);
    job_.u = Samples::padded(listed_u_, count_);
    job_.v = Samples::padded(listed_v_, count_);
    return run_list(group);
  }

  Isa run_list(const BlockGroup& group) {
    kernel::GridJob<T>& grid = job_.grid;
    grid.degree_u = group.degree_u;
    grid.degree_v = group.degree_v;
    grid.rational = group.rational;
    job_.points = coefficients_.points.data() + group.first_point_value;
    job_.patch_values = group.point_values;
    const std::size_t all_bytes = coefficients_.points.size() * sizeof(T);
    job_.prefetched = all_bytes > near_bytes ? group.point_values * sizeof(T) : 0;
    job_.far = all_bytes > far_bytes;
    job_.count = static_cast<int>(count_);
    job_.next = 0;
    Isa isa = Isa::sse2;
    while (job_.next < job_.count) {
      if constexpr (sizeof(T) == 4) {
        isa = call_.kernels.points_f32(job_);
      } else {
        isa = call_.kernels.points_f64(job_);
      }
      move_out();
    }
    return isa;
  }

  std::size_t sample_of(int slot, int lane) const {
    const std::size_t k = std::min(static_cast<std::size_t>(job_.slots[slot].first + lane), count_ - 1);
    return list_ ? list_[k] : k;
  }

  void move_out() {
    for (const Field& field : std::span(fields_.data(), field_count_)) {
      if (samples_.scaled) scale(field);
      kernel::PointStoreJob<T> store{.stage = field.stage,
                                     .width = field.width,
                                     .slots = job_.slots,
                                     .slot_count = job_.slot_count,
                                     .records = list_,
                                     .stride = field.stride};
      for (std::size_t c = 0; c < static_cast<std::size_t>(field.width); ++c)
        store.out[c] = field.out[c] + static_cast<std::ptrdiff_t>(samples_.begin) * field.stride;
      if constexpr (sizeof(T) == 4) {
        call_.kernels.store_points_f32(store);
      } else {
        call_.kernels.store_points_f64(store);
      }
    }
    std::size_t kind = 0;
    for_each_kind_quantity([&](const auto& quantity) {
      const std::uint8_t* kinds = kinds_[kind++].data();
      const auto& view = quantity.of(call_.out);
      if (view.empty()) return;
      using Kind = std::remove_cvref_t<decltype(view.at(0, 0))>;
      for (int slot = 0; slot < job_.slot_count; ++slot)
        for (int lane = 0; lane < job_.slots[slot].count; ++lane)
          view.at(samples_.begin + sample_of(slot, lane), 0) = static_cast<Kind>(kinds[slot * lanes + lane]);
    });
  }

  /// Turns derivatives by local parameters into derivatives by the surface's. Divides in double, because a width or its
  /// inverse may be out of T's range although the result is in range.
  void scale(const Field& field) {
    for (int c = 0; c < field.width; ++c) {
      const int by_u = field.powers.u[static_cast<std::size_t>(c)], by_v = field.powers.v[static_cast<std::size_t>(c)];
      if (by_u + by_v == 0) continue;
      for (int slot = 0; slot < job_.slot_count; ++slot) {
        T* values = field.stage + (slot * field.width + c) * lanes;
        for (int lane = 0; lane < job_.slots[slot].count; ++lane) {
          const std::size_t k = sample_of(slot, lane);
          double value = values[lane];
          for (int times = 0; times < by_u; ++times) value /= samples_.width_u[k];
          for (int times = 0; times < by_v; ++times) value /= samples_.width_v[k];
          values[lane] = static_cast<T>(value);
        }
      }
    }
  }

  /// See kernel::LaneThreshold.
  static void lane_threshold(void* context, int slot, int lane, T* threshold, T* noise) {
    const auto& self = *static_cast<PointChunk*>(context);
    const PatchSet::Slot at = self.call_.set.slots[self.samples_.patch[self.sample_of(slot, lane)]];
    const auto& own = self.coefficients_.point_threshold[at.block * std::size_t{lanes} + at.lane];
    *threshold = own[1] < 0 ? std::numeric_limits<T>::max() : own[0];
    *noise = own[1];
  }

  /// See kernel::ExactNormal.
  static int exact_normal(void* context, int slot, int, int lane, T* normal) {
    const auto& self = *static_cast<PointChunk*>(context);
    const std::size_t k = self.sample_of(slot, lane);
    const UnitNormal exact =
        unit_normal(self.call_.set.patches[self.samples_.patch[k]], self.samples_.u[k], self.samples_.v[k]);
    normal[0] = static_cast<T>(exact.direction.x);
    normal[1] = static_cast<T>(exact.direction.y);
    normal[2] = static_cast<T>(exact.direction.z);
    return static_cast<int>(exact.kind);
  }

  const PointCall<T>& call_;
  const Coefficients<T>& coefficients_;
  kernel::PointJob<T> job_;
  std::array<Field, max_fields> fields_{};
  std::size_t field_count_ = 0;
  Samples samples_;
  const std::uint32_t* list_ = nullptr;  ///< the samples of the current group; null: all
  std::size_t count_ = 0;                ///< samples of the current group
  typename Samples::template Memory<std::uint32_t> listed_patch_;
  alignas(cache_line) typename Samples::template Memory<T> listed_u_, listed_v_;
  std::array<std::uint32_t, Samples::capacity> indices_;
  alignas(cache_line) std::array<T, lanes> thresholds_;
  alignas(cache_line) std::array<T, stage_rows * lanes * batch> stage_;
  alignas(cache_line) std::array<std::array<std::uint8_t, static_cast<std::size_t>(lanes) * batch>, 2> kinds_;
};

}}  // namespace tessera::abi_0_1
