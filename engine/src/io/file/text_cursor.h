#pragma once
// Reads text token by token, with the line in each error. For the library itself and the project's own tools.
//
// Memory: cursors refer to the text and its name, which must outlive them. Threads: one at a time for each object.

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The meaning of characters in a text format. 0: the format has none of the kind.
struct TextSyntax {
  char comment = '#';                ///< begins a comment that runs to the end of the line
  std::string_view separators = {};  ///< each ends a token, as blanks do, and is itself a token
  char continuation = 0;             ///< at the end of a line, counts as a blank together with that end
};

/// A place in a text. Blanks are spaces, tabs and carriage returns, so that CRLF ends a line like LF. A byte order mark
/// at the begin is skipped. Lines are counted only when an error is reported.
class TextCursor {
 public:
  /// `name` stands for the file in messages. `first_line`: the number of the text's first line, for a part of a file.
  TextCursor(std::string_view text, std::string_view name, const TextSyntax& syntax = {}, std::size_t first_line = 1);

  /// Skips blanks and a comment, but not the end of the line.
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    if (at_ != end_ && (*at_ == syntax_.comment || *at_ == syntax_.continuation)) skip_special();
  }
  /// Skips blanks, comments and ends of lines.
  void skip_space() {
    for (skip_blanks(); at_ != end_ && *at_ == '\n'; skip_blanks()) ++at_;
  }
  /// Takes blanks, a comment and the end of the line. If something else follows the blanks, returns false and takes
  /// only these.
  bool take_line_end() {
    skip_blanks();
    if (!at_line_end()) return false;
    if (at_ != end_) ++at_;
    return true;
  }
  /// Skips to the end of the line, including continued lines.
  void skip_line();
  /// Whether the text ends here.
  bool at_end() const { return at_ == end_; }
  /// Whether the line ends here; call skip_blanks first.
  bool at_line_end() const { return at_ == end_ || *at_ == '\n'; }

  /// The token here, up to a blank, separator, comment or end of line; empty at an end. Skips nothing before it.
  std::string_view peek_token() const {
    const char* token_end = at_;
    while (!ends_token(token_end)) ++token_end;
    return {at_, static_cast<std::size_t>(token_end - at_)};
  }
  /// Skips a token that peek_token() returned.
  void skip(std::string_view token) { at_ += token.size(); }
  /// Takes `c` if it stands here.
  bool take(char c) {
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

  /// Takes a whole token as a number, or returns false without a move. Accepts inf and nan as doubles: see take_finite.
  bool take_number(double& value) { return take_plain(value) || take_signed_or_extreme(value); }
  /// Takes a whole token as an integer, or returns false without a move.
  bool take_number(std::int64_t& value) { return take_plain(value) || take_signed(value); }
  /// Takes a finite number: infinity, NaN and values outside the range of double are not numbers.
  bool take_finite(double& value) {
    const char* const before = at_;
    double parsed = 0;
    if (take_number(parsed) && parsed - parsed == 0) {
      value = parsed;
      return true;
    }
    at_ = before;
    return false;
  }

  /// The error `name:line: expected WHAT, found "TOKEN"`, or "found the end of the line" or "of the file".
  Status expected(std::string_view what) const;
  /// The error `name:line: SENTENCE` for this line.
  Status failure(std::string_view sentence) const;
  /// "name:line" of this place. Errors: none; throws std::bad_alloc if memory runs out. Memory: the result.
  std::string place() const { return std::string(name_) + ":" + std::to_string(line()); }
  std::size_t line() const;                                                       ///< counted from first_line
  std::string_view name() const { return name_; }                                 ///< as given
  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }  ///< bytes
  const char* position() const { return at_; }                                    ///< the byte here

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  bool is_separator(char c) const { return syntax_.separators.find(c) != std::string_view::npos; }
  bool ends_token(const char* at) const {
    if (at == end_ || is_blank(*at) || *at == '\n') return true;
    if (*at == 0) return false;  // a kind of character that the syntax lacks
    return *at == syntax_.comment || is_separator(*at) || (*at == syntax_.continuation && continues(at));
  }
  /// Whether only blanks stand between a continuation character and the end of the line.
  bool continues(const char* at) const;
  /// Skips a comment, or a continuation and the blanks after it.
  void skip_special();

  template <class Number>
  bool take_plain(Number& value) {
    Number parsed;
    const auto [token_end, error] = std::from_chars(at_, end_, parsed);
    if (error != std::errc() || !ends_token(token_end)) return false;
    value = parsed;
    at_ = token_end;
    return true;
  }
  bool take_signed_or_extreme(double& value);
  bool take_signed(std::int64_t& value);

  const char *begin_, *at_, *end_;
  std::string_view name_;
  TextSyntax syntax_;
  std::size_t first_line_;
};

/// Returns `text` in quotes for a message: at most 40 bytes, unprintable ones in hexadecimal. Errors: none; throws
/// std::bad_alloc if memory runs out. Memory: the result.
std::string quote(std::string_view text);

/// Turns `status` of an element in `text` into a parse_error at that place; out_of_memory is unchanged. `text` is a
/// cursor, or has a failure() as cursors have.
template <class Text>
Status refused_element(const Text& text, const Status& status, const std::string& element = {}) {
  return guarded([&]() -> Status {
    return status.code() == StatusCode::out_of_memory ? status : text.failure(element + status.message());
  });
}

}}  // namespace tessera::abi_0_1
