// The document of the format, tools/models/FORMAT.md, is right: its examples can be read, and it omits no kind and no
// key.

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "io/model_text.h"
#include "support/scratch_folder.h"

namespace tessera::test { namespace {

std::string document() { return content_of(TESSERA_SOURCE_DIR "/tools/models/FORMAT.md"); }

/// The text of each ```json block.
std::vector<std::string> examples() {
  std::vector<std::string> blocks;
  std::istringstream lines(document());
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      inside = line == "```json";
      if (inside) blocks.emplace_back();
    } else if (inside) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

/// A whole model, or one surface of one.
std::string as_model(const std::string& example) {
  return example.find("\"format\"") != std::string::npos ? example : json_with(example);
}

/// The words between `begin` and `end` in an error message, split at commas.
std::vector<std::string> listed_in_refusal(const std::string& surface, const std::string& begin,
                                           const std::string& end) {
  const std::string message = parse_json_model(json_with(surface), "m.json").status().message();
  const std::size_t from = message.find(begin) + begin.size();
  std::istringstream list(message.substr(from, end.empty() ? std::string::npos : message.find(end) - from));
  std::vector<std::string> words;
  for (std::string word; std::getline(list >> std::ws, word, ',');) words.push_back(word);
  return words;
}
std::vector<std::string> kinds() { return listed_in_refusal(R"({"kind": "?"})", "one of ", ", found"); }

TEST(JsonFormat, EveryExampleIsRead) {
  const std::vector<std::string> blocks = examples();
  EXPECT_GT(blocks.size(), 20u);
  for (const std::string& block : blocks) {
    const Result<Model> model = parse_json_model(as_model(block), "FORMAT.md");
    ASSERT_TRUE(model.ok()) << block << model.status().message();
    const Result<PatchSet> set = make_patch_set(*model);
    EXPECT_TRUE(set.ok()) << block << set.status().message();
  }
}

TEST(JsonFormat, EveryKindHasAnExample) {
  std::string all;
  for (const std::string& block : examples()) all += block;
  EXPECT_EQ(kinds().size(), 20u);
  for (const std::string& kind : kinds()) EXPECT_NE(all.find("\"kind\": \"" + kind + "\""), std::string::npos) << kind;
}

TEST(JsonFormat, EveryKeyIsTold) {
  const std::string text = document();
  for (const std::string& kind : kinds()) {
    const auto keys = listed_in_refusal(surface_of(kind, R"("?": 0)"), "known keys are ", "");
    EXPECT_GE(keys.size(), 5u);
    for (const std::string& key : keys) EXPECT_NE(text.find("`" + key + "`"), std::string::npos) << kind << ": " << key;
  }
}

}}  // namespace tessera::test
