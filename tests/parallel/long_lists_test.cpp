#include "parallel/long_lists.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <new>
#include <string>
#include <vector>

namespace tessera::test { namespace {

TEST(LongLists, HaveTheirSizesAndZeros) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{5}, std::size_t{3000000}}) {
    std::vector<float> floats;
    std::vector<std::uint8_t> bytes{1, 2, 3};
    std::string text = "ab";
    const ListSize sizes[] = {size_of(floats, count, 1), size_of(bytes, 2 * count + 3), size_of(text, count + 2)};
    resize_lists(sizes);
    EXPECT_EQ(floats.size(), count);
    EXPECT_GT(floats.capacity(), count);
    EXPECT_TRUE(std::ranges::all_of(floats, [](float value) { return value == 0; }));
    ASSERT_EQ(bytes.size(), 2 * count + 3);
    EXPECT_EQ(bytes[2], 3);
    EXPECT_EQ(std::count(bytes.begin() + 3, bytes.end(), 0), static_cast<std::ptrdiff_t>(2 * count));
    ASSERT_EQ(text.size(), count + 2);
    EXPECT_EQ(text.substr(0, 2), "ab");
  }
}

TEST(LongLists, TooLongOnesAreRefused) {
  std::vector<double> list;
  EXPECT_THROW(size_of(list, std::size_t{1} << 58), std::bad_alloc);
}

}}  // namespace tessera::test
