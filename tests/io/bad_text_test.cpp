// Texts that every reader must accept or report, in each format: truncated, with another layout, in another locale,
// with malformed numbers, and with counts that exceed their contents.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "io/text_formats.h"
#include "support/allocations.h"
#include "support/comma_locale.h"

namespace tessera::test { namespace {

class BadText : public testing::TestWithParam<TextFormat> {
 protected:
  /// In memory of its own, so that a sanitizer sees a read beyond the end.
  static Reading parse(const std::string& text) {
    const std::vector<char> bytes(text.begin(), text.end());
    return GetParam().parse(std::string_view(bytes.data(), bytes.size()), "m");
  }
};
INSTANTIATE_TEST_SUITE_P(Formats, BadText, testing::ValuesIn(text_formats()),
                         [](const auto& format) { return format.param.name; });

std::size_t lines_of(std::string_view text) {
  const auto ends = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  return std::max<std::size_t>(1, ends + (!text.empty() && text.back() != '\n'));
}

/// The line that "m:12: ..." names; 0 for none.
std::size_t line_in(const std::string& message) {
  std::size_t line = 0;
  if (message.starts_with("m:")) std::from_chars(message.data() + 2, message.data() + message.size(), line);
  return line;
}

/// Checks that an error names the file and, if a line, one of the text; and that a model or mesh is sound.
void expect_sound(const Reading& reading, std::string_view text, const std::string& what) {
  if (reading.ok()) {
    EXPECT_EQ(reading.unsound, "") << what << '\n' << text;
    return;
  }
  const std::string& message = reading.status.message();
  EXPECT_TRUE(message.starts_with("m:")) << message << '\n' << what;
  EXPECT_LE(line_in(message), lines_of(text)) << message << '\n' << what << '\n' << text;
  EXPECT_NE(reading.status.code(), StatusCode::internal) << message;
  EXPECT_NE(reading.status.code(), StatusCode::out_of_memory) << message;
  EXPECT_NE(reading.status.code(), StatusCode::io_error) << message;
}

TEST_P(BadText, CutAtEveryByteItIsRefusedOrItsBegin) {
  std::size_t refused = 0, cuts = 0;
  for (const std::string& sample : GetParam().samples()) {
    const Reading whole = parse(sample);
    ASSERT_TRUE(whole.ok()) << whole.status.message();
    EXPECT_EQ(whole.unsound, "");
    for (std::size_t bytes = 0; bytes < sample.size(); ++bytes, ++cuts) {
      const std::string cut = sample.substr(0, bytes);
      const Reading reading = parse(cut);
      expect_sound(reading, cut, "cut at byte " + std::to_string(bytes));
      EXPECT_LE(reading.parts, whole.parts) << "cut at byte " << bytes;
      refused += !reading.ok();
    }
    EXPECT_FALSE(parse({}).ok());
  }
  RecordProperty("cuts", std::to_string(cuts));
  RecordProperty("refused", std::to_string(refused));
  EXPECT_GT(2 * refused, cuts);
}

TEST_P(BadText, LayoutDoesNotMatter) {
  for (const std::string& sample : GetParam().samples()) {
    if (is_binary(sample)) continue;
    std::string windows, open = sample;
    for (const char c : sample) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    open.erase(open.find_last_not_of('\n') + 1);
    const std::string plain = parse(sample).content, mark = "\xEF\xBB\xBF";
    const auto expect_same = [&](const std::string& text, const char* what) {
      const Reading reading = parse(text);
      EXPECT_TRUE(reading.ok()) << what << ": " << reading.status.message() << '\n' << text;
      EXPECT_TRUE(reading.content == plain) << what << '\n' << text;
    };
    expect_same(windows, "CRLF");
    expect_same(mark + sample, "a byte order mark");
    expect_same(mark + windows, "a byte order mark and CRLF");
    expect_same(with_blanks(GetParam(), sample, "\t"), "tabs");
    expect_same(with_blanks(GetParam(), sample, " \t "), "more blanks");
    expect_same(open, "no end of the last line");
    expect_same(open + "\n\n \t\n", "empty lines at the end");
  }
}

TEST_P(BadText, TextsOfNothingAreRefused) {
  for (const std::string text : {"",
                                 " ",
                                 "\n",
                                 "\r\n",
                                 "\t\n \n\n",
                                 "\xEF\xBB\xBF",
                                 "\xEF\xBB\xBF\n",
                                 "#",
                                 "# words\n",
                                 "\\",
                                 "\\\n",
                                 "\"",
                                 "/",
                                 ",",
                                 "[",
                                 "]",
                                 "{}",
                                 "()",
                                 "\x1f\x8b",
                                 "\xFF\xFEv\0",
                                 "nonsense",
                                 "-1",
                                 "1e400",
                                 "\xC3"}) {
    const Reading reading = parse(text);
    EXPECT_FALSE(reading.ok()) << text;
    expect_sound(reading, text, "");
  }
  for (const std::size_t size : {1, 7, 1000, 100000}) {
    EXPECT_FALSE(parse(std::string(size, '\0')).ok());
    EXPECT_FALSE(parse(std::string(size, '\xff')).ok());
    EXPECT_FALSE(parse(std::string(size, '\n')).ok());
  }
}

TEST_P(BadText, TheLocaleDoesNotMatter) {
  for (const std::string& sample : GetParam().samples()) {
    const Reading plain = parse(sample);
    const std::string cut = sample.substr(0, sample.size() / 2);
    const std::string message = parse(cut).status.message();
    const CommaLocale commas;
    if (!commas.done()) GTEST_SKIP() << "no locale with a decimal comma here";
    const Reading reading = parse(sample);
    EXPECT_TRUE(reading.ok()) << reading.status.message();
    EXPECT_TRUE(reading.content == plain.content) << sample;
    EXPECT_EQ(parse(cut).status.message(), message);
  }
}

/// Places of numbers in a text, outside of strings and comments.
std::vector<std::pair<std::size_t, std::size_t>> numbers_in(const std::string& text) {
  std::vector<std::pair<std::size_t, std::size_t>> places;
  const auto part_of_number = [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) || c == '.' || c == '-';
  };
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '"') at = std::min(text.find('"', at + 1), text.size() - 1);
    if (text[at] == '#') at = std::min(text.find('\n', at), text.size() - 1);
    const bool begins =
        part_of_number(text[at]) && (at == 0 || !std::isalnum(static_cast<unsigned char>(text[at - 1])));
    std::size_t end = at;
    while (begins && end < text.size() && (part_of_number(text[end]) || text[end] == 'e')) ++end;
    if (begins) places.emplace_back(at, end - at);
    at = std::max(end, at + 1);
  }
  return places;
}

