#pragma once
// Values of options that consist of several numbers. Faults throw CLI::ValidationError: the command line is wrong.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace tessera::cli {

struct Extent {
  int first = 0, second = 0;
};

/// Parses "NxM", both from `least` to `most`. The message names `option`.
Extent parse_extent(const std::string& option, const std::string& text, int least, int most);

/// Parses `count` finite numbers separated by commas. The message shows `form`.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count,
                                  const std::string& form);

/// A check for CLI11: a file name must not be empty.
std::string fault_of_name(const std::string& name);

/// A check for CLI11: one of these words. Its name "{a,b}" appears in help and completions.
CLI::Validator one_of(const std::vector<std::string>& words);
/// A check for CLI11: a whole number from `least` to `most`.
CLI::Validator whole_number(int least, int most);

/// Adds -o for a command that writes text; the default is standard output.
void add_text_output(CLI::App& command, std::string& output);

/// Throws if `output` is one of `inputs`, under any name: it would be overwritten. Empty names stand for no file; a
/// pipe or a terminal may be both.
void refuse_overwriting(const std::string& option, const std::string& output, const std::vector<std::string>& inputs);

}  // namespace tessera::cli
