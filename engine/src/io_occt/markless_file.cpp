#include "io_occt/markless_file.h"

#include <array>
#include <fstream>
#include <string_view>
#include <utility>

#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
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
  Result<MemoryFile> copy = MemoryFile::make(std::string_view(*bytes).substr(mark.size()), path);
  if (!copy) return copy.status();
  result.copy_ = *std::move(copy);
  result.path_ = result.copy_.path();
  return result;
}

}}  // namespace tessera::abi_0_1
