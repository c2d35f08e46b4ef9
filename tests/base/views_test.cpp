// Views of the caller's memory: of enough, of too little, and empty ones.

#include "tessera/strided_view.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace tessera::test { namespace {

TEST(Views, RecordsThatFit) {
  std::vector<float> memory(13);
  const auto normals = View3<float>::interleaved(memory, 6, 3);
  EXPECT_EQ(normals.size, 2u);
  EXPECT_EQ(&normals.at(1, 2), &memory[11]);
  EXPECT_EQ(View3<float>::interleaved(memory, 5, 0).size, 3u);
  EXPECT_EQ(View1<float>::interleaved(memory, 1, 12).size, 1u);
  EXPECT_EQ(View1<float>::interleaved(memory, 1, 13).size, 0u);
}

/// No pointer is made that must not be: an address beyond the memory, or one counted from null, is undefined by itself.
TEST(Views, OfNoMemoryOrTooLittle) {
  EXPECT_TRUE(View3<float>::interleaved({}, 6, 3).empty());
  std::vector<float> memory(5);
  constexpr std::size_t huge = std::numeric_limits<std::size_t>::max();
  for (const auto& view : {View3<float>::interleaved(memory, 6, 3), View3<float>::interleaved(memory, 3, huge),
                           View3<float>::interleaved(memory, 3, huge - 2), View3<float>::interleaved(memory, 0, 0)}) {
    EXPECT_EQ(view.size, 0u);
    EXPECT_EQ(view.component[2], memory.data());
  }
}

}}  // namespace tessera::test
