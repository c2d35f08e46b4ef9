#pragma once
// Moves a block's outputs from lanes to patch-contiguous views, through a stage in the first or second level cache.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "base/aligned.h"
#include "eval/quantity_table.h"
#include "eval/run_grid.h"
#include "kernel/table/kernel_table.h"
#include "tessera/evaluate.h"

namespace tessera { inline namespace abi_0_1 {

/// The kernels that write lines, chosen by precision.
template <class T>
struct LineKernels {
  const kernel::KernelTable& kernels;

  void begin(kernel::LineState<T>& state, T* const* memory) const {
    if constexpr (sizeof(T) == 4) {
      kernels.begin_lines_f32(state, memory);
    } else {
      kernels.begin_lines_f64(state, memory);
    }
  }
  void put(const kernel::LineJob<T>& job) const {
    if constexpr (sizeof(T) == 4) {
      kernels.put_lines_f32(job);
    } else {
      kernels.put_lines_f64(job);
    }
  }
  void end(const kernel::LineState<T>& state, int lane_count, bool streaming) const {
    if constexpr (sizeof(T) == 4) {
      kernels.end_lines_f32(state, lane_count, streaming);
    } else {
      kernels.end_lines_f64(state, lane_count, streaming);
    }
  }
};

/// The order of the values in the stage, and how they get from there to the caller's views:
/// - no stage for positions and normals in floats that begin records with a gap after them (vertices of position,
///   normal and uv, say): see GridKernels::grid_records_f32;
/// - one array for all views of numbers, if these are the fields of one record without gaps (positions and normals
///   interleaved, say);
/// - otherwise one array for each packed view, and one for each component of a structure of arrays;
/// - a column for each other component: it is written value by value, `stride` apart.
template <class T>
class StageLayout {
 public:
  static constexpr int lanes = kernel::block_lanes;
  static constexpr std::size_t max_fields = value_quantities;
  static constexpr std::size_t max_arrays = 3 * max_fields;

  /// A wanted view.
  struct Field {
    std::array<T*, 3> component{};
    std::ptrdiff_t stride = 1;
    int width = 3;
    T* kernel::GridJobOutputs<T>::*job = nullptr;
    int first = 0;            ///< its place in the record or in the stage, in rows of lanes
    int array = -1;           ///< the first of its arrays; -1 if it goes out by columns
    std::ptrdiff_t step = 1;  ///< rows of lanes between the values of an array

    bool packed() const { return width == 1 || (component[1] == component[0] + 1 && component[2] == component[0] + 2); }
  };
  /// `width` values a record, `step` rows of lanes apart in the stage; record k of an array lies at memory + k * width,
  /// of a column at memory + k * stride.
  struct Array {
    T* memory = nullptr;
    std::ptrdiff_t width = 1, stride = 1, first = 0, step = 1;
  };

  StageLayout(const QuantityViews<T>& out, Isa isa) : rows_(isa == Isa::avx512 ? stage_rows / 4 : stage_rows) {
    for_each_value_quantity([&](const auto& quantity) {
      const auto& view = quantity.of(out);
      if (view.empty()) return;
      Field& field = fields_[field_count_++];
      std::copy(view.component.begin(), view.component.end(), field.component.begin());
      field.stride = view.stride;
      field.width = quantity.width;
      field.job = quantity.template member<kernel::GridJobOutputs<T>>();
      record_width_ += quantity.width;
    });
    if (find_record()) return;
    find_vertices(out);
    int first = 0;
    for (Field& field : std::span(fields_).first(field_count_)) {
      field.first = first;
      first += field.width * (longest_piece() + static_cast<int>(lanes));
      find_arrays(field);
    }
  }

  std::span<const Field> fields() const { return std::span(fields_).first(field_count_); }
  std::span<const Array> arrays() const { return std::span(arrays_).first(array_count_); }
  std::span<const Array> columns() const { return std::span(columns_).first(column_count_); }
  bool one_record() const { return one_record_; }
  /// Whether the views are positions and normals at the start of records that are longer.
  bool has_vertices() const { return has_vertices_; }
  int record_width() const { return record_width_; }  ///< values of all wanted views
  /// Samples that are staged at once, if rows of the grid divide evenly: enough that the cost of the calls is small,
  /// and so few that their stores overlap with the next computation.
  int piece() const { return std::clamp(rows_ / std::max(record_width_, 1), min_samples, max_samples / 2); }
  /// The most samples that are staged at once. Longer pieces avoid that a row is cut: both parts compute its curves.
  int longest_piece() const { return 2 * piece(); }

