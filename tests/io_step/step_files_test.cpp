// All STEP files of the real data: their instances beside those that a search by single characters finds.

#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "io/step/step_index.h"
#include "io/step/step_record.h"
#include "support/real_files.h"
#include "support/synthetic_sets.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;

/// The numbers of instances by a search, character by character, that shares no code with the index.
std::multiset<std::uint64_t> numbers_in(const std::string& text) {
  std::multiset<std::uint64_t> out;
  std::string statement;
  const std::size_t data = text.find("DATA;");
  for (std::size_t at = data == std::string::npos ? text.size() : data; at < text.size(); ++at) {
    if (text[at] == '\'') {
      at = std::min(text.find('\'', at + 1), text.size() - 1);
    } else if (text[at] == '/' && at + 1 < text.size() && text[at + 1] == '*') {
      at = std::min(text.find("*/", at + 2), text.size() - 2) + 1;
    } else if (text[at] == ';') {
      if (statement == "ENDSEC") break;
      for (std::size_t scope; (scope = statement.find("&SCOPE")) != std::string::npos; statement.erase(0, scope + 6))
        out.insert(std::stoull(statement.substr(1)));
      if (statement.size() > 1 && statement[0] == '#') out.insert(std::stoull(statement.substr(1)));
      statement.clear();
    } else if (!std::isspace(static_cast<unsigned char>(text[at]))) {
      statement += text[at];
    }
  }
  return out;
}

TEST(StepFiles, HoldTheInstancesThatASearchFinds) {
  const char* const folder = std::getenv("TESSERA_TEST_DATA");
  if (folder == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA names no folder of real files";
  std::size_t files = 0, instances = 0;
  for (const fs::path& path : step_files_below(folder)) {
    if (path.string().find("fault_cases") != std::string::npos) continue;
    SCOPED_TRACE(path.string());
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const Result<StepIndex> index = StepIndex::make(text);
    ASSERT_TRUE(index) << index.status().message();
    const std::multiset<std::uint64_t> expected = numbers_in(text);
    const std::set<std::uint64_t> distinct(expected.begin(), expected.end());
    EXPECT_EQ(index->instances().size(), distinct.size());
    EXPECT_EQ(index->remark_count(), expected.size() - distinct.size());
    StepRecord record;
    std::size_t unread = 0;
    for (const StepInstance& one : index->instances()) {
      EXPECT_TRUE(distinct.contains(one.number));
      const Status status = record.read(index->record(one));
      EXPECT_TRUE(status.ok() || ++unread > 3) << "#" << one.number << ": " << status.message();
    }
    ++files, instances += index->instances().size();
  }
  RecordProperty("files", static_cast<int>(files));
  EXPECT_GT(files, 100u);
  EXPECT_GT(instances, 100000u);
}

}}  // namespace tessera::test
