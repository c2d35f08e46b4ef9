#pragma once
// Reads files, and makes the messages of failed file operations.

#include <filesystem>
#include <string>
#include <string_view>

#include "base/internal_export.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The error "path: what: the system's words for error_number".
TESSERA_INTERNAL_EXPORT Status io_failure(const std::filesystem::path& path, std::string_view what, int error_number);

}}  // namespace tessera::abi_0_1
