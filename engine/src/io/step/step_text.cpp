#include <charconv>
#include <cstdint>
#include <string>

#include "io/step/step_record.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

void append_utf8(std::uint32_t code, std::string& out) {
  const auto byte = [&](std::uint32_t bits) { out += static_cast<char>(static_cast<unsigned char>(bits)); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xc0 | code >> 6);
  } else if (code < 0x10000) {
    byte(0xe0 | code >> 12), byte(0x80 | (code >> 6 & 0x3f));
  } else {
    byte(0xf0 | code >> 18), byte(0x80 | (code >> 12 & 0x3f)), byte(0x80 | (code >> 6 & 0x3f));
  }
  byte(0x80 | (code & 0x3f));
}

bool is_character(std::uint32_t code) { return code > 0 && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff); }

/// Returns the length of the UTF-8 character at the start, or 0.
std::size_t utf8_length(std::string_view text) {
  const auto at = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const std::size_t length = at(0) >= 0xf0 && at(0) < 0xf5 ? 4 : at(0) >= 0xe0 ? 3 : at(0) >= 0xc2 ? 2 : 0;
  if (length == 0 || at(0) >= 0xf5 || text.size() < length) return 0;
  std::uint32_t code = at(0) & (0x7fu >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((at(k) & 0xc0) != 0x80) return 0;
    code = code << 6 | (at(k) & 0x3f);
  }
  const std::uint32_t least = length == 4 ? 0x10000 : length == 3 ? 0x800 : 0x80;
  return code >= least && is_character(code) ? length : 0;
}

/// Reads hexadecimal digits.
bool read_hex(std::string_view text, std::uint32_t& code) {
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), code, 16);
  return error == std::errc() && last == text.data() + text.size();
}

/// The text of one string, from its first character to its last.
class TextReader {
 public:
  explicit TextReader(std::string_view raw) : raw_(raw) {}

  std::string read() {
    while (!raw_.empty()) {
      if (raw_.starts_with("''") || raw_.starts_with("\\\\"))
        take(2, static_cast<unsigned char>(raw_[0]));
      else if (raw_[0] != '\\' || !control())
        plain();
    }
    return std::move(out_);
  }

 private:
  void take(std::size_t length, std::uint32_t code) {
    append_utf8(code, out_);
    raw_.remove_prefix(length);
  }
  void plain() {
    const auto c = static_cast<unsigned char>(raw_[0]);
    if (c < 0x80) return take(1, c);
    const std::size_t length = utf8_length(raw_);
    if (length == 0) return take(1, c);
    out_ += raw_.substr(0, length);
    raw_.remove_prefix(length);
  }
  /// Reads what a backslash begins. Returns false if that is malformed.
  bool control() {
    std::uint32_t code = 0;
    if (raw_.starts_with("\\S\\") && raw_.size() > 3) {
      take(4, (static_cast<unsigned char>(raw_[3]) & 0x7f) + page_);
      return true;
    }
    if (raw_.size() >= 4 && raw_.starts_with("\\P") && raw_[3] == '\\') {
      raw_.remove_prefix(4);  // all pages count as that of Latin letters
      return true;
    }
    if (raw_.starts_with("\\X\\") && raw_.size() >= 5 && read_hex(raw_.substr(3, 2), code)) {
      take(5, code);
      return true;
    }
    if (raw_.starts_with("\\X2\\")) return wide(4);
    if (raw_.starts_with("\\X4\\")) return wide(8);
    return false;
  }
  /// Reads characters of so many digits each, until \X0\.
  bool wide(std::size_t digits) {
    const std::size_t end = raw_.find("\\X0\\");
    if (end == std::string_view::npos || (end - 4) % digits != 0) return false;
    std::string made;
    std::uint32_t high = 0;
    for (std::size_t k = 4; k < end; k += digits) {
      std::uint32_t code = 0;
      if (!read_hex(raw_.substr(k, digits), code)) return false;
      if (code >= 0xd800 && code < 0xdc00) {  // the first half of a pair of UTF-16
        high = code;
        continue;
      }
      if (high != 0 && code >= 0xdc00 && code < 0xe000) code = 0x10000 + ((high - 0xd800) << 10) + (code - 0xdc00);
      high = 0;
      if (!is_character(code)) return false;
      append_utf8(code, made);
    }
    out_ += made;
    raw_.remove_prefix(end + 4);
    return true;
  }

  std::string_view raw_;
  std::string out_;
  std::uint32_t page_ = 0x80;
};

}  // namespace

std::string step_text(std::string_view raw) { return TextReader(raw).read(); }

}}  // namespace tessera::abi_0_1
