#pragma once
// Chinese text in GBK. Platforms have their own tables: gbk.cpp takes those of iconv(), host_gbk.cpp the browser's.

#include <optional>
#include <string>

namespace tessera { inline namespace abi_0_1 {

/// Returns the text as UTF-8, with U+FFFD for a byte that begins no character. Nothing if the system lacks GBK.
std::optional<std::string> gbk_to_utf8(const std::string& text);

}}  // namespace tessera::abi_0_1
