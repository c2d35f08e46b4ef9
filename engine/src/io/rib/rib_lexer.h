#pragma once
// The words of a RenderMan Interface Bytestream in its text form (The RenderMan Interface Specification 3.2, appendix
// C): requests, numbers, strings in double quotes, arrays in brackets; `#` begins a comment.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/file/text_cursor.h"

namespace tessera { inline namespace abi_0_1 {

class RibLexer {
 public:
  /// `name` stands for the file in messages.
  RibLexer(std::string_view text, std::string_view name) : cursor_(text, name, {.separators = "[]\""}) {}

  // Whether nothing follows but white space and comments.
  bool at_end();
  bool at_string();
  /// Whether a number, a string or an array follows.
  bool at_value();

  // Takes the next thing, or returns an error that says what was expected instead. Numbers are finite.
  Status take_request(std::string_view& request);
  /// Takes the text between the quotes, escapes unchanged. One string may stand in brackets, as numbers may.
  Status take_string(std::string_view what, std::string_view& value);
  Status take_number(std::string_view what, double& value);
  Status take_integer(std::string_view what, std::int64_t low, std::int64_t high, std::int64_t& value);
  /// Takes as many numbers as `values` holds, in brackets or not.
  Status take_numbers(std::string_view what, std::span<double> values);
  /// Takes an array, or one number without brackets. `likely` is a guess of how many will come.
  Status take_array(std::string_view what, std::vector<double>& values, std::size_t likely = 0);
  Status skip_value();
  /// Skips all values up to the next request.
  Status skip_values();

  /// The raw text of the next value, for comparisons: a number or a string with its quotes.
  std::string_view peek() const;
  Status expected(std::string_view what) const { return cursor_.expected(what); }
  /// A copy of this place, for messages.
  const TextCursor& place() const { return cursor_; }

 private:
  char next() {  // 0 at the end
    cursor_.skip_space();
    return cursor_.at_end() ? '\0' : *cursor_.position();
  }
  bool take_word(double& value) {
    cursor_.skip_space();
    return cursor_.take_finite(value);
  }
  Status skip_string();

  TextCursor cursor_;
};

}}  // namespace tessera::abi_0_1
