// Tokens, numbers and the lines of errors.

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "io/file/text_cursor.h"

namespace tessera { namespace {

double number_of(std::string_view text) {
  TextCursor cursor(text, "t");
  double value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(cursor.take_number(value)) << text;
  EXPECT_TRUE(cursor.at_end()) << text;
  return value;
}

TEST(TextCursor, NumbersAreRead) {
  EXPECT_EQ(number_of("0"), 0);
  EXPECT_EQ(number_of("-2.5"), -2.5);
  EXPECT_EQ(number_of("+2.5"), 2.5);
  EXPECT_EQ(number_of(".5"), 0.5);
  EXPECT_EQ(number_of("5."), 5);
  EXPECT_EQ(number_of("1e-3"), 1e-3);
  EXPECT_EQ(number_of("1E+3"), 1e3);
}

TEST(TextCursor, EveryDoubleComesBack) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 2000; ++k) {
    const std::uint64_t bits = random();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    char text[32];
    const char* const end = std::to_chars(text, text + sizeof text, value).ptr;
    EXPECT_EQ(number_of({text, static_cast<std::size_t>(end - text)}), value);
  }
}

TEST(TextCursor, WhatIsTooSmallIsZeroAndWhatIsTooLargeIsNotFinite) {
  for (const char* tiny :
       {"1e-400", "123e-500", "0.1e-99999999999999999999", "1e-9223372036854775808", "0.01e-9223372036854775808"}) {
    EXPECT_EQ(number_of(tiny), 0) << tiny;
  }
  EXPECT_EQ(number_of("0." + std::string(400, '0') + "1"), 0);
  EXPECT_TRUE(std::signbit(number_of("-1e-400")));
  EXPECT_EQ(number_of("4.9406564584124654e-324"), std::numeric_limits<double>::denorm_min());
  for (const char* huge :
       {"1e400", "0.001e500", "1e99999999999999999999", "1e9223372036854775807", "10e+9223372036854775807"})
    EXPECT_EQ(number_of(huge), HUGE_VAL) << huge;
  EXPECT_EQ(number_of("-1e400"), -HUGE_VAL);
  for (const char* text : {"1e400", "-1e400", "inf", "-inf", "nan", "NaN", "Infinity"}) {
    TextCursor cursor(text, "t");
    double value = 7;
    EXPECT_FALSE(cursor.take_finite(value)) << text;
    EXPECT_EQ(value, 7);
    EXPECT_EQ(cursor.peek_token(), text);
  }
}

TEST(TextCursor, WhatIsNoNumberIsRefused) {
  for (const char* text :
       {"", "x", "1.5x", "1,5", "--1", "+-1", "0x10", "1e", "e5", ".", "-", "+", "1.2.3", "1\xC2\xA0"}) {
    TextCursor cursor(text, "t");
    double value = 0;
    EXPECT_FALSE(cursor.take_number(value)) << text;
  }
  for (const char* text : {"3.0", "3e0", "99999999999999999999", ""}) {
    TextCursor cursor(text, "t");
    std::int64_t value = 0;
    EXPECT_FALSE(cursor.take_number(value)) << text;
  }
}

TEST(TextCursor, NoLocaleChangesNumbers) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  if (!std::setlocale(LC_ALL, "de_DE.UTF-8") && !std::setlocale(LC_ALL, "fr_FR.UTF-8")) {
    GTEST_SKIP() << "no locale with a decimal comma here";
  }
  EXPECT_EQ(number_of("2.5"), 2.5);
  std::setlocale(LC_ALL, before.c_str());
}

TEST(TextCursor, LinesAreCounted) {
  TextCursor cursor("\xEF\xBB\xBF# a comment\r\n\r\n\t7 # more\r\n x", "t.txt");
  cursor.skip_space();
  std::int64_t value = 0;
  EXPECT_EQ(cursor.line(), 3u);
  EXPECT_TRUE(cursor.take_number(value));
  EXPECT_EQ(value, 7);
  EXPECT_TRUE(cursor.take_line_end());
  cursor.skip_space();
  EXPECT_EQ(cursor.line(), 4u);
  EXPECT_EQ(cursor.expected("a number").message(), "t.txt:4: expected a number, found \"x\"");
  EXPECT_EQ(cursor.expected("a number").code(), StatusCode::parse_error);
}

TEST(TextCursor, ALineMayBeContinued) {
  TextCursor cursor("a \\\n b\\ \t\r\n\\\n#c \\\nd\\e \\", "t", {.continuation = '\\'});
  for (const char* token : {"a", "b"}) {
    cursor.skip_blanks();
    EXPECT_EQ(cursor.peek_token(), token);
    cursor.skip(cursor.peek_token());
  }
  EXPECT_TRUE(cursor.take_line_end());  // a comment is not continued
  EXPECT_EQ(cursor.line(), 5u);
  EXPECT_EQ(cursor.peek_token(), "d\\e");  // in a token it is a character like others
  cursor.skip("d\\e");
  EXPECT_TRUE(cursor.take_line_end());
  EXPECT_TRUE(cursor.at_end());
  TextCursor without("a \\\n", "t");
  without.skip("a");
  EXPECT_FALSE(without.take_line_end());
  EXPECT_EQ(without.peek_token(), "\\");
}

TEST(TextCursor, LinesAreSkippedWithTheirContinuations) {
  TextCursor cursor("a \\\n b\\\r\n c\nd\\", "t", {.continuation = '\\'});
  cursor.skip_line();
  EXPECT_TRUE(cursor.take_line_end());
  EXPECT_EQ(cursor.peek_token(), "d");
  cursor.skip_line();
  EXPECT_TRUE(cursor.at_end());
  TextCursor without("a \\\nb", "t");
  without.skip_line();
  EXPECT_TRUE(without.take_line_end());
  EXPECT_EQ(without.peek_token(), "b");
}

TEST(TextCursor, ZeroBytesAreCharactersOfTokens) {
  for (const TextSyntax& syntax : {TextSyntax{}, TextSyntax{.comment = 0}, TextSyntax{.continuation = '\\'}}) {
    TextCursor cursor(std::string_view(" \0\0a 1\0 2", 10), "t", syntax);
    cursor.skip_blanks();
    EXPECT_EQ(cursor.peek_token(), std::string_view("\0\0a", 3));
    cursor.skip(cursor.peek_token());
    cursor.skip_blanks();
    double value = 0;
    EXPECT_FALSE(cursor.take_number(value));
    EXPECT_EQ(cursor.expected("a number").message(), "t:1: expected a number, found \"1\\x00\"");
  }
}

TEST(TextCursor, EndsAreNamed) {
  TextCursor line("  \n", "t");
  line.skip_blanks();
  EXPECT_EQ(line.expected("a number").message(), "t:1: expected a number, found the end of the line");
  line.skip_space();
  EXPECT_TRUE(line.at_end());
  EXPECT_EQ(line.expected("a number").message(), "t:1: expected a number, found the end of the file");
  TextCursor separated(",", "t", {.separators = ","});
  EXPECT_EQ(separated.expected("a number").message(), "t:1: expected a number, found \",\"");
}

TEST(TextCursor, WhatCannotBePrintedIsEscapedAndCut) {
  EXPECT_EQ(quote("a\x01\xff"), "\"a\\x01\\xff\"");
  EXPECT_EQ(quote(std::string(100, 'a')), "\"" + std::string(40, 'a') + "...\"");
}

}}  // namespace tessera
