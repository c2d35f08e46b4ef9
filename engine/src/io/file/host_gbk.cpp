// Stands for gbk.cpp in WebAssembly: the tables of iconv() would be a tenth of the module, and browsers and Node have
// them as TextDecoder("gbk").

#include <algorithm>
#include <cstddef>

#include "io/file/gbk.h"

/// Writes text in GBK as UTF-8, at most `room` bytes. Returns how many it writes.
extern "C" [[clang::import_module("tessera"), clang::import_name("decode_gbk")]] std::size_t tessera_decode_gbk(
    const char* text, std::size_t bytes, char* to, std::size_t room);

namespace tessera { inline namespace abi_0_1 {

std::optional<std::string> gbk_to_utf8(const std::string& text) {
  std::string out(3 * text.size(), '\0');  // one byte becomes U+FFFD, two become a character of three
  out.resize(std::min(tessera_decode_gbk(text.data(), text.size(), out.data(), out.size()), out.size()));
  return out;
}

}}  // namespace tessera::abi_0_1
