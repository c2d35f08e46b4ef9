#include "io/file/text_encoding.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "io/file/gbk.h"

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
    // Most texts are ASCII: 32 bytes at once.
    std::array<std::uint64_t, 4> words;
    if (text.size() - k >= sizeof words) {
      std::memcpy(words.data(), text.data() + k, sizeof words);
      if (((words[0] | words[1] | words[2] | words[3]) & 0x8080808080808080) == 0) {
        k += sizeof words;
        continue;
      }
    }
    const std::size_t length = utf8_length(text, k);
    if (length == 0) return false;
    k += length;
  }
  return true;
}

/// Characters of Windows-1252 from 0x80 to 0x9F; those that it lacks are the controls of Latin-1.
constexpr std::array<std::uint16_t, 32> windows_1252{0x20AC, 0x81,   0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021,
                                                     0x02C6, 0x2030, 0x0160, 0x2039, 0x0152, 0x8D,   0x017D, 0x8F,
                                                     0x90,   0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
                                                     0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x9D,   0x017E, 0x0178};

std::string from_windows_1252(std::string_view text) {
  std::string out;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const unsigned one = byte(text, k), code = one >= 0x80 && one < 0xA0 ? windows_1252[one - 0x80] : one;
    if (code < 0x80) {
      out += static_cast<char>(code);
      continue;
    }
    if (code < 0x800) {
      out += static_cast<char>(0xC0 | code >> 6);
    } else {
      out += static_cast<char>(0xE0 | code >> 12);
      out += static_cast<char>(0x80 | (code >> 6 & 0x3F));
    }
    out += static_cast<char>(0x80 | (code & 0x3F));
  }
  return out;
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
  if (encoding == TextEncoding::latin1) return from_windows_1252(text);
  std::optional<std::string> out = gbk_to_utf8(text);
  return out ? *std::move(out) : from_windows_1252(text);
}

const char* name_of(TextEncoding encoding) {
  return encoding == TextEncoding::utf8 ? "UTF-8" : encoding == TextEncoding::gbk ? "GBK" : "Latin-1";
}

}}  // namespace tessera::abi_0_1