  /// Vectors of 64 bytes are whole lines: with 12 kB of floats or 18 kB of doubles a first-level cache of 32 kB holds
  /// the net and the weights as well. Shorter vectors get four times as much, in the second level: runs of each array
  /// are then longer, and fewer lines are streamed in two parts. A Xeon streams tangents twice as fast with it.
  static constexpr int min_samples = 16, stage_rows = sizeof(T) == 4 ? 768 : 576;
  static constexpr int max_samples = 2 * stage_rows / 3;  ///< the most that longest_piece() is: kinds have this room
  /// The most rows in the stage, with those that a tile may reach beyond the last.
  static constexpr std::size_t max_rows =
      2 * std::max<std::size_t>(min_samples * max_arrays, stage_rows) + 3 * lanes * (max_fields + 1);

 private:
  /// One record holds all views if their stride is its width and they fill it without a gap.
  bool find_record() {
    if (field_count_ == 0) return false;
    T* first = fields_[0].component[0];
    for (const Field& field : fields()) first = std::min(first, field.component[0]);
    std::array<bool, max_arrays> filled{};
    for (Field& field : std::span(fields_).first(field_count_)) {
      const std::ptrdiff_t offset = field.component[0] - first;
      if (!field.packed() || field.stride != record_width_ || offset + field.width > record_width_) return false;
      field.first = static_cast<int>(offset);
      field.array = 0;
      for (int c = 0; c < field.width; ++c)
        if (std::exchange(filled[static_cast<std::size_t>(offset + c)], true)) return false;
    }
    arrays_[array_count_++] = {first, record_width_, record_width_, 0, 1};
    return one_record_ = true;
  }

  void find_vertices(const QuantityViews<T>& out) {
    const auto starts_with = [](const View3<T>& view, const T* first) {
      return view.component[0] == first && view.component[1] == first + 1 && view.component[2] == first + 2;
    };
    const View3<T>&position = out.position, &normal = out.normal;
    has_vertices_ = sizeof(T) == 4 && field_count_ == 2 && !position.empty() && !normal.empty() &&
                    position.stride > record_width_ && normal.stride == position.stride &&
                    starts_with(position, position.component[0]) && starts_with(normal, position.component[0] + 3);
  }

  void find_arrays(Field& field) {
    if (field.stride == field.width ? field.packed() : field.stride == 1) field.array = static_cast<int>(array_count_);
    if (field.packed() && field.stride == field.width) {
      arrays_[array_count_++] = {field.component[0], field.width, field.width, field.first, 1};
      return;
    }
    for (int c = 0; c < field.width; ++c) {
      const Array array{field.component[static_cast<std::size_t>(c)], 1, field.stride, field.first + c, field.width};
      (field.stride == 1 ? arrays_[array_count_++] : columns_[column_count_++]) = array;
    }
    field.step = field.width;
  }

  int rows_;  ///< values of a lane that a piece has room for
  std::array<Field, max_fields> fields_{};
  std::array<Array, max_arrays> arrays_{}, columns_{};
  std::size_t field_count_ = 0, array_count_ = 0, column_count_ = 0;
  int record_width_ = 0;
  bool one_record_ = false, has_vertices_ = false;
};

/// Evaluates a block piece by piece into the stage, and writes each piece to the records of its patches, one patch per
/// lane. Lives on a task's stack, where its memory begins uninitialised; allocates nothing.
template <class T>
class StagedBlock {
 public:
  StagedBlock(const kernel::KernelTable& kernels, const StageLayout<T>& layout, const QuantityViews<T>& out,
              bool streaming)
      : kernels_(kernels), lines_{kernels}, layout_(layout), out_(out), streaming_(streaming) {}
  StagedBlock(const StagedBlock&) = delete;
  StagedBlock& operator=(const StagedBlock&) = delete;

