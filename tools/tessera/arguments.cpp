#include "arguments.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>

#include "tessera/files.h"

namespace tessera::cli {
namespace {

/// Removes the integer at the front of `text`; false if there is none in range.
bool take_integer(std::string_view& text, int least, int most, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || value < least || value > most) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

}  // namespace

Extent parse_extent(const std::string& option, const std::string& text, int least, int most) {
  Extent extent;
  std::string_view rest = text;
  bool good = take_integer(rest, least, most, extent.first) && !rest.empty() && (rest[0] == 'x' || rest[0] == 'X');
  if (good) rest.remove_prefix(1);
  good = good && take_integer(rest, least, most, extent.second) && rest.empty();
  if (!good) {
    throw UsageError(option, "expected two numbers from " + std::to_string(least) + " to " + std::to_string(most) +
                                 " like 16x16, found " + quote(text));
  }
  return extent;
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count,
                                  const std::string& form) {
  std::vector<double> values;
  TextCursor cursor(text, option, {.comment = 0, .separators = ","});
  do {
    cursor.skip_blanks();
    double value = 0;
    if (!cursor.take_finite(value)) break;
    values.push_back(value);
    cursor.skip_blanks();
  } while (cursor.take(','));
  if (values.size() != count || !cursor.at_end()) {
    throw UsageError(
        option, (count == 1 ? "expected a finite number " : "expected " + std::to_string(count) + " finite numbers ") +
                    form + ", found " + quote(text));
  }
  return values;
}

std::string fault_of_name(const std::string& name) { return name.empty() ? "expected the name of a file" : ""; }

void add_text_output(Command& command, std::string& output) {
  command.add_text("-o,--output", "FILE", "The file to write [standard output]", output).check(fault_of_name);
  command.add_help();
}

void check_overwriting(const std::string& option, const std::string& output, const std::vector<std::string>& inputs) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(output, error)) return;
  for (const std::string& input : inputs) {
    if (std::filesystem::equivalent(output, input, error)) {
      throw UsageError(option, output + " is the input " + input + ", which would be overwritten");
    }
  }
}

}  // namespace tessera::cli
