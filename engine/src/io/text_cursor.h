#pragma once
// Tokens and numbers out of a text in memory, with the line of whatever is wrong. Knows no locale.

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "tessera/status.h"

namespace tessera {

/// A place in a text. Blanks are spaces, tabs and carriage returns, so that CRLF ends a line like LF. A byte order mark
/// at the begin is skipped. Lines are counted only when an error is reported.
class TextCursor {
 public:
  /// `name` stands for the file in messages; `comment` begins a comment that runs to the end of the line (0: there are
  /// none); `separator` ends a token, as blanks do, and is a token of its own (0: there is none).
  TextCursor(std::string_view text, std::string_view name, char comment = '#', char separator = 0);

  /// Past blanks and a comment, not past the end of the line.
  void skip_blanks();
  /// Past blanks, comments and ends of lines.
  void skip_space();
  /// Past blanks, a comment and the end of the line. False, and no move past the blanks, if something else stands
  /// there.
  bool take_line_end();
  bool at_end() const { return at_ == end_; }
  /// Whether the line ends here; after skip_blanks.
  bool at_line_end() const { return at_ == end_ || *at_ == '\n'; }

  /// What stands here, up to a blank, separator, comment or end of line; empty at an end. Skips nothing before it.
  std::string_view peek_token() const;
  void skip(std::string_view token) { at_ += token.size(); }
  /// Past `c` if it stands here.
  bool take(char c) {
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

  /// A whole token as a number, or false and no move. Doubles may be written as inf or nan: see take_finite.
  bool take_number(double& value);
  bool take_number(std::int64_t& value);
  /// The same, where infinity, NaN and what lies outside the range of double are no numbers.
  bool take_finite(double& value);

  /// "name:line: expected <what>, found "<token>"", or "found the end of the line" or "of the file".
  Status expected(std::string_view what) const;
  /// "name:line: <sentence>" for the line of this place.
  Status failure(std::string_view sentence) const;
  std::size_t line() const;
  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  const char* position() const { return at_; }

 private:
  bool ends_token(char c) const {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || (c == comment_ && comment_ != 0) ||
           (c == separator_ && separator_ != 0);
  }

  const char *begin_, *at_, *end_;
  std::string_view name_;
  char comment_, separator_;
};

/// `text` in quotes for a message: at most 40 bytes, what cannot be printed as \xNN.
std::string quote(std::string_view text);

}  // namespace tessera
