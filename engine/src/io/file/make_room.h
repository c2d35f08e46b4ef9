#pragma once
// Lists that grow while a text is read, to about their final size.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

/// Makes room for one more element. Expects as many elements per byte from the rest of the text of `size` bytes as from
/// the bytes read so far: a list that doubles would take up to three times its memory while it moves. Never asks for
/// more than the shortest elements of a format would take.
template <class T>
void make_room(std::vector<T>& list, std::size_t read, std::size_t size) {
  if (list.size() < list.capacity()) return;
  const std::size_t count = list.size();
  const double left =
      static_cast<double>(size - std::min(read, size)) / static_cast<double>(std::max<std::size_t>(read, 1));
  const auto expected = static_cast<std::size_t>(1.02 * left * static_cast<double>(count));
  list.reserve(count + std::max(expected, 8 + count / 8));
}

}}  // namespace tessera::abi_0_1
