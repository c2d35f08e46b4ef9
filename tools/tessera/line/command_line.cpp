#include "line/command_line.h"
#include "io/file/text_cursor.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <map>

#include "line/arguments.h"
#include "line/suggestions.h"

namespace tessera::cli {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// What CLI11 finds on the command line: the values of each option.
using Values = std::map<const Option*, std::vector<std::string>>;

/// Declares the options of a command to CLI11, which only splits words; rules and values are checked here.
void declare(const Command& command, CLI::App& app, Values& values) {
  app.set_help_flag();
  for (const Option& option : command.options) {
    std::vector<std::string>& own = values[&option];
    std::string names;
    for (const std::string& name : option.names) names += (names.empty() ? "" : ",") + name;
    if (option.value.empty()) {
      app.add_flag_function(names, [&own](std::int64_t count) {
        own.assign(static_cast<std::size_t>(std::max<std::int64_t>(count, 0)), "");
      });
      continue;
    }
    CLI::Option* const declared = app.add_option(names, [&own](const CLI::results_t& found) {
      own = found;
      return true;
    });
    declared->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    if (option.repeated) declared->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args();
  }
  for (const Command& sub : command.commands) declare(sub, *app.add_subcommand(sub.name), values);
}

/// The message for a word that no option takes.
std::string fault_of_word(const Command& tool, const Command& command, const std::string& word) {
  const bool of_tool = &command == &tool;
  if (!word.starts_with('-')) {
    if (!of_tool) return command.name + ": the word " + word + " is not expected";
    return "there is no command " + word + did_you_mean(word, tool.command_names());
  }
  const std::string name = word.substr(0, word.find('='));
  std::vector<std::string> names;
  for (const Option& option : command.options)
    if (!option.is_positional()) names.insert(names.end(), option.names.begin(), option.names.end());
  if (!of_tool) return command.name + " has no option " + name + did_you_mean(name, names);
  return "there is no option " + name + " before a command" + did_you_mean(name, names);
}

/// Throws for the first word that nothing takes: of a command options first, since words may be their values.
void check_no_words_left(const Command& tool, const Command& command, const std::vector<std::string>& words) {
  if (words.empty()) return;
  const auto option = std::find_if(words.begin(), words.end(),
                                   [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
  const bool is_first = &command == &tool || option == words.end();
  throw UsageError(fault_of_word(tool, command, is_first ? words[0] : *option));
}

/// The message of CLI11's error: an option without its value, or a flag with one.
std::string fault_of_syntax(const Command& command, const std::string& message) {
  for (const Option& option : command.options) {
    for (const std::string& name : option.names)
      if (message.starts_with(name + ":") && !option.value.empty())
        return name + ": expected " + option.value + ", found nothing";
  }
  return message;
}

std::string spelled(const Option& option) {
  return option.is_positional() ? option.name() : option.name() + " " + option.value;
}

/// Which options must be there, may not be together, and need each other.
void check_rules(const Command& command) {
  const std::string& here = command.name;
  for (const Option& option : command.options) {
    if (option.required && option.count == 0) throw UsageError(here, "expected " + spelled(option) + ", found none");
    if (option.count == 0) continue;
    if (option.count > 1 && !option.repeated && !option.value.empty())
      throw UsageError(option.name(), "is there " + std::to_string(option.count) + " times; give it once");
    for (const Option* const other : option.excludes)
      if (other->count > 0) throw UsageError(option.name(), "cannot be combined with " + other->name());
    for (const Option* const other : option.needs)
      if (other->count == 0) throw UsageError(option.name(), "needs " + spelled(*other));
  }
  std::vector<std::string> names;
  for (const Option* const option : command.one_of) {
    if (option->count > 0) return;
    names.push_back(option->name());
  }
  if (!names.empty()) throw UsageError(here, "expected " + listed(names, "or") + ", found none of them");
}

/// Whether a word is an option that takes the word after it.
bool takes_next(const Command& command, const std::string& word) {
  const auto takes = [&](const Option& option) {
    return !option.value.empty() && !option.is_positional() &&
           std::find(option.names.begin(), option.names.end(), word) != option.names.end();
  };
  return std::any_of(command.options.begin(), command.options.end(), takes) ||
         std::any_of(command.commands.begin(), command.commands.end(),
                     [&](const Command& sub) { return takes_next(sub, word); });
}

/// The place of the "--" after which no options follow, or argc.
int end_of_options(const Command& tool, int argc, const char* const* argv) {
  for (int k = 1; k < argc; ++k)
    if (argv[k] == std::string_view("--") && !takes_next(tool, argv[k - 1])) return k;
  return argc;
}

/// Adds words that follow "--" to those without a name. Throws UsageError if the command has none of these.
void add_words_after_mark(const Command& command, std::vector<std::string> words, Values& values) {
  for (const Option& option : command.options) {
    if (!option.is_positional()) continue;
    std::vector<std::string>& own = values[&option];
    const std::size_t room = option.repeated ? words.size() : own.empty() ? 1 : 0;
    const auto last = words.begin() + static_cast<std::ptrdiff_t>(std::min(room, words.size()));
    own.insert(own.end(), words.begin(), last);
    words.erase(words.begin(), last);
  }
  if (!words.empty())
    throw UsageError((command.name.empty() ? "expected a command before --" : command.name) + ": the word " + words[0] +
                     " is not expected");
}

void use(Command& command, const Values& values) {
  for (Option& option : command.options) option.count = values.at(&option).size();
  check_rules(command);
  for (const Option& option : command.options) {
    for (const std::string& value : values.at(&option)) {
      for (const Option::Check& check : option.checks)
        if (const std::string fault = check(value); !fault.empty()) throw UsageError(option.name(), fault);
      option.use(value);
    }
  }
}

}  // namespace

const std::string& Option::name() const {
  const auto found = std::find_if(names.begin(), names.end(), [](const auto& name) { return name.starts_with("--"); });
  return found == names.end() ? names[0] : *found;
}

std::string Option::full_text() const {
  if (choices.empty()) return text;
  const std::size_t at = std::min(text.find(" ["), text.size());
  return text.substr(0, at) + ": " + listed(choices, "or") + text.substr(at);
}

Command& Command::add_command(std::string command, std::string purpose) {
  commands.emplace_back();
  commands.back().name = std::move(command);
  commands.back().text = std::move(purpose);
  return commands.back();
}

Option& Command::add(const std::string& option, std::string value_name, std::string purpose, Option::Use use) {
  Option added;
  added.names = split(option, ',');
  added.value = std::move(value_name);
  added.text = std::move(purpose);
  added.heading = heading_;
  added.use = std::move(use);
  return options.emplace_back(std::move(added));
}

Option& Command::add_flag(const std::string& option, std::string purpose, bool& target) {
  return add(option, "", std::move(purpose), [&target](const std::string&) { target = true; });
}

Option& Command::add_text(const std::string& option, std::string value_name, std::string purpose, std::string& target) {
  return add(option, std::move(value_name), std::move(purpose), [&target](const std::string& word) { target = word; });
}

Option& Command::add_words(const std::string& option, std::string value_name, std::string purpose,
                           std::vector<std::string>& target) {
  Option& added = add(option, std::move(value_name), std::move(purpose),
                      [&target](const std::string& word) { target.push_back(word); });
  added.required = added.repeated = true;
  return added;
}

Option& Command::add_choice(const std::string& option, std::vector<std::string> words, std::string purpose,
                            Option::Use use) {
  Option& added = add(option, "NAME", std::move(purpose), std::move(use));
  added.choices = std::move(words);
  return added.check([&added](const std::string& word) {
    const std::vector<std::string>& known = added.choices;
    if (std::find(known.begin(), known.end(), word) != known.end()) return std::string();
    return "expected " + listed(known, "or") + ", found " + quote(word) + did_you_mean(word, known);
  });
}

Option& Command::add_count(const std::string& option, std::string value_name, std::string purpose, std::size_t least,
                           std::size_t most, std::function<void(std::size_t)> use) {
  const std::string shown = split(option, ',').back();
  return add(option, std::move(value_name), std::move(purpose),
             [shown, least, most, use = std::move(use)](const std::string& word) {
               std::size_t value = 0;
               const char* const end = word.data() + word.size();
               const auto [parsed, error] = std::from_chars(word.data(), end, value);
               if (error != std::errc() || parsed != end || value < least || value > most)
                 throw UsageError(shown, "expected a whole number from " + std::to_string(least) + " to " +
                                             std::to_string(most) + ", found " + quote(word));
               use(value);
             });
}

Option& Command::add_length(const std::string& option, std::string value_name, std::string purpose,
                            std::function<void(double)> use) {
  const std::string shown = split(option, ',').back();
  return add(option, std::move(value_name), std::move(purpose), [shown, use = std::move(use)](const std::string& word) {
    const double value = parse_numbers(shown, word, 1, "above 0")[0];
    if (!(value > 0)) throw UsageError(shown, "expected a number above 0, found " + quote(word));
    use(value);
  });
}

Option& Command::option(const std::string& of_name) {
  return *std::find_if(options.begin(), options.end(), [&](const Option& option) { return option.name() == of_name; });
}

const Command* Command::find(const std::string& command) const {
  const auto found =
      std::find_if(commands.begin(), commands.end(), [&](const Command& c) { return c.name == command; });
  return found == commands.end() ? nullptr : &*found;
}

std::vector<std::string> Command::command_names() const {
  std::vector<std::string> found;
  for (const Command& command : commands) found.push_back(command.name);
  return found;
}

void Command::add_help() { add_flag("-h,--help", "Print this help", help_); }

Parsed parse(Command& tool, int argc, const char* const* argv) {
  CLI::App app;
  Values values;
  declare(tool, app, values);
  app.require_subcommand(0, 1);
  std::string fault;
  const int end = end_of_options(tool, argc, argv);
  try {
    app.parse(end, argv);
  } catch (const CLI::ParseError& error) {
    fault = error.what();
  }
  Command* chosen = nullptr;
  for (Command& command : tool.commands)
    if (app.get_subcommand(command.name)->parsed()) chosen = &command;
  for (Command* const command : {&tool, chosen})
    if (command && !values.at(&command->option("--help")).empty()) return {chosen, true};
  if (chosen) check_no_words_left(tool, *chosen, app.get_subcommand(chosen->name)->remaining());
  check_no_words_left(tool, tool, app.remaining());
  if (!fault.empty()) throw UsageError(fault_of_syntax(chosen ? *chosen : tool, fault));
  if (end < argc) add_words_after_mark(chosen ? *chosen : tool, {argv + end + 1, argv + argc}, values);
  use(tool, values);
  if (!chosen) return {};
  use(*chosen, values);
  chosen->choose();
  return {chosen, false};
}

}  // namespace tessera::cli
