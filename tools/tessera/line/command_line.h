#pragma once
// The command line as data: commands and their options, declared once. Parsing, the help, the manual page and the
// completions are made of it.

#include <deque>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace tessera::cli {

/// The command line is wrong. what() is the message: "--grid: expected two numbers, found "7"".
class UsageError : public std::runtime_error {
 public:
  explicit UsageError(const std::string& message) : runtime_error(message) {}
  UsageError(const std::string& option, const std::string& message) : runtime_error(option + ": " + message) {}
};

/// An option of a command, or a word without a name.
struct Option {
  /// Uses one value; a flag's is empty. Throws UsageError for a wrong one.
  using Use = std::function<void(const std::string& value)>;
  /// Returns what is wrong with a value, or an empty text.
  using Check = std::function<std::string(const std::string& value)>;

  std::vector<std::string> names;    ///< "-o", "--output"; "MODEL" for a word without a name
  std::string value;                 ///< name of its value, "NxM"; empty for a flag. Files begin with "FILE".
  std::string text;                  ///< its purpose, with unit and default
  std::vector<std::string> choices;  ///< its only values, if they are words
  std::string heading;               ///< of its group in the help
  bool required = false, repeated = false;
  Use use;
  std::vector<Check> checks;                   ///< of each value, before it is used
  std::vector<const Option*> needs, excludes;  ///< other options of the command
  std::size_t count = 0;                       ///< how often it is on the command line

  /// The purpose, with its choices before the default.
  std::string full_text() const;
  bool is_positional() const { return !names[0].starts_with('-'); }
  bool takes_file() const { return value.starts_with("FILE"); }
  /// The name in messages: the first long one.
  const std::string& name() const;

  Option& check(Check fault) { return checks.push_back(std::move(fault)), *this; }
  Option& require() { return required = true, *this; }
  Option& need(const Option& other) { return needs.push_back(&other), *this; }
  Option& exclude(const Option& other) { return excludes.push_back(&other), *this; }
};

struct Parsed;

/// A command, or the tool itself.
struct Command {
  std::string name, text, footer;
  std::deque<Option> options;         ///< in the order of the help; references remain valid
  std::deque<Command> commands;       ///< likewise
  std::vector<const Option*> one_of;  ///< at least one must be there, if any are listed
  std::function<void()> choose;       ///< called after the options are used. Throws UsageError.

  Command& add_command(std::string command, std::string purpose);
  /// Adds an option. `names` are separated by commas.
  Option& add(const std::string& option, std::string value_name, std::string purpose, Option::Use use);
  /// Adds a flag that sets `target`.
  Option& add_flag(const std::string& option, std::string purpose, bool& target);
  /// Adds an option whose value is kept as it is.
  Option& add_text(const std::string& option, std::string value_name, std::string purpose, std::string& target);
  /// Adds words without a name, as many as there are; at least one is required.
  Option& add_words(const std::string& option, std::string value_name, std::string purpose,
                    std::vector<std::string>& target);
  /// Adds an option that takes one of these words.
  Option& add_choice(const std::string& option, std::vector<std::string> words, std::string purpose, Option::Use use);
  /// Adds an option that takes a whole number from `least` to `most`.
  Option& add_count(const std::string& option, std::string value_name, std::string purpose, std::size_t least,
                    std::size_t most, std::function<void(std::size_t)> use);
  /// Adds an option that takes a finite number above 0.
  Option& add_length(const std::string& option, std::string value_name, std::string purpose,
                     std::function<void(double)> use);

  /// Adds -h and --help.
  void add_help();

  /// Gives all options that are added from now on this heading.
  void begin_group(std::string group) { heading_ = std::move(group); }
  /// The option of this name, which must exist.
  Option& option(const std::string& of_name);
  /// The command of this name, or null.
  const Command* find(const std::string& command) const;
  std::vector<std::string> command_names() const;

 private:
  friend Parsed parse(Command&, int, const char* const*);
  std::string heading_ = "Options";
  bool help_ = false;
};

/// Result of parsing.
struct Parsed {
  const Command* command = nullptr;  ///< the chosen one; null: none
  bool help = false;                 ///< whether --help is there; then nothing else is used or checked
};

/// Reads the words of the command line, uses all options of the chosen command, and calls its `choose`. Throws
/// UsageError; its message names unknown words first, with a suggestion.
Parsed parse(Command& tool, int argc, const char* const* argv);

}  // namespace tessera::cli
