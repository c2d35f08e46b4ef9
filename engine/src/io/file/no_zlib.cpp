// Stands for zlib.cpp and zip.cpp in builds without zlib.

#include "io/file/gzip.h"
#include "io/file/zip.h"

namespace tessera { inline namespace abi_0_1 {

Result<std::string> unpack_gzip(std::string_view, std::string_view name) {
  return Status(StatusCode::unsupported, std::string(name) +
                                             ": packed files need a Tessera that was built with zlib (zlib1g-dev); "
                                             "unpack the file first (gunzip)");
}

Result<std::string> unpack_deflated(std::string_view bytes, std::string_view name) { return unpack_gzip(bytes, name); }

Result<std::string> unpack_zip(std::string_view, std::string_view name) {
  return Status(StatusCode::unsupported, std::string(name) +
                                             ": packed files need a Tessera that was built with zlib (zlib1g-dev); "
                                             "unpack the file first (unzip)");
}

}}  // namespace tessera::abi_0_1
