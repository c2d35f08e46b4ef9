#include "io/file/memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "io/file/file.h"

namespace tessera { inline namespace abi_0_1 {

Result<MemoryFile> MemoryFile::make(std::string_view bytes, const std::string& original) {
  MemoryFile file;
  file.copy_ = Descriptor(::memfd_create("tessera", MFD_CLOEXEC));
  if (!file.copy_.is_open()) return io_failure(original, "cannot be copied", errno);
  while (!bytes.empty()) {
    const ssize_t sent = ::write(file.copy_.number(), bytes.data(), bytes.size());
    if (sent < 0 && errno != EINTR) return io_failure(original, "cannot be copied", errno);
    bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(sent, 0)));
  }
  file.path_ = "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(file.copy_.number());
  return file;
}

}}  // namespace tessera::abi_0_1
