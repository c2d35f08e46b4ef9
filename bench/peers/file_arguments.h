#pragma once
// Programs whose arguments are files.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

namespace tessera::bench {

/// Returns the files that the arguments name. Prints the usage and ends the program on --help or an option.
inline std::vector<std::filesystem::path> file_arguments(int argc, char** argv, const char* usage) {
  std::vector<std::filesystem::path> files;
  for (int k = 1; k < argc; ++k) {
    const std::string_view argument = argv[k];
    if (argument == "--help" || argument == "-h") std::exit(std::fputs(usage, stdout) < 0);
    if (argument.starts_with('-')) {
      std::fprintf(stderr, "unknown option '%s'\n%s", argv[k], usage);
      std::exit(2);
    }
    files.emplace_back(argument);
  }
  return files;
}

}  // namespace tessera::bench
