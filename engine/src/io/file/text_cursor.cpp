
#include <algorithm>
#include <cmath>
#include <system_error>

#include "io/file/text_cursor.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Whether a decimal number that std::from_chars found out of range is too small rather than too large.
bool underflows(std::string_view number) {
  const std::size_t exponent_at = number.find_first_of("eE");
  const std::string_view mantissa = number.substr(0, exponent_at);
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return true;
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  // The decimal exponent of the first significant digit; one too large if the digit stands before the point.
  auto exponent = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  if (exponent_at != std::string_view::npos) {
    const std::string_view digits = number.substr(exponent_at + 1);
    std::int64_t stated = 0;
    const char* const begin = digits.data() + (!digits.empty() && digits.front() == '+');
    const auto [end, error] = std::from_chars(begin, digits.data() + digits.size(), stated);
    if (error == std::errc::result_out_of_range) return digits.front() == '-';
    // No text is long enough for its digits to outweigh this limit, and the sum does not overflow.
    constexpr std::int64_t limit = std::int64_t{1} << 62;
    exponent += std::clamp(stated, -limit, limit);
  }
  return exponent < 0;
}

/// std::from_chars over a whole token; accepts a leading +.
template <class Number>
std::errc parse(std::string_view token, Number& value) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  return end == token.data() + token.size() ? error : std::errc::invalid_argument;
}

}  // namespace

TextCursor::TextCursor(std::string_view text, std::string_view name, const TextSyntax& syntax, std::size_t first_line)
    : begin_(text.data()),
      at_(begin_),
      end_(begin_ + text.size()),
      name_(name),
      syntax_(syntax),
      first_line_(first_line) {
  if (text.starts_with("\xEF\xBB\xBF")) at_ += 3;
}

bool TextCursor::continues(const char* at) const {
  for (++at; at != end_ && is_blank(*at);) ++at;
  return at == end_ || *at == '\n';
}

void TextCursor::skip_special() {
  while (at_ != end_ && *at_ != 0) {  // 0 means "none" in the syntax, but a text may hold a byte of 0
    if (is_blank(*at_)) {
      ++at_;
    } else if (*at_ == syntax_.comment) {
      at_ = std::find(at_, end_, '\n');
    } else if (*at_ == syntax_.continuation && continues(at_)) {
      at_ = std::find(at_, end_, '\n');
      if (at_ != end_) ++at_;
    } else {
      return;
    }
  }
}

void TextCursor::skip_line() {
  for (;;) {
    const char* const line_end = std::find(at_, end_, '\n');
    const char* last = line_end;
    while (last != at_ && is_blank(last[-1])) --last;
    const bool continued = syntax_.continuation != 0 && last != at_ && last[-1] == syntax_.continuation;
    at_ = line_end;
    if (!continued || at_ == end_) return;
    ++at_;
  }
}

bool TextCursor::take_signed_or_extreme(double& value) {
  const std::string_view token = peek_token();
  double parsed = 0;
  const std::errc error = parse(token, parsed);
  if (error == std::errc::result_out_of_range) {
    const bool negative = token.front() == '-';
    parsed = underflows(token) ? 0 : HUGE_VAL;
    if (negative) parsed = -parsed;
  } else if (error != std::errc()) {
    return false;
  }
  value = parsed;
  skip(token);
  return true;
}

bool TextCursor::take_signed(std::int64_t& value) {
  const std::string_view token = peek_token();
  std::int64_t parsed = 0;
  if (parse(token, parsed) != std::errc()) return false;
  value = parsed;
  skip(token);
  return true;
}

Status TextCursor::expected(std::string_view what) const {
  return guarded([&]() -> Status {
    std::string sentence = "expected " + std::string(what) + ", found ";
    std::string_view token = peek_token();
    if (token.empty() && at_ != end_ && is_separator(*at_)) token = {at_, 1};
    if (!token.empty()) {
      sentence += quote(token);
    } else {
      sentence += at_ == end_ ? "the end of the file" : "the end of the line";
    }
    return failure(sentence);
  });
}

Status TextCursor::failure(std::string_view sentence) const {
  return guarded([&] { return Status(StatusCode::parse_error, place() + ": " + std::string(sentence)); });
}

std::size_t TextCursor::line() const {
  auto line = static_cast<std::size_t>(std::count(begin_, at_, '\n')) + first_line_;
  // At the end of a text whose last line is complete, reports that line rather than one that does not exist.
  if (at_ == end_ && at_ != begin_ && at_[-1] == '\n') --line;
  return line;
}

std::string quote(std::string_view text) {
  constexpr std::size_t limit = 40;
  constexpr char digits[] = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text.substr(0, limit)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7f && byte < 0x80) {
      result += c;
    } else {
      result += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
    }
  }
  return result + (text.size() > limit ? "...\"" : "\"");
}

}}  // namespace tessera::abi_0_1
