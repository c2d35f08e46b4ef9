#include "io/packed_records.h"

#include <algorithm>
#include <memory>

#include "parallel/parallel_for.h"

namespace tessera {
namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;  // stays in a cache until it is written
constexpr std::size_t piece_bytes = std::size_t{1} << 16;   // what a thread packs at a time

}  // namespace

Status write_packed(OutputFile& out, std::size_t count, std::size_t bytes,
                    FunctionRef<void(std::size_t, std::size_t, char*)> pack) {
  const std::size_t room = std::min(count, buffer_bytes / bytes);
  const auto buffer = std::make_unique_for_overwrite<char[]>(room * bytes);
  for (std::size_t first = 0; first < count && !out.failed(); first += room) {
    const std::size_t records = std::min(room, count - first);
    Status status = parallel_for(records, piece_bytes / bytes, {}, [&](std::size_t begin, std::size_t end) {
      pack(first + begin, first + end, buffer.get() + begin * bytes);
    });
    if (!status.ok()) return status;
    out.write({buffer.get(), records * bytes});
  }
  return {};
}

}  // namespace tessera
