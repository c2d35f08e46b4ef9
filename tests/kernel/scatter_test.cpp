// The transposing stores of each ISA: every tail, any alignment, nothing beyond the end.

#include <gtest/gtest.h>

#include "base/aligned.h"
#include "kernel/kernel_table.h"

namespace tessera::test {
namespace {

template <class T>
void check(void (*scatter)(const kernel::ScatterJob<T>&), std::size_t count, std::ptrdiff_t row_step, std::ptrdiff_t stride, int lanes) {
  constexpr std::size_t all = kernel::block_lanes;
  AlignedVector<T> rows(std::max<std::size_t>(count, 1) * static_cast<std::size_t>(row_step));
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = static_cast<T>(k);
  const std::size_t room = count * static_cast<std::size_t>(stride) + 3;
  std::vector<T> memory(all * room, T(-1));
  T* lane[all];
  for (std::size_t l = 0; l < all; ++l) lane[l] = memory.data() + l * room + l % 3;  // some aligned, most not
  scatter({rows.data(), row_step, count, lane, lanes, stride});
  std::vector<T> expected(memory.size(), T(-1));
  for (std::size_t l = 0; l < static_cast<std::size_t>(lanes); ++l)
    for (std::size_t k = 0; k < count; ++k)
      expected[l * room + l % 3 + k * static_cast<std::size_t>(stride)] = rows[k * static_cast<std::size_t>(row_step) + l];
  EXPECT_EQ(memory, expected) << count << " rows, step " << row_step << ", stride " << stride << ", " << lanes << " lanes";
}

TEST(Scatter, EveryTailAndLaneCount) {
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(name(isa));
    const kernel::KernelTable& kernels = kernel::kernels(isa);
    EXPECT_EQ(kernels.isa, isa);
    for (std::size_t count = 0; count <= 50; ++count)
      for (const int lanes : {1, 3, 4, 8, 11, 16})
        for (const std::ptrdiff_t stride : {1, 3})
          for (const std::ptrdiff_t step : {16, 48}) {
            check<float>(kernels.scatter_f32, count, step, stride, lanes);
            check<double>(kernels.scatter_f64, count, step, stride, lanes);
          }
  }
}

}  // namespace
}  // namespace tessera::test
