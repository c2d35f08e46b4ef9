#pragma once
// Block-interleaved outputs: their checks, and where a kernel finds them.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "base/aligned.h"
#include "eval/quantity_table.h"
#include "kernel/table/kernel_table.h"
#include "tessera/evaluate.h"

namespace tessera { inline namespace abi_0_1 {

/// The memory of the outputs of one call. Output after output is added; one that overlaps an earlier one is an error.
class BlockMemory {
 public:
  template <class T>
  Status add(const char* name, std::span<T> memory) {
    const Range range{name, reinterpret_cast<std::uintptr_t>(memory.data()), memory.size_bytes()};
    for (const Range& other : std::span(ranges_).first(count_))
      if (range.begin < other.begin + other.bytes && other.begin < range.begin + range.bytes)
        return Status(StatusCode::invalid_argument, std::string(other.name) + " and " + name + " share memory");
    ranges_.at(count_++) = range;
    return {};
  }

 private:
  struct Range {
    const char* name;
    std::uintptr_t begin;
    std::size_t bytes;
  };
  std::array<Range, 24> ranges_{};
  std::size_t count_ = 0;
};

/// Checks size, alignment and overlap of the outputs. Errors: those of evaluate().
template <class T>
Status check_blocks(const GridPlan& plan, const QuantityBlocks<T>& out) {
  Status status;
  BlockMemory all;
  for_each_quantity([&](const auto& quantity) {
    const auto memory = quantity.of(out);
    if (memory.data() == nullptr || !status.ok()) return;
    const std::size_t needed = plan.block_capacity() / 3 * static_cast<std::size_t>(quantity.width);
    if (memory.size() < needed)
      status = Status(StatusCode::buffer_too_small, std::string(quantity.name) + " needs " + std::to_string(needed) +
                                                        " values, not " + std::to_string(memory.size()));
    else if (reinterpret_cast<std::uintptr_t>(memory.data()) % cache_line != 0)
      status = Status(StatusCode::invalid_argument, std::string(quantity.name) + " must be aligned to 64 bytes");
    else
      status = all.add(quantity.name, memory.first(needed));
  });
  return status;
}

/// The wanted outputs in blocks; place() points a job at the part of each that belongs to its samples.
template <class T>
class BlockOutputs {
  using Outputs = kernel::GridJobOutputs<T>;

 public:
  explicit BlockOutputs(const QuantityBlocks<T>& out) {
    for_each_value_quantity([&](const auto& quantity) {
      const auto memory = quantity.of(out);
      if (!memory.empty())
        values_[value_count_++] = {quantity.template member<Outputs>(), memory.data(),
                                   static_cast<std::size_t>(quantity.width)};
    });
    for_each_kind_quantity([&](const auto& quantity) {
      const auto memory = quantity.of(out);
      if (!memory.empty())
        kinds_[kind_count_++] = {quantity.template member<Outputs>(), reinterpret_cast<std::uint8_t*>(memory.data())};
    });
  }
  /// Points the job at the samples from `first` on.
  void place(std::size_t first, kernel::GridJob<T>& job) const {
    for (const Values& output : std::span(values_).first(value_count_))
      job.*output.job = output.memory + first * output.width;
    for (const Kinds& output : std::span(kinds_).first(kind_count_)) job.*output.job = output.memory + first;
  }

 private:
  struct Values {
    T* Outputs::*job;
    T* memory;
    std::size_t width;
  };
  struct Kinds {
    std::uint8_t* Outputs::*job;
    std::uint8_t* memory;
  };
  std::array<Values, value_quantities> values_;
  std::array<Kinds, kind_quantities> kinds_;
  std::size_t value_count_ = 0, kind_count_ = 0;
};

}}  // namespace tessera::abi_0_1
