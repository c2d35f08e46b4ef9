#include "io/file/gbk.h"

#include <iconv.h>

#include <array>
#include <cstddef>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns what iconv_open() does if the system lacks an encoding.
::iconv_t no_converter() { return reinterpret_cast<::iconv_t>(-1); }

/// Converts all of a text; a byte that begins no character becomes U+FFFD.
std::string converted(std::string text, ::iconv_t converter) {
  std::string out;
  std::array<char, 4096> piece;
  char* from = text.data();
  std::size_t left = text.size();
  while (left > 0) {
    char* to = piece.data();
    std::size_t room = piece.size();
    const std::size_t before = left;
    const bool is_whole = ::iconv(converter, &from, &left, &to, &room) != static_cast<std::size_t>(-1);
    out.append(piece.data(), piece.size() - room);
    if (is_whole || left < before || room < piece.size()) continue;  // the piece was full, or a bad byte comes next
    out += "\xEF\xBF\xBD";
    ++from, --left;
  }
  return out;
}

}  // namespace

std::optional<std::string> gbk_to_utf8(const std::string& text) {
  const ::iconv_t converter = ::iconv_open("UTF-8", "GBK");
  if (converter == no_converter()) return {};
  std::string out = converted(text, converter);
  ::iconv_close(converter);
  return out;
}

}}  // namespace tessera::abi_0_1
