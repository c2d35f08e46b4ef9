#include "line/arguments.h"
#include "io/file/text_cursor.h"

#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <system_error>
#include <utility>

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

void check_overwriting(const std::string& option, const std::vector<std::string>& outputs,
                       const std::vector<std::string>& inputs) {
  std::map<std::pair<dev_t, ino_t>, const std::string&> by_identity;
  struct stat found {};
  for (const std::string& output : outputs)
    if (::stat(output.c_str(), &found) == 0 && S_ISREG(found.st_mode))
      by_identity.emplace(std::pair(found.st_dev, found.st_ino), output);
  if (by_identity.empty()) return;
  for (const std::string& input : inputs) {
    if (::stat(input.c_str(), &found) != 0) continue;
    const auto same = by_identity.find({found.st_dev, found.st_ino});
    if (same != by_identity.end())
      throw UsageError(option, same->second + " is the input " + input + ", which would be overwritten");
  }
}

}  // namespace tessera::cli
