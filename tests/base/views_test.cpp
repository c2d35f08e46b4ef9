// Views of the caller's memory: of enough, of too little, and empty ones.

#include "tessera/strided_view.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "tessera/geometry.h"

namespace tessera::test { namespace {

struct Vertex {
  float u, v;
  std::array<float, 3> position;
  Vec3 place;
};

TEST(Views, OfMembersOfRecords) {
  std::vector<Vertex> vertices(3);
  const auto positions = View3<float>::of(vertices, &Vertex::position);
  ASSERT_EQ(positions.size, 3u);
  for (std::size_t k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) positions.at(k, c) = static_cast<float>(10 * k) + static_cast<float>(c);
  EXPECT_EQ(vertices[2].position, (std::array<float, 3>{20, 21, 22}));
  View3<double>::of(vertices, &Vertex::place).at(1, 2) = 7;
  EXPECT_EQ(vertices[1].place, (Vec3{0, 0, 7}));
  View1<float>::of(std::span(vertices).subspan(1), &Vertex::v).at(0, 0) = 5;
  EXPECT_EQ(vertices[1].v, 5);
  EXPECT_EQ(View3<float>::of(std::span(vertices).first(0), &Vertex::position).size, 0u);
}

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
