#pragma once
// The command line as data, taken from its definition, for the manual page and the completions.

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tessera::cli {

struct OptionText {
  std::vector<std::string> names;    ///< "-o", "--output"; "MODEL" for a word without a name
  std::string value;                 ///< name of its value, "NxM"; empty for a flag. Files begin with "FILE".
  std::vector<std::string> choices;  ///< its only values, if they are words
  std::string text;                  ///< its purpose, with unit and default
  bool positional = false, required = false, repeated = false;

  bool takes_file() const { return value.starts_with("FILE"); }
};

struct CommandText {
  std::string name, text, footer;
  std::vector<OptionText> options;
  std::vector<CommandText> commands;
};

/// The text of `app` and its commands; options of a group count as the command's.
CommandText command_text(const CLI::App& app);

/// The help of an option in completions: the first sentence, without the default.
std::string short_text(const OptionText& option);

/// `text` with a backslash before each of `characters`.
std::string escaped(const std::string& text, const std::string& characters);
/// `text` in single quotes, as all shells accept it.
std::string shell_quoted(const std::string& text);

}  // namespace tessera::cli
