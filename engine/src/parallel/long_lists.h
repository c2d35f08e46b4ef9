#pragma once
// Lists that are about to be filled, and so long that the system takes longer to hand out their pages than threads to
// fill them.

#include <cstddef>
#include <functional>
#include <new>
#include <span>

#include "base/internal_export.h"
#include "base/saturated.h"

namespace tessera { inline namespace abi_0_1 {

/// A list with room for the elements that it will have.
struct ListSize {
  std::span<std::byte> memory;   ///< of these elements
  std::function<void()> resize;  ///< gives the list its size; must not throw
};

/// Makes room for `count` and `spare` elements of a vector or string, which must stay where it is. Throws bad_alloc.
template <class List>
ListSize size_of(List& list, std::size_t count, std::size_t spare = 0) {
  const std::size_t room = saturated_sum(count, spare);
  if (room > list.max_size()) throw std::bad_alloc();
  list.reserve(room);
  const auto resize = [&list, count] { list.resize(count); };
  return {{reinterpret_cast<std::byte*>(list.data()), count * sizeof *list.data()}, resize};
}

/// Fetches the pages of memory that is about to be filled, by several threads if it is long.
TESSERA_INTERNAL_EXPORT void fetch_room(std::span<std::byte> memory);

/// Gives lists their sizes, by several threads if they are long. Throws std::bad_alloc.
TESSERA_INTERNAL_EXPORT void resize_lists(std::span<const ListSize> lists);

}}  // namespace tessera::abi_0_1
