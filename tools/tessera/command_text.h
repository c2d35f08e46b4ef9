#pragma once
// The command line as data, taken from its definition: what the man page and the completions are made of.

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tessera::cli {

struct OptionText {
  std::vector<std::string> names;    ///< "-o", "--output"; "MODEL" for a word without a name
  std::string value;                 ///< its value, "NxM"; empty for a flag. Files begin with "FILE".
  std::vector<std::string> choices;  ///< the only values, if they are words
  std::string text;                  ///< its purpose, with unit and default
  bool positional = false, required = false, repeated = false;

  bool takes_file() const { return value.starts_with("FILE"); }
};

struct CommandText {
  std::string name, text, footer;
  std::vector<OptionText> options;
  std::vector<CommandText> commands;
};

/// `app` and its commands; options of a group are the command's.
CommandText command_text(const CLI::App& app);

/// The help of an option as completions show it: the first sentence, without default.
std::string short_text(const OptionText& option);

/// `text` with each of `characters` after a backslash.
std::string escaped(const std::string& text, const std::string& characters);
/// In single quotes, as all shells take it.
std::string shell_quoted(const std::string& text);

}  // namespace tessera::cli
