#include "line/completion.h"

namespace tessera::cli {
namespace {

std::string value_action(const Option& option) {
  if (option.takes_file()) return "_files";
  if (option.choices.empty()) return " ";
  std::string words;
  for (const std::string& word : option.choices) words += (words.empty() ? "" : " ") + word;
  return "(" + words + ")";
}

/// The specifications of an option for _arguments: one per name, each excluding the others.
std::string option_specs(const Option& option) {
  const std::string value = option.value.empty() ? "" : ":" + escaped(option.value, ":\\") + ":" + value_action(option);
  if (option.is_positional()) return "        " + shell_quoted((option.repeated ? "*" : "") + value) + " \\\n";
  std::string all, specs;
  for (const std::string& name : option.names) all += (all.empty() ? "" : " ") + name;
  for (const std::string& name : option.names) {
    const std::string assigned = value.empty() ? "" : name.starts_with("--") ? "=" : "+";
    specs +=
        "        " +
        shell_quoted("(" + all + ")" + name + assigned + "[" + escaped(short_text(option), "[]:\\") + "]" + value) +
        " \\\n";
  }
  return specs;
}

std::string all_specs(const Command& command) {
  std::string specs;
  for (const Option& option : command.options) specs += option_specs(option);
  return specs;
}

constexpr const char* zsh_begin = R"(#compdef tessera
# zsh completion for tessera, written by `tessera completion zsh`

_tessera() {
  local context state line
  typeset -A opt_args
  local -a commands
)";

}  // namespace

std::string zsh_completion(const Command& tool) {
  std::string text = zsh_begin;
  text += "  commands=(\n";
  for (const Command& command : tool.commands)
    text += "    " + shell_quoted(command.name + ":" + escaped(command.text, ":\\")) + "\n";
  text += "  )\n  _arguments -C \\\n" + all_specs(tool) +
          "        '1:command:->command' \\\n        '*::argument:->argument'\n"
          "  case $state in\n    command) _describe command commands ;;\n    argument)\n      case $words[1] in\n";
  for (const Command& command : tool.commands) {
    std::string specs = all_specs(command);
    specs.erase(specs.rfind(" \\\n"));
    text += "      " + command.name + ") _arguments -s \\\n" + specs + " ;;\n";
  }
  return text +
         "      esac ;;\n  esac\n}\n\n"
         "# As a file in $fpath this is the function's body; otherwise it is sourced.\n"
         "if [[ ${funcstack[1]} == _tessera ]]; then _tessera \"$@\"; else compdef _tessera tessera; fi\n";
}

}  // namespace tessera::cli