  /// Points a job at the stage.
  void place_outputs(kernel::GridJob<T>& job) {
    job.vector_step = (layout_.one_record() ? layout_.record_width() : 3) * lanes;
    job.scalar_step = (layout_.one_record() ? layout_.record_width() : 1) * lanes;
    std::size_t kind = 0;
    for_each_kind_quantity([&](const auto& quantity) {
      quantity.of(job) = quantity.of(out_).empty() ? nullptr : kinds_[kind].data();
      ++kind;
    });
  }

  /// Evaluates a job that place_outputs() has seen over rows first_u .. end_u - 1 of a grid of `count_v` columns, into
  /// the records of each lane's patch; a patch has `samples` records. Unused lanes repeat a patch and write its values.
  Isa run(kernel::GridJob<T>& job, int first_u, int end_u, int count_v, const std::uint32_t* lane_patches,
          int lane_count, std::size_t samples) {
    std::ptrdiff_t records[lanes];
    for (int lane = 0; lane < lanes; ++lane)
      records[lane] = static_cast<std::ptrdiff_t>(lane_patches[lane] * samples) + std::ptrdiff_t{first_u} * count_v;
    const int parts_v = count_v <= layout_.longest_piece() ? 1 : (count_v + layout_.piece() - 1) / layout_.piece();
    const int piece_v = (count_v + parts_v - 1) / parts_v, piece_u = std::max(1, layout_.piece() / count_v);
    Isa isa = Isa::sse2;
    job.lane_count = lane_count;
    if (is_vertices(job)) return run_vertices(job, first_u, end_u, count_v, records);
    begin(records);
    if (is_mesh(job)) return run_mesh(job, first_u, end_u, count_v, lane_count);
    for (job.u_begin = first_u; job.u_begin < end_u; job.u_begin += piece_u) {
      job.u_end = std::min(end_u, job.u_begin + piece_u);
      for (job.v_begin = 0; job.v_begin < count_v; job.v_begin += piece_v) {
        job.v_end = std::min(count_v, job.v_begin + piece_v);
        place_fields(job);
        isa = run_grid(kernels_, job);
        const std::ptrdiff_t first = std::ptrdiff_t{job.u_begin - first_u} * count_v + job.v_begin;
        const std::ptrdiff_t count = std::ptrdiff_t{job.u_end - job.u_begin} * (job.v_end - job.v_begin);
        put(count, lane_count, job.u_end == end_u && job.v_end == count_v);
        put_columns(records, lane_count, first, count);
        put_kinds(records, lane_count, first, count);
      }
    }
    for (std::size_t k = 0; k < layout_.arrays().size(); ++k) lines_.end(states_[k], lane_count, streaming_);
    return isa;
  }

 private:
  static constexpr std::ptrdiff_t lanes = kernel::block_lanes;
  using Layout = StageLayout<T>;

  void begin(const std::ptrdiff_t* records) {
    std::size_t k = 0;
    for (const auto& array : layout_.arrays()) {
      T* memory[lanes];
      for (int lane = 0; lane < lanes; ++lane) memory[lane] = array.memory + records[lane] * array.width;
      waiting_[k] = 0;
      lines_.begin(states_[k++], memory);
    }
  }

  /// Whether one kernel can compute and write the outputs: positions and normals, interleaved, of bicubic patches that
  /// have their parameters in common.
  bool is_mesh(const kernel::GridJob<T>& job) const {
    if constexpr (sizeof(T) != 4 || planted_slowdown > 0) return false;
    return kernels_.mesh_lines_f32 && layout_.one_record() && layout_.record_width() == 6 && !out_.position.empty() &&
           !out_.normal.empty() && job.degree_u == 3 && job.degree_v == 3 && !job.rational && !job.by_lane &&
           !job.normal_kind && !job.curvature_kind;
  }
  Isa run_mesh(kernel::GridJob<T>& job, int first_u, int end_u, int count_v, int lane_count) {
    job.u_begin = first_u;
    job.u_end = end_u;
    job.v_begin = 0;
    job.v_end = count_v;
    place_fields(job);
    Isa isa = Isa::sse2;
    if constexpr (sizeof(T) == 4)
      isa = kernels_.mesh_lines_f32(job, {.state = states_.data(),
                                          .rows = stage_.data(),
                                          .count = 0,
                                          .lane_count = lane_count,
                                          .streaming = streaming_});
    lines_.end(states_[0], lane_count, streaming_);
    return isa;
  }

