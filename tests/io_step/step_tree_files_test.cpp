// The structure of all STEP files of the real data.

#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>

#include "io/step/step_tree.h"
#include "support/real_files.h"
#include "support/synthetic_sets.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;

struct Facts {
  std::size_t parts, places;
  std::string unit;
};

/// Files whose facts their texts state: uses of products, mapped items, units.
const std::map<std::string, Facts> known{
    {"as1-oc-214.stp", {5, 18, "millimetre"}},
    {"examples__api__as1-tu-203.stp", {5, 18, "millimetre"}},
    {"src__conv__step__ap214__tests__ap214_mapped_items.stp", {1, 2, "millimetre"}},
    {"src__conv__step__step-g__tests__ap203_mapped_assembly.stp", {1, 3, "millimetre"}},
    {"testing__inputSTEP__Torus__face2.stp", {1, 1, "METRE"}}};

TEST(StepTree, ReadsAllRealFiles) {
  const char* const folder = std::getenv("TESSERA_TEST_DATA");
  if (folder == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  std::size_t files = 0, with_places = 0, places = 0, remarks = 0, found = 0;
  for (const fs::path& path : step_files_below(folder)) {
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const Result<StepIndex> index = StepIndex::make(text);
    if (!index) continue;
    const Result<StepTree> tree = read_step_tree(*index, encoding_of(text));
    ASSERT_TRUE(tree.ok()) << path << tree.status().message();
    ++files, with_places += !tree->places.empty(), places += tree->places.size(), remarks += tree->remarks.count;
    for (const StepPlacedPart& place : tree->places) {
      ASSERT_LT(place.part, tree->parts.size());
      ASSERT_LT(place.colours, tree->colours.size());
      EXPECT_TRUE(is_finite(place.placement));
      EXPECT_FALSE(tree->parts[place.part].items.empty());
    }
    const auto facts = known.find(path.filename().string());
    if (facts == known.end()) continue;
    ++found;
    EXPECT_EQ(tree->parts.size(), facts->second.parts) << path;
    EXPECT_EQ(tree->places.size(), facts->second.places) << path;
    EXPECT_EQ(tree->file_unit, facts->second.unit) << path;
  }
  std::cout << files << " files, " << with_places << " with " << places << " places; " << remarks << " remarks\n";
  EXPECT_GT(files, 0u);
  EXPECT_GE(found, 1u);
}

}}  // namespace tessera::test
