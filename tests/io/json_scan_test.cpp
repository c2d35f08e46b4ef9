// The fast pass over JSON against nlohmann's parser: what it takes, the other takes as well, with the same events.

#include "io/json/json_scan.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

namespace tessera { inline namespace abi_0_1 { namespace {

using Json = nlohmann::json;

/// Events as texts; numbers by their bits.
class Recorder : public nlohmann::json_sax<Json> {
 public:
  std::vector<std::string> events;

  bool number(double value) { return add("n" + std::to_string(std::bit_cast<std::uint64_t>(value))); }
  bool start_object() { return add("{"); }
  bool start_array() { return add("["); }
  static std::optional<std::string> quoted(std::string_view token) {
    const Json parsed = Json::parse(token, nullptr, false);
    return parsed.is_string() ? std::optional(parsed.get<std::string>()) : std::nullopt;
  }

  bool null() override { return add("null"); }
  bool boolean(bool value) override { return add(value ? "true" : "false"); }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override { return add("s" + value); }
  bool binary(binary_t&) override { return false; }
  bool key(string_t& value) override { return add("k" + value); }
  bool start_object(std::size_t) override { return start_object(); }
  bool end_object() override { return add("}"); }
  bool start_array(std::size_t) override { return start_array(); }
  bool end_array() override { return add("]"); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  bool add(std::string event) {
    events.push_back(std::move(event));
    return events.size() < 100000;
  }
};

/// Compares both. Returns whether the fast pass takes the text.
bool compare(const std::string& text) {
  Recorder fast, slow;
  std::size_t read = 0;
  if (!JsonScan<Recorder>(text, read, fast).run()) return false;
  EXPECT_LE(read, text.size() + 1);
  EXPECT_TRUE(Json::sax_parse(text, &slow)) << text;
  EXPECT_EQ(fast.events, slow.events) << text;
  return true;
}

TEST(JsonScan, TakesWhatIsJson) {
  for (const char* const text :
       {"1", "-0", "-0.0", "[]", "{}", " [ ] ", "[1,2.5,-3e2,1E+3,0.1e-2]", "{\"a\":{\"b\":[true,false,null]}}", "\"\"",
        "\"a\\n\\u00e4\\ud83d\\ude00\"", "\"\xC3\xA4\"", "[18446744073709551615,-9223372036854775808]",
        "[18446744073709551616,123456789012345678901234567890,0.1,5e-324,1.7976931348623157e308]", "\t[\r\n1 , 2 ]\n"})
    EXPECT_TRUE(compare(text)) << text;
}

TEST(JsonScan, LeavesTheRestToTheOther) {
  for (const char* const text : {"",
                                 " ",
                                 "01",
                                 "-",
                                 "1.",
                                 ".5",
                                 "1e",
                                 "+1",
                                 "1 2",
                                 "[1,]",
                                 "[1 2]",
                                 "[,1]",
                                 "{\"a\" 1}",
                                 "{\"a\":1,}",
                                 "{a:1}",
                                 "[1",
                                 "\"",
                                 "\"\\",
                                 "\"\x01\"",
                                 "\"\xFF\"",
                                 "\"\xC0\x80\"",
                                 "\"\\ud83d\"",
                                 "\"\\x\"",
                                 "nul",
                                 "truefalse",
                                 "1e999",
                                 "[1]]",
                                 "\xEF\xBB\xBF[1]",
                                 "NaN",
                                 "Infinity",
                                 "/**/1"})
    EXPECT_FALSE(compare(text)) << text;
}

TEST(JsonScan, MutatedFilesGiveTheSameEvents) {
  std::vector<std::string> seeds{
      R"({"format": "tessera", "version": 1, "surfaces": [{"kind": "b", "points": [[0, -1.5e3, 2.25], [1e-7, 3, 4]]}]})"};
  for (const auto& file :
       std::filesystem::directory_iterator(std::filesystem::path(TESSERA_SOURCE_DIR) / "tests/corpus/json"))
    if (file.file_size() < 4096) seeds.push_back(test::content_of(file.path()));
  std::mt19937 random(7);
  const std::string_view alphabet = "0123456789-+.eE[]{},:\"\\ \nutfn\x80\xC3";
  std::size_t taken = 0;
  for (int round = 0; round < 60000; ++round) {
    std::string text = seeds[random() % seeds.size()];
    for (unsigned k = random() % 4; k > 0 && !text.empty(); --k) {
      const std::size_t at = random() % text.size();
      const char c = alphabet[random() % alphabet.size()];
      switch (random() % 3) {
        case 0:
          text[at] = c;
          break;
        case 1:
          text.insert(at, 1, c);
          break;
        default:
          text.erase(at, 1 + random() % 3);
      }
    }
    taken += compare(text);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(taken, 10000u);
}

}}}  // namespace tessera::abi_0_1
