#include "io/file/spool_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <vector>

#include "io/file/file.h"

namespace tessera { inline namespace abi_0_1 {

Result<SpoolFile> SpoolFile::make(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  Descriptor file(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  if (!file.is_open()) {  // a file system without such files
    std::string name = (folder / ".tessera-XXXXXX").string();
    file = Descriptor(::mkostemp(name.data(), O_CLOEXEC));
    if (!file.is_open()) return io_failure(path, "cannot be written in " + folder.string(), errno);
    ::unlink(name.c_str());
  }
  return SpoolFile(path, std::move(file));
}

Status SpoolFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::write(file_.number(), bytes.data(), bytes.size());
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return io_failure(path_, "cannot be written", errno);
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return {};
}

Status SpoolFile::move_to(OutputFile& out) {
  std::vector<char> buffer(std::size_t{1} << 20);
  std::uint64_t offset = 0;
  while (!out.failed()) {
    const ssize_t got = ::pread(file_.number(), buffer.data(), buffer.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return io_failure(path_, "cannot be read back", errno);
    if (got == 0) break;
    out.write({buffer.data(), static_cast<std::size_t>(got)});
    offset += static_cast<std::uint64_t>(got);
  }
  file_ = Descriptor();
  return {};
}

}}  // namespace tessera::abi_0_1
