#include "parallel/long_lists.h"

#include <algorithm>
#include <cstdint>
#include <new>
#include <vector>

#include "parallel/parallel_for.h"
#include "parallel/system_pages.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t page = 4096, piece_bytes = std::size_t{1} << 22;

/// The whole pages of a list, cut in pieces.
void add_pieces(std::span<std::byte> memory, std::vector<std::span<std::byte>>& pieces) {
  const std::size_t before = -reinterpret_cast<std::uintptr_t>(memory.data()) % page;
  if (memory.size() < before + page) return;
  for (memory = memory.subspan(before); memory.size() >= page;) {
    const auto piece = memory.first(std::min(piece_bytes, memory.size() / page * page));
    pieces.push_back(piece);
    memory = memory.subspan(piece.size());
  }
}

}  // namespace

void resize_lists(std::span<const ListSize> lists) {
  std::size_t bytes = 0;
  for (const ListSize& list : lists) bytes += list.memory.size();
  if (bytes < piece_bytes) {
    for (const ListSize& list : lists) list.resize();
    return;
  }
  std::vector<std::span<std::byte>> pieces;
  for (const ListSize& list : lists) add_pieces(list.memory, pieces);
  Status status = parallel_for(pieces.size(), 1, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) fetch_pages(pieces[k]);
  });
  if (status.ok())
    status = parallel_for(lists.size(), 1, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) lists[k].resize();
    });
  if (!status.ok()) throw std::bad_alloc();
}

}}  // namespace tessera::abi_0_1
