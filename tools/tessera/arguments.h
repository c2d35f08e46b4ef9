#pragma once
// Values of options that consist of several numbers. What is wrong throws CLI::ValidationError: the command line is
// bad.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace tessera::cli {

struct Extent {
  int first = 0, second = 0;
};

/// "NxM", both from `least` to `most`. `option` is named in the message.
Extent parse_extent(const std::string& option, const std::string& text, int least, int most);

/// `count` finite numbers parted by commas; `form` is shown in the message.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count,
                                  const std::string& form);

/// A check of CLI11: file names are not empty.
std::string fault_of_name(const std::string& name);

/// A check of CLI11: one of these words; its name "{a,b}" stands in help and completions.
CLI::Validator one_of(const std::vector<std::string>& words);
/// A check of CLI11: a whole number from `least` to `most`.
CLI::Validator whole_number(int least, int most);

/// -o of a command that writes text, standard output if it is not given.
void add_text_output(CLI::App& command, std::string& output);

/// Throws if `output` is one of `inputs`, under whatever name: it would be overwritten. Empty names stand for no file;
/// pipes and terminals may be both.
void refuse_overwriting(const std::string& option, const std::string& output, const std::vector<std::string>& inputs);

}  // namespace tessera::cli
