#include "line/completion.h"

namespace tessera::cli {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string named_options(const Command& command) {
  std::vector<std::string> names;
  for (const Option& option : command.options) {
    if (!option.is_positional()) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return joined(names, " ");
}

std::string command_names(const Command& tool) {
  std::vector<std::string> names;
  for (const Command& command : tool.commands) names.push_back(command.name);
  return joined(names, " ");
}

/// The words that may follow `before`: a list `words`, or `files`.
std::string value_cases(const Command& command) {
  std::string cases;
  for (const Option& option : command.options) {
    if (option.is_positional() || option.value.empty()) continue;
    const std::string what = option.takes_file()      ? "files=yes"
                             : option.choices.empty() ? "none=yes"
                                                      : "words=" + shell_quoted(joined(option.choices, " "));
    cases += "        " + joined(option.names, "|") + ") " + what + " ;;\n";
  }
  return cases;
}

std::string positional_words(const Command& command) {
  for (const Option& option : command.options) {
    if (!option.is_positional()) continue;
    return option.takes_file() ? "files=yes" : "words=" + shell_quoted(joined(option.choices, " "));
  }
  return ":";
}

std::string command_case(const Command& command) {
  const std::string cases = value_cases(command);
  std::string text = "    " + command.name + ")\n      options=" + shell_quoted(named_options(command)) + "\n";
  text += "      case $before in\n" + cases + "        *) " + positional_words(command) + " ;;\n      esac ;;\n";
  return text;
}

constexpr const char* bash_begin = R"(# bash completion for tessera, written by `tessera completion bash`

_tessera() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}
  # --option=value comes as three words.
  if [[ $current == "=" ]]; then
    current=
  elif [[ $before == "=" && $COMP_CWORD -gt 1 ]]; then
    before=${COMP_WORDS[COMP_CWORD-2]}
  fi
  local command= word at
  for ((at = 1; at < COMP_CWORD; ++at)); do
    word=${COMP_WORDS[at]}
    if [[ $word != -* ]]; then command=$word; break; fi
  done
  local options= words= files= none=
  case $command in
)";

constexpr const char* end = R"(  esac
  COMPREPLY=()
  if [[ $none ]]; then
    return
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  elif [[ $words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  elif [[ $files ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}

complete -F _tessera tessera
)";

}  // namespace

std::string bash_completion(const Command& tool) {
  std::string text = bash_begin;
  text += "    '')\n      options=" + shell_quoted(named_options(tool)) +
          "\n      words=" + shell_quoted(command_names(tool)) + " ;;\n";
  for (const Command& command : tool.commands) text += command_case(command);
  return text + end;
}

}  // namespace tessera::cli
