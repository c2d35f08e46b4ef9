#include <system_error>

#include "io/file/file.h"

namespace tessera { inline namespace abi_0_1 {

Status io_failure(const std::filesystem::path& path, std::string_view what, int error_number) {
  return Status(StatusCode::io_error,
                path.string() + ": " + std::string(what) + ": " + std::generic_category().message(error_number));
}

}}  // namespace tessera::abi_0_1
