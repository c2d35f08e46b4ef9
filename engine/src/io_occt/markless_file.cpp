#include "io_occt/markless_file.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <string_view>

#include "io/file/file.h"
#include "tessera/io.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr std::string_view mark = "\xEF\xBB\xBF";

bool has_mark(const std::string& path) {
  std::array<char, mark.size()> begin{};
  std::ifstream file(path, std::ios::binary);
  return file.read(begin.data(), begin.size()) && std::string_view(begin.data(), begin.size()) == mark;
}

}  // namespace

Result<MarklessFile> MarklessFile::make(const std::string& path) {
  MarklessFile result;
  result.path_ = path;
  if (!has_mark(path)) return result;
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.status();
  result.copy_ = Descriptor(::memfd_create("tessera", MFD_CLOEXEC));
  if (!result.copy_.is_open()) return io_failure(path, "cannot be copied", errno);
  for (std::string_view rest = std::string_view(*bytes).substr(mark.size()); !rest.empty();) {
    const ssize_t sent = ::write(result.copy_.number(), rest.data(), rest.size());
    if (sent < 0 && errno != EINTR) return io_failure(path, "cannot be copied", errno);
    rest.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(sent, 0)));
  }
  result.path_ = "/proc/self/fd/" + std::to_string(result.copy_.number());
  return result;
}

}  // namespace tessera::inline abi_0_1
