// The patch-contiguous output path of each ISA: pieces of every length, any place in a vector, any number of lanes, and
// nothing written beyond their ends.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "base/aligned.h"
#include "kernel/table/kernel_table.h"

namespace tessera::test { namespace {

template <class T>
struct Kernels {
  void (*begin)(kernel::LineState<T>&, T* const*);
  void (*put)(const kernel::LineJob<T>&);
  void (*end)(const kernel::LineState<T>&, int, bool);
};

/// Writes `pieces` values each into lanes that begin `first` values into memory and lie `gap` values apart.
struct Way {
  std::vector<std::size_t> pieces;
  int lanes = 16;
  std::ptrdiff_t step = 16;
  std::size_t first = 0, gap = 0;
  bool streaming = false;
};

template <class T>
void check(const Kernels<T>& kernels, const Way& way) {
  constexpr std::size_t all = kernel::block_lanes;
  const auto used = static_cast<std::size_t>(way.lanes);
  std::size_t total = 0;
  for (const std::size_t count : way.pieces) total += count;
  const std::size_t distance = total + way.gap;
  AlignedVector<T> memory(way.first + used * distance + 64, T(-1)), expected = memory;
  T* lane[all];
  for (std::size_t l = 0; l < all; ++l) lane[l] = memory.data() + way.first + (l < used ? l * distance : 0);
  const auto value = [](std::size_t k, std::size_t l) { return static_cast<T>(100 * k + l); };
  for (std::size_t l = 0; l < used; ++l)
    for (std::size_t k = 0; k < total; ++k) expected[way.first + l * distance + k] = value(k, l);

  auto state = std::make_unique<kernel::LineState<T>>();
  kernels.begin(*state, lane);
  std::size_t first = 0;
  for (const std::size_t count : way.pieces) {
    AlignedVector<T> rows((count + 16) * static_cast<std::size_t>(way.step), T(-5));
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t l = 0; l < all; ++l)
        rows[k * static_cast<std::size_t>(way.step) + l] = value(first + k, l < used ? l : 0);
    kernels.put({state.get(), rows.data(), way.step, static_cast<std::ptrdiff_t>(count), way.lanes, way.streaming});
    first += count;
  }
  kernels.end(*state, way.lanes, way.streaming);
  EXPECT_EQ(memory, expected) << way.pieces.size() << " pieces, " << total << " values, " << way.lanes
                              << " lanes, step " << way.step << ", first " << way.first << ", gap " << way.gap;
}

template <class T>
void check_all(const Kernels<T>& kernels, bool streaming) {
  for (std::size_t first = 0; first < 16; ++first)
    for (const std::size_t gap : {0u, 1u, 5u})
      for (const std::vector<std::size_t>& pieces :
           {std::vector<std::size_t>{1}, {3}, {16}, {48}, {75}, {1, 1, 1}, {5, 16, 7}, {33, 33, 31}, {2, 64, 1, 1, 20}})
        for (const int lanes : {1, 3, 4, 11, 16})
          check(kernels, {pieces, lanes, first % 2 == 0 ? 16 : 48, first, gap, streaming});
  for (std::size_t count = 0; count <= 70; ++count) check(kernels, {{count}, 16, 16, count % 7, 0, streaming});
}

TEST(Lines, EveryPieceAndPlace) {
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(name(isa));
    const kernel::KernelTable& kernels = kernel::kernels(isa);
    EXPECT_EQ(kernels.isa, isa);
    for (const bool streaming : {false, true}) {
      check_all<float>({kernels.begin_lines_f32, kernels.put_lines_f32, kernels.end_lines_f32}, streaming);
      check_all<double>({kernels.begin_lines_f64, kernels.put_lines_f64, kernels.end_lines_f64}, streaming);
    }
    kernels.finish_streaming();
  }
}

}}  // namespace tessera::test
