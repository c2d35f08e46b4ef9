#include "io/mesh/packed_records.h"

#include <algorithm>
#include <memory>

#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 16;  // packed by a thread at a time
constexpr std::size_t pieces_in_buffer = 16;               // small enough to stay in a cache until it is written

}  // namespace

Status write_packed(PackedSink write, std::size_t count, std::size_t bytes,
                    FunctionRef<void(std::size_t, std::size_t, char*)> pack) {
  const std::size_t piece = piece_bytes / bytes, room = std::min(count, pieces_in_buffer * piece);
  auto buffer = std::make_unique_for_overwrite<char[]>(room * bytes),
       packed_before = std::make_unique_for_overwrite<char[]>(room * bytes);
  std::string_view before;  // lies in packed_before; one thread writes it while the others pack the next records
  bool is_wanted = true;
  for (std::size_t first = 0; first < count && is_wanted; first += room) {
    const std::size_t records = std::min(room, count - first);
    Status status = parallel_for(1 + (records + piece - 1) / piece, 1, {}, [&](std::size_t k, std::size_t) {
      if (k == 0) {
        is_wanted = write(before);
        return;
      }
      const std::size_t begin = (k - 1) * piece, end = std::min(records, k * piece);
      pack(first + begin, first + end, buffer.get() + begin * bytes);
    });
    if (!status.ok()) return status;
    std::swap(buffer, packed_before);
    before = {packed_before.get(), records * bytes};
  }
  if (is_wanted) write(before);
  return {};
}

Status write_packed(OutputFile& out, std::size_t count, std::size_t bytes,
                    FunctionRef<void(std::size_t, std::size_t, char*)> pack) {
  const auto write = [&](std::string_view packed) {
    out.write(packed);
    return !out.failed();
  };
  return write_packed(PackedSink(write), count, bytes, pack);
}

}}  // namespace tessera::abi_0_1
