#include "io/file/file_windows.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "io/file/file.h"

namespace tessera { inline namespace abi_0_1 {

Result<FileWindows> FileWindows::open(const std::filesystem::path& path) {
  // A pipe without a writer must not wait here.
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.is_open()) return io_failure(path, "cannot be opened", errno);
  struct stat facts {};
  if (::fstat(file.number(), &facts) != 0) return io_failure(path, "cannot be read", errno);
  if (S_ISDIR(facts.st_mode)) return Status(StatusCode::io_error, path.string() + ": is a directory, not a file");
  if (!S_ISREG(facts.st_mode))
    return Status(StatusCode::unsupported, path.string() + ": is not a regular file, so it cannot be read in runs");
  if (facts.st_size == 0) return Status(StatusCode::parse_error, path.string() + ": the file is empty");
  FileWindows windows(path, std::move(file));
  windows.size_ = static_cast<std::uint64_t>(facts.st_size);
  windows.changed_ = facts.st_mtim;
  return windows;
}

Status FileWindows::read(std::uint64_t offset, std::size_t bytes, std::string& into) const {
  into.resize(static_cast<std::size_t>(std::min<std::uint64_t>(bytes, size_ - offset)));
  std::size_t used = 0;
  while (used < into.size()) {
    const ssize_t got =
        ::pread(file_.number(), into.data() + used, into.size() - used, static_cast<off_t>(offset + used));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return io_failure(path_, "cannot be read", errno);
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
  }
  struct stat facts {};
  if (::fstat(file_.number(), &facts) != 0) return io_failure(path_, "cannot be read", errno);
  if (used < into.size() || static_cast<std::uint64_t>(facts.st_size) != size_ ||
      facts.st_mtim.tv_sec != changed_.tv_sec || facts.st_mtim.tv_nsec != changed_.tv_nsec)
    return Status(StatusCode::io_error, path_.string() + ": the file has changed since it was opened");
  return {};
}

}}  // namespace tessera::abi_0_1
