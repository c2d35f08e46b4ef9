#include "io/file/gzip.h"

#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {

bool is_gzip(const std::filesystem::path& path, std::string_view bytes) {
  const std::string extension = lower_extension(path);
  return extension == ".gz" || (extension == ".rib" && begins_as_gzip(bytes));
}

bool begins_as_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

std::filesystem::path without_gz(const std::filesystem::path& path) {
  return lower_extension(path) == ".gz" ? path.parent_path() / path.stem() : path;
}

}}  // namespace tessera::abi_0_1