  /// Whether samples go straight to records with a gap: patches must have their parameters in common.
  bool is_vertices(const kernel::GridJob<T>& job) const {
    if constexpr (sizeof(T) != 4 || planted_slowdown > 0) return false;
    return layout_.has_vertices() && !job.by_lane && !job.normal_kind && !job.curvature_kind;
  }
  Isa run_vertices(kernel::GridJob<T>& job, int first_u, int end_u, int count_v, const std::ptrdiff_t* records) {
    job.u_begin = first_u;
    job.u_end = end_u;
    job.v_begin = 0;
    job.v_end = count_v;
    if constexpr (sizeof(T) == 4) {
      kernel::RecordJob out;
      out.stride = out_.position.stride;
      for (int lane = 0; lane < lanes; ++lane) out.out[lane] = out_.position.component[0] + records[lane] * out.stride;
      return kernels_.grid_records_f32(job, out);
    }
    return Isa::sse2;
  }

  /// Points the job at the first free row of each array, after the rows that wait in the stage.
  void place_fields(kernel::GridJob<T>& job) {
    for (const auto& field : layout_.fields()) {
      const std::ptrdiff_t waiting = field.array < 0 ? 0 : waiting_[static_cast<std::size_t>(field.array)] * field.step;
      job.*field.job = stage_.data() + (field.first + waiting) * lanes;
    }
  }

  /// Writes whole tiles of `lanes` rows. The rest waits for the next piece, unless this one is the last.
  void put(std::ptrdiff_t count, int lane_count, bool last) {
    std::size_t k = 0;
    for (const auto& array : layout_.arrays()) {
      const std::ptrdiff_t rows = waiting_[k] + count * array.width, gone = last ? rows : rows / lanes * lanes;
      T* stage = stage_.data() + array.first * lanes;
      waiting_[k] = rows - gone;
      kernel::LineState<T>& state = states_[k++];
      if (gone == 0) continue;
      lines_.put({.state = &state,
                  .rows = stage,
                  .step = array.step * lanes,
                  .count = gone,
                  .lane_count = lane_count,
                  .streaming = streaming_});
      for (std::ptrdiff_t row = 0; row < rows - gone; ++row)
        std::copy_n(stage + (gone + row) * array.step * lanes, lanes, stage + row * array.step * lanes);
    }
  }

  void put_columns(const std::ptrdiff_t* records, int lane_count, std::ptrdiff_t first, std::ptrdiff_t count) {
    for (const auto& column : layout_.columns())
      for (int lane = 0; lane < lane_count; ++lane) {
        const T* value = stage_.data() + column.first * lanes + lane;
        T* out = column.memory + (records[lane] + first) * column.stride;
        for (std::ptrdiff_t k = 0; k < count; ++k) out[k * column.stride] = value[k * column.step * lanes];
      }
  }

  void put_kinds(const std::ptrdiff_t* records, int lane_count, std::ptrdiff_t first, std::ptrdiff_t count) {
    std::size_t stage = 0;
    for_each_kind_quantity([&](const auto& quantity) {
      const auto& view = quantity.of(out_);
      const std::uint8_t* kinds = kinds_[stage++].data();
      if (view.empty()) return;
      using Kind = std::remove_cvref_t<decltype(view.at(0, 0))>;
      for (int lane = 0; lane < lane_count; ++lane)
        for (std::ptrdiff_t k = 0; k < count; ++k)
          view.at(static_cast<std::size_t>(records[lane] + first + k), 0) = static_cast<Kind>(kinds[k * lanes + lane]);
    });
  }

  const kernel::KernelTable& kernels_;
  LineKernels<T> lines_;
  const Layout& layout_;
  const QuantityViews<T>& out_;
  bool streaming_;
  alignas(cache_line) std::array<T, Layout::max_rows * lanes> stage_;
  std::array<kernel::LineState<T>, Layout::max_arrays> states_;
  std::array<std::ptrdiff_t, Layout::max_arrays>
      waiting_;  ///< rows at the start of each array that are not written yet
  alignas(cache_line) std::array<std::array<std::uint8_t, Layout::max_samples * lanes>, 2> kinds_;
};

}}  // namespace tessera::abi_0_1
