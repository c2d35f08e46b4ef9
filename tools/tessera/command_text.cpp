#include "command_text.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace tessera::cli {
namespace {

/// Takes "NAME:{csv,json}", a value and its choices, apart.
void set_value(const std::string& type, OptionText& option) {
  const std::size_t brace = type.find(":{");
  option.value = type.substr(0, brace);
  if (brace == std::string::npos || !type.ends_with('}')) return;
  std::istringstream words(type.substr(brace + 2, type.size() - brace - 3));
  for (std::string word; std::getline(words, word, ',');) option.choices.push_back(word);
}

OptionText option_text(const CLI::Option& option) {
  OptionText out;
  for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
  out.positional = option.get_positional();
  if (out.positional) out.names.push_back(option.get_name(true, false));
  out.text = option.get_description();
  if (!option.get_default_str().empty()) out.text += " [" + option.get_default_str() + "]";
  out.required = option.get_required();
  out.repeated = option.get_items_expected_max() > 1;
  if (option.get_items_expected_max() > 0) set_value(option.get_type_name(), out);
  return out;
}

void add_options(const CLI::App& app, CommandText& command) {
  for (const CLI::Option* const option : app.get_options()) command.options.push_back(option_text(*option));
  for (const CLI::App* const group : app.get_subcommands({})) {
    if (group->get_name().empty()) add_options(*group, command);
  }
}

}  // namespace

CommandText command_text(const CLI::App& app) {
  CommandText command{app.get_name(), app.get_description(), app.get_footer(), {}, {}};
  add_options(app, command);
  for (const CLI::App* const sub : app.get_subcommands({})) {
    if (!sub->get_name().empty()) command.commands.push_back(command_text(*sub));
  }
  return command;
}

std::string short_text(const OptionText& option) {
  std::string text = option.text.substr(0, option.text.find(" ["));
  return text.substr(0, text.find("; "));
}

std::string escaped(const std::string& text, const std::string& characters) {
  std::string out;
  for (const char c : text) {
    if (characters.find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace tessera::cli
