// Encodings of texts: which one the bytes are in, and their characters as UTF-8.

#include <gtest/gtest.h>

#include <string>

#include "io/file/text_encoding.h"

namespace tessera::test { namespace {

TEST(TextEncoding, IsToldByTheBytes) {
  const std::string ascii = "no byte beyond ASCII, at any place of a word of eight";
  EXPECT_EQ(encoding_of(ascii), TextEncoding::utf8);
  EXPECT_EQ(encoding_of(""), TextEncoding::utf8);
  for (std::size_t k = 0; k < ascii.size(); ++k) {
    const auto with = [&](const std::string& bytes) { return ascii.substr(0, k) + bytes + ascii.substr(k); };
    EXPECT_EQ(encoding_of(with("\xC3\xA4")), TextEncoding::utf8);
    EXPECT_EQ(encoding_of(with("\xF0\x9F\x98\x80")), TextEncoding::utf8);
    EXPECT_EQ(encoding_of(with("\xE4")), TextEncoding::latin1);
    EXPECT_EQ(encoding_of(with("\xD7\xB0\xC5\xE4")), TextEncoding::gbk);
  }
  // Overlong forms, halves of pairs, and characters that are cut off are no UTF-8.
  for (const char* const bad : {"\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xC3", "\x80"})
    EXPECT_NE(encoding_of(ascii + bad), TextEncoding::utf8);
}

TEST(TextEncoding, OfLatin1IsWindows1252) {
  EXPECT_EQ(to_utf8("Geh\xE4use", TextEncoding::latin1), "Geh\xC3\xA4use");
  EXPECT_EQ(to_utf8("\x80 \x85 \x99 \xA0 \xFF", TextEncoding::latin1),
            "\xE2\x82\xAC \xE2\x80\xA6 \xE2\x84\xA2 \xC2\xA0 \xC3\xBF");
  EXPECT_EQ(to_utf8("Geh\xC3\xA4use", TextEncoding::utf8), "Geh\xC3\xA4use");
}

TEST(TextEncoding, OfChineseIsGbk) {
  EXPECT_EQ(to_utf8("a\xD7\xB0\xC5\xE4z", TextEncoding::gbk), "a\xE8\xA3\x85\xE9\x85\x8Dz");
  // Bytes that are no character become U+FFFD, also at the end; the rest stays.
  EXPECT_EQ(to_utf8("a\xFFz", TextEncoding::gbk), "a\xEF\xBF\xBDz");
  EXPECT_EQ(to_utf8("a\xD7", TextEncoding::gbk), "a\xEF\xBF\xBD");
  EXPECT_EQ(to_utf8("", TextEncoding::gbk), "");
  // Longer than one piece of the conversion.
  std::string given, expected;
  for (int k = 0; k < 5000; ++k) given += "\xD7\xB0", expected += "\xE8\xA3\x85";
  EXPECT_EQ(to_utf8(given, TextEncoding::gbk), expected);
}

}}  // namespace tessera::test
