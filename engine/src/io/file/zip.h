#pragma once
// Zip archives that hold one file, such as .stpz.

#include <string>
#include <string_view>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Whether the bytes begin as a zip archive does.
inline bool begins_as_zip(std::string_view bytes) { return bytes.starts_with("PK\3\4") || bytes.starts_with("PK\5\6"); }

/// Unpacks the only file of a zip archive (PKWARE, APPNOTE.TXT 6.3.10), stored or deflated; `name` stands for the
/// archive in messages. Errors: parse_error (cut, damaged, no file inside), unsupported (several files, encrypted,
/// another compression, Zip64, beyond the limits of gzip.h; no zlib). Memory: the unpacked bytes.
Result<std::string> unpack_zip(std::string_view bytes, std::string_view name);

}}  // namespace tessera::abi_0_1
