#include "line/help.h"

#include <sstream>

namespace tessera::cli {
namespace {

constexpr std::size_t text_column = 30, line_width = 100;

/// "  -o, --output FILE         The file to write, wrapped ...".
std::string entry(const std::string& name, const std::string& text) {
  std::string out = "  " + name;
  if (out.size() + 2 > text_column) out += "\n" + std::string(text_column, ' ');
  std::size_t column = out.size() + 2 > text_column ? text_column : out.size();
  out += std::string(text_column - column, ' ');
  column = text_column;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (column > text_column && column + 1 + word.size() > line_width) {
      out += "\n" + std::string(text_column, ' ');
      column = text_column;
    }
    out += (column > text_column ? " " : "") + word;
    column += (column > text_column ? 1 : 0) + word.size();
  }
  return out + "\n";
}

std::string spelled_out(const Option& option) {
  std::string names;
  for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + name;
  if (option.is_positional()) return names + (option.repeated ? " ..." : "");
  return names + (option.value.empty() ? "" : " " + option.value);
}

std::string usage(const Command& tool, const Command& command) {
  if (&tool == &command) return tool.name + " COMMAND [options]";
  std::string text = tool.name + " " + command.name;
  for (const Option& option : command.options) {
    if (option.is_positional()) text += " " + spelled_out(option);
    if (option.required && !option.is_positional()) text += " " + option.names[0] + " " + option.value;
  }
  return text + " [options]";
}

}  // namespace

std::string help_text(const Command& tool, const Command& command) {
  std::string text = command.text + ".\n\nUsage: " + usage(tool, command) + "\n";
  if (!command.commands.empty()) text += "\nCommands:\n";
  for (const Command& sub : command.commands) text += entry(sub.name, sub.text);
  std::string heading;
  for (const Option& option : command.options) {
    if (option.heading != heading) text += "\n" + option.heading + ":\n";
    heading = option.heading;
    text += entry(spelled_out(option),
                  option.full_text() + (option.required && !option.is_positional() ? " (required)" : ""));
  }
  return text + "\n" + command.footer + "\n";
}

}  // namespace tessera::cli
