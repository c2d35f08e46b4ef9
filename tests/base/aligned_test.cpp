// Memory aligned to cache lines, and to large pages where there is enough of it.

#include "base/aligned.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace tessera::test { namespace {

template <class Vector>
bool is_aligned(const Vector& vector, std::size_t to) {
  return reinterpret_cast<std::uintptr_t>(vector.data()) % to == 0;
}

TEST(Aligned, VectorsOfEverySize) {
  constexpr std::size_t largest_small = min_bytes_in_large_pages / sizeof(double);
  for (const std::size_t size : {std::size_t{1}, std::size_t{9}, largest_small - 1, largest_small, largest_small + 7}) {
    AlignedVector<double> vector(size, 3.0);
    EXPECT_TRUE(is_aligned(vector, size < largest_small ? cache_line : large_page)) << size;
    for (const std::size_t more : {size + 1, 3 * size}) {  // grows from small to large
      vector.resize(more, 4.0);
      EXPECT_TRUE(is_aligned(vector, cache_line));
      EXPECT_EQ(vector[size - 1], 3.0);
      EXPECT_EQ(vector.back(), 4.0);
    }
  }
}

}}  // namespace tessera::test
