#pragma once
// The encoding of a file's text, which STEP and IGES do not state.

#include <string>
#include <string_view>

namespace tessera { inline namespace abi_0_1 {

enum class TextEncoding { utf8, latin1, gbk };

/// Guesses the encoding: UTF-8 if the text is valid as such. Otherwise GBK if most bytes beyond ASCII are pairs of the
/// common Chinese characters of GB 2312 (its level 1, and marks), or else Latin-1 in the form of Windows-1252.
TextEncoding encoding_of(std::string_view text);

/// Returns the text as UTF-8. What GBK lacks becomes U+FFFD. On a system whose iconv() lacks GBK, such a text is taken
/// as Latin-1.
std::string to_utf8(const std::string& text, TextEncoding encoding);

/// "GBK", as messages name it.
const char* name_of(TextEncoding encoding);

}}  // namespace tessera::abi_0_1
