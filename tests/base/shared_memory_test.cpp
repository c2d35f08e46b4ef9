// Shared memory is freed once, with its last handle, in whatever order handles come and go.

#include "tessera/detail/shared_memory.h"

#include <gtest/gtest.h>

#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "support/allocations.h"

namespace tessera::test { namespace {

static_assert(std::is_nothrow_move_constructible_v<SharedMemory> && std::is_nothrow_move_assignable_v<SharedMemory>);

constexpr std::size_t size = 1 << 20;

/// Whether blocks of `size` bytes are held, in addition to those before.
class Held {
 public:
  std::size_t blocks() const { return (restart_peak() - before_) / size; }

 private:
  std::size_t before_ = restart_peak();
};

TEST(SharedMemory, EndsWithTheLastHandle) {
  const Held held;
  SharedMemory first(size);
  SharedMemory second = first, third;
  EXPECT_EQ(first.data(), second.data());
  EXPECT_FALSE(first.sole());
  third = second;
  first = SharedMemory();
  second = std::move(third);
  EXPECT_TRUE(second.sole());
  EXPECT_EQ(held.blocks(), 1u);
  second = SharedMemory(size);
  EXPECT_EQ(held.blocks(), 1u);
  second = SharedMemory();
  EXPECT_EQ(held.blocks(), 0u);
}

TEST(SharedMemory, AssignedToItself) {
  const Held held;
  SharedMemory memory(size);
  const SharedMemory& same = memory;
  memory = same;
  EXPECT_EQ(held.blocks(), 1u);
}

TEST(SharedMemory, ManyHandlesAtOnce) {
  const Held held;
  {
    std::vector<SharedMemory> handles;
    {
      const SharedMemory one(size);
      SharedMemory::Copies copies(one, 5);
      for (int k = 0; k < 3; ++k) handles.push_back(copies.take());  // two are left over
    }
    EXPECT_EQ(held.blocks(), 1u);
    handles.emplace_back(size);
    handles.push_back(handles.front());
    handles.emplace_back();  // an empty one
    EXPECT_EQ(held.blocks(), 2u);
    const SharedMemory kept = handles.front();
    {
      SharedMemory::Sink sink;
      for (SharedMemory& handle : handles) sink.take(handle);
    }
    EXPECT_EQ(held.blocks(), 1u);
  }
  EXPECT_EQ(held.blocks(), 0u);
}

TEST(SharedMemory, HandlesOfManyThreads) {
  const Held held;
  {
    const SharedMemory one(size);
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([mine = one] {
        for (int k = 0; k < 1000; ++k) {
          std::vector<SharedMemory> handles(10, mine);
          SharedMemory::Sink sink;
          for (SharedMemory& handle : handles) sink.take(handle);
        }
      });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(held.blocks(), 1u);
  }
  EXPECT_EQ(held.blocks(), 0u);
}

}}  // namespace tessera::test
