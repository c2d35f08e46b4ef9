#pragma once
// Lists that grow with a text that is being read, to about the size that they will have in the end.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tessera::inline abi_0_1 {

/// Room for one more element. What a text of `size` bytes has brought in the bytes that were read is expected of the
/// rest of it too: a list that doubles would take up to three times its memory while it moves. More than what the
/// shortest elements of a format would take is never asked for.
template <class T>
void make_room(std::vector<T>& list, std::size_t read, std::size_t size) {
  if (list.size() < list.capacity()) return;
  const std::size_t count = list.size();
  const double left =
      static_cast<double>(size - std::min(read, size)) / static_cast<double>(std::max<std::size_t>(read, 1));
  const auto expected = static_cast<std::size_t>(1.02 * left * static_cast<double>(count));
  list.reserve(count + std::max(expected, 8 + count / 8));
}

}  // namespace tessera::inline abi_0_1
