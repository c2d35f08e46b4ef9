#pragma once
// Files packed by gzip.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The most that a packed file may become: gzip_ratio times its size and gzip_slack, and never more than gzip_limit.
inline constexpr std::size_t gzip_ratio = 200, gzip_slack = std::size_t{1} << 20, gzip_limit = std::size_t{1} << 30;

/// Whether a file is to be unpacked: its extension is .gz, or it is .rib, which programs also pack without a new
/// extension, and begins as gzip does.
bool is_gzip(const std::filesystem::path& path, std::string_view bytes);

/// Whether the bytes begin as gzip does.
bool begins_as_gzip(std::string_view bytes);

/// `path` without the extension .gz, if it has it.
std::filesystem::path without_gz(const std::filesystem::path& path);

/// Unpacks all members of a gzip file (RFC 1952); `name` stands for the file in messages. Errors: parse_error (not
/// gzip, cut, damaged, bytes after the end, nothing inside), unsupported (beyond the limits; no zlib). Memory: the
/// unpacked bytes, which are counted before any are kept.
Result<std::string> unpack_gzip(std::string_view bytes, std::string_view name);

/// Unpacks data that is deflated (RFC 1951) without a header. Errors and memory: as unpack_gzip().
Result<std::string> unpack_deflated(std::string_view bytes, std::string_view name);

}}  // namespace tessera::abi_0_1
