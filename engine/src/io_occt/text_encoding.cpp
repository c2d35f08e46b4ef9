#include "io_occt/text_encoding.h"

#include <opencascade/Resource_Unicode.hxx>
#include <opencascade/TCollection_ExtendedString.hxx>

#include <cstddef>
#include <vector>

namespace tessera { inline namespace abi_0_1 {
namespace {

unsigned byte(std::string_view text, std::size_t k) {
  return k < text.size() ? static_cast<unsigned char>(text[k]) : 0;
}

/// The bytes of the character at k of valid UTF-8 (RFC 3629, sec. 4); 0 if there is none.
std::size_t utf8_length(std::string_view text, std::size_t k) {
  const unsigned lead = byte(text, k), second = byte(text, k + 1);
  if (lead < 0x80) return 1;
  const std::size_t length = lead < 0xC2 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF5 ? 4 : 0;
  if (length == 0 || (lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
      (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F))
    return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(text, k + i) & 0xC0) != 0x80) return 0;
  return length;
}

bool is_utf8(std::string_view text) {
  for (std::size_t k = 0; k < text.size();) {
    const std::size_t length = utf8_length(text, k);
    if (length == 0) return false;
    k += length;
  }
  return true;
}

}  // namespace

TextEncoding encoding_of(std::string_view text) {
  if (is_utf8(text)) return TextEncoding::utf8;
  std::size_t pairs = 0, singles = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const unsigned lead = byte(text, k), trail = byte(text, k + 1);
    if (lead < 0x80) continue;
    const bool is_pair = lead >= 0xA1 && lead <= 0xF7 && trail >= 0xA1 && trail <= 0xFE;
    // Beyond level 1, pairs are as likely two small letters of Latin-1.
    if (is_pair && lead <= 0xD7) ++pairs;
    if (is_pair) ++k;
    if (!is_pair) ++singles;
  }
  return pairs > singles ? TextEncoding::gbk : TextEncoding::latin1;
}

std::string to_utf8(const std::string& text, TextEncoding encoding) {
  if (encoding == TextEncoding::utf8) return text;
  const Resource_FormatType format =
      encoding == TextEncoding::gbk ? Resource_FormatType_GBK : Resource_FormatType_CP1252;
  TCollection_ExtendedString characters;
  Resource_Unicode::ConvertFormatToUnicode(format, text.c_str(), characters);
  std::vector<char> bytes(static_cast<std::size_t>(characters.LengthOfCString()) + 1);
  char* begin = bytes.data();
  const int count = characters.ToUTF8CString(begin);
  return {bytes.data(), static_cast<std::size_t>(count)};
}

const char* name_of(TextEncoding encoding) {
  return encoding == TextEncoding::utf8 ? "UTF-8" : encoding == TextEncoding::gbk ? "GBK" : "Latin-1";
}

}}  // namespace tessera::abi_0_1
