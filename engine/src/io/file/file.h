#pragma once
// Reads files for the library's own readers, and makes the messages of failed file operations.

#include <filesystem>
#include <string>
#include <string_view>

#include "base/aligned.h"
#include "base/internal_export.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The content of a file, in memory that is not set to zero before it is read: of a long file by several threads.
using FileBytes = UnsetVector<char>;
inline std::string_view view_of(const FileBytes& bytes) { return {bytes.data(), bytes.size()}; }
/// Reads a file. Errors: as read_file() of io.h.
Result<FileBytes> read_file_bytes(const std::filesystem::path& path);

/// The error "path: what: the system's words for error_number".
TESSERA_INTERNAL_EXPORT Status io_failure(const std::filesystem::path& path, std::string_view what, int error_number);

}}  // namespace tessera::abi_0_1
