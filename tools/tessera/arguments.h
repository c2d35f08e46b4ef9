#pragma once
// Values of options that consist of several numbers. What is wrong throws CLI::ValidationError: the command line is
// bad.

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

/// Throws if `output` is one of `inputs`, under whatever name: it would be overwritten. Empty names stand for no file;
/// pipes and terminals may be both.
void refuse_overwriting(const std::string& option, const std::string& output, const std::vector<std::string>& inputs);

}  // namespace tessera::cli
