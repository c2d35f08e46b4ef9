#pragma once
// Values of options: numbers, names of files. Faults throw UsageError, or are texts for Option::check().

#include <string>
#include <vector>

#include "line/command_line.h"

namespace tessera::cli {

struct Extent {
  int first = 0, second = 0;
};

/// Parses "NxM", both from `least` to `most`. The message names `option`.
Extent parse_extent(const std::string& option, const std::string& text, int least, int most);

/// Parses `count` finite numbers separated by commas. The message shows `form`.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count,
                                  const std::string& form);

/// A check of an option: a file name must not be empty.
std::string fault_of_name(const std::string& name);

/// Adds -o and --help for a command that writes text; the default is standard output.
void add_text_output(Command& command, std::string& output);

/// Throws if one of `outputs` is one of `inputs`, under any name: it would be overwritten. Empty names stand for no
/// file; a pipe or a terminal may be both. Looks at each file once.
void check_overwriting(const std::string& option, const std::vector<std::string>& outputs,
                       const std::vector<std::string>& inputs);

}  // namespace tessera::cli
