// Replays a corpus without libFuzzer: calls a fuzz target once for each file in the folders of the command line, and
// ends with an error if a folder has none. A broken rule aborts the program, after the name of its file.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "support/scratch_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size);

int main(int argument_count, char** arguments) {
  std::size_t total = 0;
  for (int k = 1; k < argument_count; ++k) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(arguments[k]))
      if (entry.is_regular_file()) files.push_back(entry.path());
    if (files.empty()) {
      std::fprintf(stderr, "%s: expected files to replay, found none\n", arguments[k]);
      return 1;
    }
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& file : files) {
      std::printf("%s\n", file.c_str());
      std::fflush(stdout);
      const std::string bytes = tessera::test::content_of(file);
      // Memory of its own, so that a sanitizer sees a read beyond the end.
      const std::vector<unsigned char> copy(bytes.begin(), bytes.end());
      LLVMFuzzerTestOneInput(copy.data(), copy.size());
    }
    total += files.size();
  }
  std::printf("%zu inputs\n", total);
  return total > 0 ? 0 : 1;
}
