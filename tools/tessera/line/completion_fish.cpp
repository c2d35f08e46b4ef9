#include "line/completion.h"

namespace tessera::cli {
namespace {

std::string fish_quoted(const std::string& text) { return "'" + escaped(text, "'\\") + "'"; }

std::string words_of(const Option& option) {
  std::string words;
  for (const std::string& word : option.choices) words += (words.empty() ? "" : " ") + word;
  return words;
}

/// A named option: its names, and its value (-r: something, -F: files, -f: none).
std::string option_line(const std::string& condition, const Option& option) {
  std::string line = "complete -c tessera -n " + fish_quoted(condition);
  for (const std::string& name : option.names)
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (!option.value.empty()) line += option.takes_file() ? " -r -F" : " -r -f";
  if (!option.choices.empty()) line += " -a " + fish_quoted(words_of(option));
  return line + " -d " + fish_quoted(short_text(option)) + "\n";
}

std::string positional_line(const std::string& condition, const Option& option) {
  const std::string begin = "complete -c tessera -n " + fish_quoted(condition);
  return option.takes_file() ? begin + " -F\n" : begin + " -f -a " + fish_quoted(words_of(option)) + "\n";
}

std::string option_lines(const std::string& condition, const Command& command) {
  std::string text;
  for (const Option& option : command.options)
    text += option.is_positional() ? positional_line(condition, option) : option_line(condition, option);
  return text;
}

}  // namespace

std::string fish_completion(const Command& tool) {
  constexpr const char* before = "__fish_use_subcommand";
  std::string text = "# fish completion for tessera, written by `tessera completion fish`\n\ncomplete -c tessera -f\n";
  text += option_lines(before, tool);
  for (const Command& command : tool.commands) {
    text += "\ncomplete -c tessera -n " + fish_quoted(before) + " -a " + command.name + " -d " +
            fish_quoted(command.text) + "\n";
    text += option_lines("__fish_seen_subcommand_from " + command.name, command);
  }
  return text;
}

}  // namespace tessera::cli
