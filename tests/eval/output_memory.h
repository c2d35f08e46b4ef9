#pragma once
// Memory for any choice of outputs, filled with a pattern before, so that every value not written and every write
// elsewhere shows.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "base/aligned.h"
#include "support/grids.h"

namespace tessera::test {

/// A choice of outputs: a bit for each, in the order of for_each_quantity().
using OutputMask = std::uint32_t;
inline constexpr std::size_t output_count = value_quantities + kind_quantities;
inline constexpr OutputMask every_output = (OutputMask{1} << output_count) - 1;

/// The choices of up to `most` outputs, of one at least, and those of all outputs but up to `most`.
inline std::vector<OutputMask> masks_of(int most) {
  std::vector<OutputMask> masks;
  for (OutputMask mask = 1; mask <= every_output; ++mask)
    if (std::popcount(mask) <= most || std::popcount(mask) + most >= int{output_count}) masks.push_back(mask);
  return masks;
}

/// How views lie in memory.
enum class Layout : std::uint8_t {
  arrays,   ///< an array for each output
  columns,  ///< an array for each component
  records,  ///< all chosen outputs of a record side by side
  gaps,     ///< records with room for all outputs, and some that nobody has
};

/// The values of outputs: `[output]` the bytes of all records.
using OutputBytes = std::vector<std::vector<std::byte>>;

/// Calls visit(output, quantity, bytes per component) for each output.
template <class T, class Visit>
void for_each_output(Visit visit) {
  std::size_t output = 0;
  for_each_value_quantity([&](const auto& quantity) { visit(output++, quantity, sizeof(T)); });
  for_each_kind_quantity([&](const auto& quantity) { visit(output++, quantity, sizeof(NormalKind)); });
}
constexpr bool has(OutputMask mask, std::size_t output) { return mask >> output & 1u; }

/// Views of a choice of outputs.
template <class T>
class ViewMemory {
 public:
  ViewMemory(Layout layout, OutputMask mask, std::size_t records) : mask_(mask), records_(records) {
    // Alignments change with the choice; a record of kinds is one byte.
    std::size_t end = guard + mask % 7, in_record = 0, record = 0;
    std::size_t kinds_end = guard;
    for_each_output<T>([&](std::size_t output, const auto& quantity, std::size_t size) {
      const auto width = static_cast<std::size_t>(quantity.width);
      if (layout == Layout::gaps || has(mask, output)) record += size == sizeof(T) ? width : 0;
    });
    if (layout == Layout::gaps) record += 3;
    for_each_output<T>([&](std::size_t output, const auto& quantity, std::size_t size) {
      const auto width = static_cast<std::size_t>(quantity.width);
      const bool is_kind = size != sizeof(T);
      Place& place = places_[output];
      if (is_kind) {
        place = {kinds_end, 1, 1};
        kinds_end += records + guard;
      } else if (layout == Layout::arrays) {
        place = {end, width, 1};
        end += has(mask, output) ? width * records + output % 3 : 0;
      } else if (layout == Layout::columns) {
        place = {end, 1, records + 1};
        end += has(mask, output) ? width * (records + 1) : 0;
      } else {
        place = {end + in_record, record, 1};
        in_record += layout == Layout::gaps || has(mask, output) ? width : 0;
      }
    });
    if (layout == Layout::records || layout == Layout::gaps) end += record * records;
    values_.assign(end + guard, pattern);
    kinds_.assign(kinds_end, kind_pattern);
  }

  /// Views of the chosen outputs.
  QuantityViews<T> views() {
    QuantityViews<T> out;
    for_each_output<T>([&](std::size_t output, const auto& quantity, std::size_t) {
      if (!has(mask_, output)) return;
      auto& view = quantity.of(out);
      const Place& place = places_[output];
      using Value = std::remove_reference_t<decltype(*view.component[0])>;
      for (std::size_t c = 0; c < view.component.size(); ++c)
        view.component[c] = base<Value>() + place.first + c * place.component;
      view.stride = static_cast<std::ptrdiff_t>(place.step);
      view.size = records_;
    });
    return out;
  }
  /// Returns the values of an output.
  std::vector<std::byte> bytes(std::size_t output) const {
    std::vector<std::byte> bytes;
    for_places(output, [&](std::size_t size, std::size_t at) {
      const std::byte* const from = start(size) + size * at;
      bytes.insert(bytes.end(), from, from + size);
    });
    return bytes;
  }
  /// Whether the chosen outputs have these values in the records that are `written`, and all other memory has the
  /// pattern. `written`: by record; empty: all.
  bool holds(const OutputBytes& all, std::span<const std::uint8_t> written) const {
    ViewMemory expected = *this;
    std::ranges::fill(expected.values_, pattern);
    std::ranges::fill(expected.kinds_, kind_pattern);
    for (std::size_t output = 0; output < output_count; ++output) {
      if (!has(mask_, output)) continue;
      const std::byte* from = all[output].data();
      std::size_t k = 0;
      const std::size_t width = all[output].size() / records_;
      for_places(output, [&](std::size_t size, std::size_t at) {
        const std::size_t record = k++ * size / width;
        if (written.empty() || written[record]) std::memcpy(expected.start(size) + size * at, from, size);
        from += size;
      });
    }
    return std::memcmp(values_.data(), expected.values_.data(), values_.size() * sizeof(T)) == 0 &&
           kinds_ == expected.kinds_;
  }

