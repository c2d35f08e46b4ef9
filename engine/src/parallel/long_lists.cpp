#include "parallel/long_lists.h"

#include <algorithm>
#include <cstdint>
#include <new>
#include <vector>

#include "base/aligned.h"
#include "base/large_pages.h"
#include "parallel/parallel_for.h"
#include "parallel/system_pages.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t page = 4096, piece_bytes = std::size_t{1} << 22;

/// How far a place is before the next multiple of `size`.
std::size_t bytes_before(const std::byte* place, std::size_t size) {
  return -reinterpret_cast<std::uintptr_t>(place) % size;
}

/// The whole pages of this size within some memory.
std::span<std::byte> whole_pages(std::span<std::byte> memory, std::size_t size) {
  const std::size_t before = std::min(bytes_before(memory.data(), size), memory.size());
  memory = memory.subspan(before);
  return memory.first(memory.size() / size * size);
}

/// The whole pages of a list, cut in pieces between large pages, which the system is asked for.
void add_pieces(std::span<std::byte> memory, std::size_t size, std::vector<std::span<std::byte>>& pieces) {
  if (const auto large = whole_pages(memory, large_page); large.size() > large_page)
    want_large_pages(large.data(), large.size());
  for (memory = whole_pages(memory, page); !memory.empty();) {
    const std::size_t before = bytes_before(memory.data(), size);
    const auto piece = memory.first(std::min(before > 0 ? before : size, memory.size()));
    pieces.push_back(piece);
    memory = memory.subspan(piece.size());
  }
}

Status fetch_all(std::span<const std::span<std::byte>> pieces) {
  return parallel_for(pieces.size(), 1, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) fetch_pages(pieces[k]);
  });
}

}  // namespace

void fetch_room(std::span<std::byte> memory) {
  if (memory.size() < piece_bytes / 4) return;
  std::vector<std::span<std::byte>> pieces;
  add_pieces(memory, piece_bytes / 8, pieces);
  (void)fetch_all(pieces);  // pages that are not fetched come when they are written
}

void resize_lists(std::span<const ListSize> lists) {
  std::size_t bytes = 0;
  for (const ListSize& list : lists) bytes += list.memory.size();
  if (bytes < piece_bytes) {
    for (const ListSize& list : lists) list.resize();
    return;
  }
  std::vector<std::span<std::byte>> pieces;
  for (const ListSize& list : lists) add_pieces(list.memory, piece_bytes, pieces);
  Status status = fetch_all(pieces);
  if (status.ok())
    status = parallel_for(lists.size(), 1, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) lists[k].resize();
    });
  if (!status.ok()) throw std::bad_alloc();
}

}}  // namespace tessera::abi_0_1
