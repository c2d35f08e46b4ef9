#pragma once
// Arguments of the reports: which models, whether meshes have the fewest triangles, and how many rays are cast.

#include <charconv>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace tessera::bench {

struct ReportArguments {
  bool fewest = false;
  std::size_t rays = 100000;  ///< for each model
  std::vector<const char*> models;

  /// Prints the usage and ends the program on --help or an unknown option.
  ReportArguments(int argc, char** argv, const char* usage) {
    for (int k = 1; k < argc; ++k) {
      const std::string_view word = argv[k];
      if (word == "--help" || word == "-h") std::exit(std::fputs(usage, stdout) < 0);
      if (word == "--fewest") {
        fewest = true;
      } else if (word == "--rays" && k + 1 < argc) {
        const std::string_view count = argv[++k];
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), rays);
        if (error == std::errc() && end == count.data() + count.size() && rays > 0) continue;
        std::fprintf(stderr, "--rays: '%s' is no positive integer\n%s", argv[k], usage);
        std::exit(2);
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