/// The texts in which one number of a sample is replaced.
template <class Use>
void for_each_with(const std::string& sample, const std::vector<std::string>& numbers, const Use& use) {
  for (const auto& [at, size] : numbers_in(sample))
    for (const std::string& number : numbers) {
      std::string text = sample;
      use(text.replace(at, size, number), number, lines_of(std::string_view(sample).substr(0, at + 1)));
    }
}

TEST_P(BadText, NumbersThatAreNoneAreRefusedWithTheirLine) {
  const bool mesh = GetParam().extension == ".ply" || GetParam().name == "obj_mesh";
  std::size_t texts = 0, refused = 0, named = 0;
  for (const std::string& sample : GetParam().samples()) {
    if (is_binary(sample)) continue;
    const std::vector<std::string> bad{"1e400", "-1e400", "nan", "inf",   "-inf", "1,5",
                                       "0x1p3", "1e",     "--1", "1.2.3", "x"};
    for_each_with(sample, bad, [&](const std::string& text, const std::string& number, std::size_t line) {
      const Reading reading = parse(text);
      expect_sound(reading, text, number);
      ++texts;
      refused += !reading.ok();
      if (reading.ok() || reading.status.message().find("found \"" + number + "\"") == std::string::npos) return;
      ++named;
      EXPECT_EQ(line_in(reading.status.message()), line) << reading.status.message() << '\n' << text;
    });
  }
  std::printf("%zu texts, %zu refused, %zu of them with the number and its line\n", texts, refused, named);
  // Some numbers belong to parts that are not read, and meshes may have vertices that are not finite.
  EXPECT_GT(refused, texts * (mesh ? 1 : 4) / 5);
}

TEST_P(BadText, ExtremeNumbersAreReadOrRefused) {
  for (const std::string& sample : GetParam().samples()) {
    if (is_binary(sample)) continue;
    for_each_with(sample, {"1e300", "-1e300", "1e-300", "1e-400", "-0", "0", "-1", "16", "1000"},
                  [&](const std::string& text, const std::string& number, std::size_t) {
                    expect_sound(parse(text), text, number);
                  });
  }
}

TEST_P(BadText, CountsThatTheTextDoesNotHoldTakeNoMemory) {
  std::size_t most = 0;
  std::string greedy;
  for (const std::string& sample : GetParam().samples()) {
    std::string header = sample;
    if (is_binary(sample)) header = sample.substr(0, sample.find("end_header"));
    const std::vector<std::string> counts{"100000",     "4000000",       "2147483647",          "4294967295",
                                          "4000000000", "1000000000000", "9223372036854775807", "18446744073709551616",
                                          "-2147483648"};
    for_each_with(header, counts, [&](const std::string& begin, const std::string& number, std::size_t) {
      const std::string text = begin + sample.substr(header.size());
      const std::size_t before = restart_peak();
      const Reading reading = GetParam().parse(text, "m");
      if (peak_bytes() - before > most) greedy = text;
      most = std::max(most, peak_bytes() - before);
      expect_sound(reading, is_binary(sample) ? begin : text, number);
    });
  }
  std::printf("at most %zu bytes\n", most);
  EXPECT_LE(most, std::size_t{100000}) << greedy;
}

}}  // namespace tessera::test
