#pragma once
// Arguments of the reports: which models, and whether meshes have the fewest triangles.

#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace tessera::bench {

struct ReportArguments {
  bool fewest = false;
  std::vector<const char*> models;

  /// Prints the usage and ends the program on --help or an unknown option.
  ReportArguments(int argc, char** argv, const char* usage) {
    for (int k = 1; k < argc; ++k) {
      const std::string_view word = argv[k];
      if (word == "--help" || word == "-h") std::exit(std::fputs(usage, stdout) < 0);
      if (word == "--fewest") {
        fewest = true;
      } else if (word.starts_with("-")) {
        std::fprintf(stderr, "unknown option '%s'\n%s", argv[k], usage);
        std::exit(2);
      } else {
        models.push_back(argv[k]);
      }
    }
  }
};

}  // namespace tessera::bench
