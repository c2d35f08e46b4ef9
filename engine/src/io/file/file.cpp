#include "io/file/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>

#include "base/text.h"
#include "io/file/descriptor.h"
#include "parallel/long_lists.h"
#include "parallel/parallel_for.h"
#include "tessera/guard.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 21;
constexpr std::size_t pipe_limit = std::size_t{1} << 30;  // an endless device must not use all memory

/// Fills `bytes` from its size `used` on to the end of the file, at most `limit` bytes in all. Returns 0 or an errno.
template <class Bytes>
int read_to_end(int descriptor, Bytes& bytes, std::size_t used, std::size_t limit) {
  for (;;) {
    if (used == bytes.size()) {
      if (used >= limit) return EFBIG;
      bytes.resize(std::min(limit, std::max<std::size_t>(2 * used, std::size_t{1} << 16)));
    }
    const ssize_t got = ::read(descriptor, bytes.data() + used, bytes.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
  }
  bytes.resize(used);
  return 0;
}

/// Fills `bytes` with those of a long file that begin at 0, by several threads. Returns false if they cannot be read.
template <class Bytes>
bool read_pieces(int descriptor, Bytes& bytes) {
  std::atomic<bool> has_failed = false;
  const Status status = parallel_for(bytes.size(), piece_bytes, {}, [&](std::size_t begin, std::size_t end) {
    while (begin < end && !has_failed) {
      const ssize_t got = ::pread(descriptor, bytes.data() + begin, end - begin, static_cast<off_t>(begin));
      if (got > 0) begin += static_cast<std::size_t>(got);
      if (got == 0 || (got < 0 && errno != EINTR)) has_failed = true;
    }
  });
  return status.ok() && !has_failed;
}

/// Does what read_file() says, but may throw.
template <class Bytes>
Result<Bytes> read_whole(const std::filesystem::path& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open()) return io_failure(path, "cannot be opened", errno);
  struct stat facts {};
  if (::fstat(file.number(), &facts) != 0) return io_failure(path, "cannot be read", errno);
  if (S_ISDIR(facts.st_mode)) return Status(StatusCode::io_error, path.string() + ": is a directory, not a file");
  const bool regular = S_ISREG(facts.st_mode);
  const double memory = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE));
  if (regular && double(facts.st_size) > memory)
    return Status(StatusCode::out_of_memory, path.string() + ": has " + std::to_string(facts.st_size) +
                                                 " bytes, the memory of this machine " + text(memory));
  Bytes bytes;
  // One byte more than the file has: the read that finds the end then needs no more memory.
  std::size_t used = 0;
  if (regular) {
    const auto size = static_cast<std::size_t>(facts.st_size);
    const ListSize sizes[] = {size_of(bytes, size, 1)};
    resize_lists(sizes);
    if (size >= 2 * piece_bytes && read_pieces(file.number(), bytes) &&
        ::lseek(file.number(), facts.st_size, SEEK_SET) == facts.st_size)
      used = size;
    bytes.resize(size + 1);
  }
  const int error = read_to_end(file.number(), bytes, used, regular ? bytes.max_size() : pipe_limit);
  if (error != 0) return io_failure(path, "cannot be read", error);
  if (bytes.empty()) return Status(StatusCode::parse_error, path.string() + ": the file is empty");
  return bytes;
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& path) {
  return guarded([&] { return read_whole<std::string>(path); });
}

Result<FileBytes> read_file_bytes(const std::filesystem::path& path) {
  return guarded([&] { return read_whole<FileBytes>(path); });
}

}}  // namespace tessera::abi_0_1