 private:
  static constexpr std::size_t guard = 40;
  static constexpr T pattern = T(-7.25);
  static constexpr std::uint8_t kind_pattern = 9;
  struct Place {
    std::size_t first = 0, step = 1, component = 1;
  };

  template <class Value>
  Value* base() {
    return reinterpret_cast<Value*>(start(sizeof(Value)));
  }
  std::byte* start(std::size_t size) { return const_cast<std::byte*>(std::as_const(*this).start(size)); }
  const std::byte* start(std::size_t size) const {
    return size == sizeof(T) ? reinterpret_cast<const std::byte*>(values_.data())
                             : reinterpret_cast<const std::byte*>(kinds_.data());
  }
  /// Calls visit(bytes of a value, its place) for all values of an output, record by record.
  template <class Visit>
  void for_places(std::size_t wanted, Visit visit) const {
    for_each_output<T>([&](std::size_t output, const auto& quantity, std::size_t size) {
      if (output != wanted) return;
      const Place& place = places_[output];
      for (std::size_t k = 0; k < records_; ++k)
        for (std::size_t c = 0; c < static_cast<std::size_t>(quantity.width); ++c)
          visit(size, place.first + k * place.step + c * place.component);
    });
  }

  OutputMask mask_;
  std::size_t records_;
  std::array<Place, output_count> places_{};
  std::vector<T> values_;
  std::vector<std::uint8_t> kinds_;
};

/// Blocks of a choice of outputs. A record is all lanes of a sample.
template <class T>
class BlockMemory {
 public:
  /// `records`: the samples of all blocks.
  BlockMemory(OutputMask mask, std::size_t records) : mask_(mask) {
    for_each_output<T>([&](std::size_t output, const auto& quantity, std::size_t size) {
      if (has(mask, output))
        outputs_[output].assign(
            static_cast<std::size_t>(quantity.width) * PatchSet::lanes * records * size + 2 * cache_line, pattern);
    });
  }

  QuantityBlocks<T> blocks() {
    QuantityBlocks<T> out;
    for_each_output<T>([&](std::size_t output, const auto& quantity, std::size_t size) {
      if (!has(mask_, output)) return;
      auto& span = quantity.of(out);
      using Value = std::remove_reference_t<decltype(span[0])>;
      span = {reinterpret_cast<Value*>(outputs_[output].data() + cache_line),
              (outputs_[output].size() - 2 * cache_line) / size};
    });
    return out;
  }
  std::vector<std::byte> bytes(std::size_t output) const {
    return {outputs_[output].begin() + cache_line, outputs_[output].end() - cache_line};
  }
  /// Works like ViewMemory::holds(). `written`: by record, each a sample of a block.
  bool holds(const OutputBytes& all, std::span<const std::uint8_t> written) const {
    for (std::size_t output = 0; output < output_count; ++output) {
      if (!has(mask_, output)) continue;
      const std::byte* const own = outputs_[output].data();
      const std::size_t size = all[output].size();
      const auto is_pattern = [&](const std::byte* from, std::size_t count) {
        return std::all_of(from, from + count, [](std::byte b) { return b == pattern; });
      };
      if (!is_pattern(own, cache_line) || !is_pattern(own + cache_line + size, cache_line)) return false;
      const std::size_t records = written.empty() ? 1 : written.size(), record = size / records;
      for (std::size_t k = 0; k < records; ++k) {
        const std::byte* const at = own + cache_line + k * record;
        if (written.empty() || written[k] ? std::memcmp(at, all[output].data() + k * record, record) != 0
                                          : !is_pattern(at, record))
          return false;
      }
    }
    return true;
  }

 private:
  static constexpr std::byte pattern{0xa7};
  OutputMask mask_;
  std::array<AlignedVector<std::byte>, output_count> outputs_;
};

}  // namespace tessera::test
