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

}  // namespace tessera::cli
