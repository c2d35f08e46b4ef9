#pragma once
// Reads whole files into memory.

#include <filesystem>
#include <string>
#include <string_view>

#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// The bytes of a file. A pipe or a terminal is read up to its end, at most 1 GiB. Errors: io_error (missing, a
/// directory, no permission, a failed read), parse_error (no bytes). Messages begin with the path.
Result<std::string> read_file(const std::filesystem::path& path);

/// The error "path: what: the system's words for error_number".
Status io_failure(const std::filesystem::path& path, std::string_view what, int error_number);

}  // namespace tessera::inline abi_0_1
