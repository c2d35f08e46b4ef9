#pragma once
// A fast pass over plain JSON: what most files hold.

#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace tessera { inline namespace abi_0_1 {

/// Reads JSON (RFC 8259) as events, at some 300 MB/s. Numbers are those of the text, correctly rounded. Stops at all
/// that a slower parser must look at: faults, and numbers beyond double. Nesting is bounded by the events.
///
/// Events: `null()`, `boolean(bool)`, `number(double)`, `string(std::string)`, `key(std::string)`, `start_object()`,
/// `end_object()`, `start_array()`, `end_array()`; each returns false to stop. `quoted(token)` returns the text of a
/// string that is not plain ASCII, by its token with the quotes, or nothing to stop.
template <class Events>
class JsonScan {
 public:
  /// `read`: how many bytes are read when an event comes, to within the token.
  JsonScan(std::string_view text, std::size_t& read, Events& events)
      : begin_(text.data()), at_(begin_), end_(begin_ + text.size()), read_(read), events_(events) {}

  /// Returns whether all of the text was read.
  bool run() {
    skip_space();
    if (!value()) return false;
    skip_space();
    return at_ == end_;
  }

 private:
  void skip_space() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
  }
  /// Takes a character, after white space.
  bool take(char c) {
    skip_space();
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }
  bool take_word(std::string_view word) {
    if (!std::string_view(at_, static_cast<std::size_t>(end_ - at_)).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }

  bool value() {
    if (at_ == end_) return false;
    read_ = static_cast<std::size_t>(at_ - begin_) + 1;
    switch (*at_) {
      case '[':
        return ++at_, array();
      case '{':
        return ++at_, object();
      case '"':
        return string([&](std::string&& text) { return events_.string(text); });
      case 't':
        return take_word("true") && events_.boolean(true);
      case 'f':
        return take_word("false") && events_.boolean(false);
      case 'n':
        return take_word("null") && events_.null();
      default:
        return number();
    }
  }

  bool array() {
    if (!events_.start_array()) return false;
    if (take(']')) return events_.end_array();
    do {
      skip_space();
      if (!value()) return false;
    } while (take(','));
    return take(']') && events_.end_array();
  }

  bool object() {
    if (!events_.start_object()) return false;
    if (take('}')) return events_.end_object();
    do {
      skip_space();
      read_ = static_cast<std::size_t>(at_ - begin_) + 1;
      if (!string([&](std::string&& text) { return events_.key(text); }) || !take(':')) return false;
      skip_space();
      if (!value()) return false;
    } while (take(','));
    return take('}') && events_.end_object();
  }

  template <class Event>
  bool string(const Event& event) {
    if (at_ == end_ || *at_ != '"') return false;
    const char* const begin = ++at_;
    bool is_plain = true;
    for (; at_ != end_ && *at_ != '"'; ++at_) {
      const auto c = static_cast<unsigned char>(*at_);
      if (c < 0x20) return false;
      if (c == '\\' || c >= 0x80) is_plain = false;
      if (c == '\\' && ++at_ == end_) return false;
    }
    if (at_ == end_) return false;
    const std::string_view text(begin, static_cast<std::size_t>(at_++ - begin));
    if (is_plain) return event(std::string(text));
    auto read = events_.quoted({text.data() - 1, text.size() + 2});
    return read && event(*std::move(read));
  }

  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  /// Skips digits. Returns whether there are some.
  bool digits() {
    const char* const first = at_;
    while (at_ != end_ && is_digit(*at_)) ++at_;
    return at_ != first;
  }

  bool number() {
    const char* const first = at_;
    if (*at_ == '-') ++at_;
    const bool leads_with_zero = at_ != end_ && *at_ == '0';
    if (leads_with_zero)
      ++at_;
    else if (!digits())
      return false;
    bool is_integer = true;
    if (at_ != end_ && *at_ == '.') {
      ++at_, is_integer = false;
      if (!digits()) return false;
    }
    if (at_ != end_ && (*at_ == 'e' || *at_ == 'E')) {
      ++at_, is_integer = false;
      if (at_ != end_ && (*at_ == '+' || *at_ == '-')) ++at_;
      if (!digits()) return false;
    }
    double value = 0;
    const auto [last, error] = std::from_chars(first, at_, value);
    if (error != std::errc() || last != at_) return false;
    return events_.number(is_integer ? value + 0.0 : value);  // the integer -0 is 0
  }

  const char* const begin_;
  const char* at_;
  const char* const end_;
  std::size_t& read_;
  Events& events_;
};

}}  // namespace tessera::abi_0_1
