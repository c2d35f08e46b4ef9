#pragma once
// Files that another file names: beside it or below, and nowhere else.

#include <filesystem>
#include <string>
#include <string_view>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The path of the file that `file` calls `relative`, normalised. Errors: unsupported (an absolute path, a URL, a part
/// ".."), parse_error (no name, or one with a byte of 0).
Result<std::filesystem::path> path_beside(std::string_view file, std::string_view relative);

/// Checks that a file of path_beside() lies below the folder of `file` once symbolic links are followed. A path that
/// does not exist is below. Errors: unsupported.
Status check_below(std::string_view file, const std::filesystem::path& path);

/// The bytes of a regular file: a pipe or a device that another file names could wait for ever. Errors: io_error,
/// parse_error (no bytes). Messages begin with the path.
Result<std::string> read_regular_file(const std::filesystem::path& path);

/// A URI with each %20 and such replaced by its byte. Errors: parse_error (% without two hexadecimal digits).
Result<std::string> percent_decoded(std::string_view uri);

}}  // namespace tessera::abi_0_1
