#include "io/rib/rib_lexer.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

bool begins_number(char c) { return (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.'; }

}  // namespace

bool RibLexer::at_end() {
  cursor_.skip_space();
  return cursor_.at_end();
}

bool RibLexer::at_string() { return next() == '"'; }

bool RibLexer::at_value() {
  const char c = next();
  return c == '"' || c == '[' || begins_number(c);
}

std::string_view RibLexer::peek() const {
  RibLexer ahead = *this;
  if (ahead.at_string()) {
    const char* const begin = ahead.cursor_.position();
    if (!ahead.skip_string().ok()) return {};
    return {begin, static_cast<std::size_t>(ahead.cursor_.position() - begin)};
  }
  return ahead.cursor_.peek_token();
}

Status RibLexer::take_request(std::string_view& request) {
  const char c = next();
  if (!is_letter(c)) {
    // Binary RIB encodes requests, strings and numbers in bytes that text does not have.
    if ((static_cast<unsigned char>(c) & 0x80) != 0) {
      return cursor_.failure("binary RIB is not read: convert it to text first");
    }
    return cursor_.expected("a request (a word without quotes)");
  }
  request = cursor_.peek_token();
  cursor_.skip(request);
  return {};
}

Status RibLexer::skip_string() {
  const TextCursor begin = cursor_;
  const char* const first = cursor_.position() + 1;
  const char* const end = cursor_.position() + cursor_.remaining();
  for (const char* at = first; at != end; ++at) {
    if (*at == '\\' && at + 1 != end) {
      ++at;
    } else if (*at == '"') {
      cursor_.skip({cursor_.position(), static_cast<std::size_t>(at + 1 - cursor_.position())});
      return {};
    }
  }
  return begin.failure("the file ends within a string that begins here");
}

Status RibLexer::take_string(std::string_view what, std::string_view& value) {
  const bool bracket = next() == '[';
  if (bracket) cursor_.take('[');
  if (!at_string()) return cursor_.expected(what);
  const char* const begin = cursor_.position() + 1;
  Status status = skip_string();
  if (!status.ok()) return status;
  value = {begin, static_cast<std::size_t>(cursor_.position() - 1 - begin)};
  if (bracket && (next() != ']' || !cursor_.take(']'))) return cursor_.expected("] after one string");
  return {};
}

Status RibLexer::take_number(std::string_view what, double& value) {
  return take_word(value) ? Status() : cursor_.expected(what);
}

Status RibLexer::take_integer(std::string_view what, std::int64_t low, std::int64_t high, std::int64_t& value) {
  cursor_.skip_space();
  const TextCursor before = cursor_;
  double number = 0;
  if (take_word(number) && number == std::floor(number) && number >= static_cast<double>(low) &&
      number <= static_cast<double>(high)) {
    value = static_cast<std::int64_t>(number);
    return {};
  }
  return before.expected(std::string(what) + ", from " + std::to_string(low) + " to " + std::to_string(high));
}

Status RibLexer::take_numbers(std::string_view what, std::span<double> values) {
  const bool bracket = next() == '[';
  if (bracket) cursor_.take('[');
  for (double& value : values) {
    if (!take_word(value)) return cursor_.expected(what);
  }
  if (bracket && (next() != ']' || !cursor_.take(']'))) return cursor_.expected("] after " + std::string(what));
  return {};
}

Status RibLexer::take_array(std::string_view what, std::vector<double>& values, std::size_t likely) {
  values.clear();
  double value = 0;
  if (next() != '[') {
    Status status = take_number(what, value);
    values.push_back(value);
    return status;
  }
  cursor_.take('[');
  values.reserve(std::min(likely, cursor_.remaining() / 2 + 1));  // a number takes two bytes
  while (next() != ']') {
    if (!take_word(value)) return cursor_.expected(what);
    values.push_back(value);
  }
  cursor_.take(']');
  return {};
}

Status RibLexer::skip_value() {
  if (at_string()) return skip_string();
  if (next() != '[') {
    const std::string_view token = cursor_.peek_token();
    if (!begins_number(next())) return cursor_.expected("a value");
    cursor_.skip(token);
    return {};
  }
  const TextCursor begin = cursor_;
  for (cursor_.take('['); next() != ']';) {
    if (cursor_.at_end()) return begin.failure("the file ends within an array that begins here");
    if (at_string()) {
      Status status = skip_string();
      if (!status.ok()) return status;
    } else {
      const std::string_view token = cursor_.peek_token();
      if (token.empty()) return cursor_.expected("a number, a string or ]");
      cursor_.skip(token);
    }
  }
  cursor_.take(']');
  return {};
}

Status RibLexer::skip_values() {
  while (at_value()) {
    Status status = skip_value();
    if (!status.ok()) return status;
  }
  return {};
}

}}  // namespace tessera::abi_0_1
