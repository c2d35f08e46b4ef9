// Both readers of STEP, side by side: each file of TESSERA_TEST_DATA is read the same, or as step_differences.h states.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io_occt/step_comparison.h"
#include "io_occt/step_differences.h"
#include "support/real_files.h"
#include "tessera/cad.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;

const StepDifference* known_difference(const fs::path& file) {
  const auto is_it = [&](const StepDifference& one) { return file.native().ends_with(one.file); };
  const auto found = std::ranges::find_if(step_differences, is_it);
  return found == std::end(step_differences) ? nullptr : &*found;
}

TEST(StepReaders, AreTheSameOrDifferAsKnown) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const std::vector<fs::path> files = step_files_below(data);
  std::size_t equal = 0, unread = 0, listed = 0;
  for (const fs::path& file : files) {
    const Result<Model> ours = read_cad(file, {.step_reader = StepReader::tessera});
    const Result<Model> theirs = read_cad(file, {.step_reader = StepReader::opencascade});
    ASSERT_TRUE(theirs || theirs.status().code() != StatusCode::unsupported) << theirs.status().message();
    const StepComparison found = compare_models(ours, theirs);
    std::string kinds;
    for (const std::string& kind : found.kinds) kinds += (kinds.empty() ? "" : " ") + kind;
    const StepDifference* const known = known_difference(file);
    unread += !ours && !theirs, equal += ours && theirs && kinds.empty(), listed += known != nullptr;
    std::printf(
        "%s: %zu shapes, %zu faces, %zu edges, %zu solids, %zu instances; areas to %.1e, volumes to %.1e, gaps "
        "%.1e and %.1e%s%s\n",
        file.filename().c_str(), found.shapes, found.faces, found.edges, found.solids, found.instances, found.area,
        found.volume, found.gap, found.peer_gap, kinds.empty() ? "" : "; ", kinds.c_str());
    if (kinds == (known ? known->kinds : std::string_view())) continue;
    std::string findings;
    for (std::size_t k = 0; k < std::min<std::size_t>(found.findings.size(), 20); ++k)
      findings += "\n  " + found.findings[k];
    ADD_FAILURE() << file << ": differs in '" << kinds << "', known is '" << (known ? known->kinds : "") << "'"
                  << findings;
  }
  std::printf("%zu files: %zu the same, %zu differ as known, %zu without surfaces for both\n", files.size(), equal,
              listed, unread);
  EXPECT_GT(equal, 3 * listed);
}

}}  // namespace tessera::test
