#include "console/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <string_view>

namespace tessera::cli {
namespace {

std::string_view variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

int number_or(std::string_view text, int otherwise) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value > 0 ? value : otherwise;
}

bool takes_escapes() {
  const std::string_view term = variable("TERM");
  return !term.empty() && term != "dumb";
}

}  // namespace

bool output_is_terminal() { return isatty(STDOUT_FILENO) == 1; }
bool errors_are_terminal() { return isatty(STDERR_FILENO) == 1; }
bool errors_take_escapes() { return errors_are_terminal() && takes_escapes(); }

TerminalSize terminal_size() {
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    winsize size{};
    if (isatty(stream) == 1 && ioctl(stream, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0)
      return {size.ws_col, size.ws_row};
  }
  return {number_or(variable("COLUMNS"), TerminalSize{}.columns), number_or(variable("LINES"), TerminalSize{}.rows)};
}

Colours output_colours(const std::string& when) {
  if (when == "never") return Colours::none;
  if (when == "always") return Colours::full;
  if (!output_is_terminal() || !takes_escapes() || !variable("NO_COLOR").empty()) return Colours::none;
  const std::string_view depth = variable("COLORTERM"), term = variable("TERM");
  if (depth == "truecolor" || depth == "24bit" || term.ends_with("-direct")) return Colours::full;
  return term.find("256color") == std::string_view::npos ? Colours::none : Colours::palette_256;
}

}  // namespace tessera::cli
