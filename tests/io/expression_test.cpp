// Expressions: values, errors, and independence of threads.

#include "io/json/expression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <thread>

#include "support/errors.h"
#include "support/random_patches.h"
#include "support/synthetic_sets.h"

namespace tessera { namespace {

constexpr std::array<std::string_view, 2> uv{"u", "v"};

Expression compiled(std::string_view text) { return test::value_of(Expression::compile(text, uv)); }
double value(std::string_view text, double u = 0.5, double v = 2) { return compiled(text)(std::array{u, v}); }

/// Expects an error at once, with the expression and these words.
void expect_refusal(std::string_view text, const std::string& words) {
  test::expect_refused(Expression::compile(text, uv), StatusCode::parse_error, Status::no_index, words);
}

TEST(Expression, OperatorsBindAsInMathematics) {
  EXPECT_EQ(value("-2^2"), -4);
  EXPECT_EQ(value("-u^2"), -0.25);
  EXPECT_EQ(value("2*-3^2"), -18);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("2^-1*3"), 1.5);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("3-2-1"), 0);
  EXPECT_EQ(value("8/4/2"), 1);
  EXPECT_EQ(value("1+2*3"), 7);
  EXPECT_EQ(value("(1+2)*3"), 9);
  EXPECT_EQ(value("2-+1"), 1);
  EXPECT_EQ(value("1+1<3 && 2>1 || 0"), 1);
  EXPECT_EQ(value("u<1 ? 2 : 3"), 2);
  EXPECT_EQ(value("u>1 ? 2 : v==2 ? 4 : 5"), 4);
  EXPECT_EQ(value("u!=v"), 1);
  EXPECT_EQ(value("u>=v"), 0);
  EXPECT_EQ(value(" u \n+\tv "), 2.5);
}

TEST(Expression, NumbersAreDoublesInTheOrderWritten) {
  EXPECT_EQ(value("1/2"), 0.5);
  EXPECT_EQ(value("7/2*2"), 7);
  EXPECT_EQ(value(".5"), 0.5);
  EXPECT_EQ(value("2.5e-3"), 2.5e-3);
  EXPECT_EQ(value("0.1"), 0.1);
  EXPECT_EQ(value("9007199254740993"), 9007199254740992.0);
  EXPECT_EQ(value("1e17 + 1 - 1e17"), 0);
  EXPECT_EQ(value("u + 1e17 - 1e17"), 0);
  EXPECT_EQ(value("pi"), std::numbers::pi);
  EXPECT_EQ(value("e"), std::numbers::e);
}

TEST(Expression, FunctionsAreThoseOfTheLibrary) {
  struct Sample {
    const char* text;
    double value;
  };
  for (const Sample& s : {Sample{"sin(u)", std::sin(0.5)},
                          {"cos(u)", std::cos(0.5)},
                          {"tan(u)", std::tan(0.5)},
                          {"asin(u)", std::asin(0.5)},
                          {"acos(u)", std::acos(0.5)},
                          {"atan(u)", std::atan(0.5)},
                          {"sinh(u)", std::sinh(0.5)},
                          {"cosh(u)", std::cosh(0.5)},
                          {"tanh(u)", std::tanh(0.5)},
                          {"asinh(u)", std::asinh(0.5)},
                          {"acosh(v)", std::acosh(2.0)},
                          {"atanh(u)", std::atanh(0.5)},
                          {"exp(u)", std::exp(0.5)},
                          {"ln(v)", std::log(2.0)},
                          {"log(v)", std::log(2.0)},
                          {"log2(8)", 3},
                          {"log10(1000)", 3},
                          {"sqrt(2)/2", std::sqrt(2.0) / 2},
                          {"cbrt(27)", 3},
                          {"abs(-u)", 0.5},
                          {"sign(-u)", -1},
                          {"sign(0)", 0},
                          {"floor(-u)", -1},
                          {"atan2(v, u)", std::atan2(2.0, 0.5)},
                          {"hypot(3, 4)", 5},
                          {"min(u, v)", 0.5},
                          {"max(u, v)", 2},
                          {"mod(-1, 3)", 2},
                          {"mod(7, 3)", 1}})
    EXPECT_DOUBLE_EQ(value(s.text), s.value) << s.text;  // compilers round constants better than libraries do
}

TEST(Expression, WhatHasNoValueIsNaNOrInfinite) {
  for (const char* text : {"sqrt(-1)", "0/0", "ln(-u)", "(-8)^(1/3)", "acos(v)"})
    EXPECT_TRUE(std::isnan(value(text))) << text;
  EXPECT_EQ(value("1/0"), test::infinity);
  EXPECT_EQ(value("-1/0"), -test::infinity);
  EXPECT_EQ(value("0^0"), 1);
}

TEST(Expression, RefusalsSayWhatAndWhere) {
  expect_refusal("", "empty");
  expect_refusal("  ", "empty");
  expect_refusal("u+", "\"u+\": ");
  expect_refusal("sin(u", "Missing parenthesis");
  expect_refusal("u)", "position 1");
  expect_refusal("sin u", "\"sin\" found at position 0");
  expect_refusal("2u", "\"u\" found at position 1");
  expect_refusal("2(3)", "position 1");
  expect_refusal("u v", "\"v\" found at position 2");
  expect_refusal("u + w", "\"w\" found at position 4");
  expect_refusal("t", "\"t\" found at position 0");
  expect_refusal("--1", "position 2");
  expect_refusal("sin()", "Too few parameters");
  expect_refusal("atan2(1, 2, 3)", "Too many parameters");
  expect_refusal("min(1)", "Too few parameters");
  expect_refusal("1 ? 2", "else");
  expect_refusal("1e400", "1e400");
  expect_refusal("2e", "2e");
  expect_refusal("0x10", "x10");
  expect_refusal("1.5.2", "position 3");
}

TEST(Expression, ThereAreNoAssignmentsStringsListsOrOtherNames) {
  expect_refusal("u = 3", "there are no assignments (\"=\" at position 2)");
  expect_refusal("u += 3", "there are no assignments");
  expect_refusal("1, 2", "expected one value, found a list");
  expect_refusal("\"text\"", "unexpected character \"\"\" at position 0");
  expect_refusal("u[0]", "unexpected character \"[\" at position 1");
  expect_refusal("1;2", "unexpected character \";\" at position 1");
  expect_refusal("\xcf\x80", "unexpected character \"\\xcf\" at position 0");
  expect_refusal(std::string_view("1\0+1", 4), "unexpected character \"\\x00\" at position 1");
  for (const char* name : {"_pi", "_e", "rnd()", "sum(1, 2)", "avg(1, 2)", "rint(1)", "PI", "U", "nan", "inf"})
    expect_refusal(name, "position");
}

TEST(Expression, LengthIsLimited) {
  const auto ones = [](std::size_t count) {
    std::string text = "1";
    while (text.size() + 2 <= count) text += "+1";
    return text;
  };
  EXPECT_EQ(value(ones(4095)), 2048);
  expect_refusal(ones(4097), "longer than 4096 characters");
}

TEST(Expression, HostileTextsAreRefusedOrHaveAValue) {
  for (const char* piece :
       {"(", "-(", "sin(", "1?", "1?1:", "u^", "1+", "-", "!", "min(1,", "u==", "(u?", ",", ")", ":"})
    for (const std::size_t count : {std::size_t{500}, std::size_t{4000}, std::size_t{1000000}}) {
      std::string text;
      while (text.size() < count) text += piece;
      for (const bool closed : {false, true}) {
        if (closed) text += "1" + std::string(std::count(text.begin(), text.end(), '('), ')');
        const Result<Expression> result = Expression::compile(text, uv);
        if (count > 4096) {
          EXPECT_FALSE(result.ok());
        }
        if (!result) {
          EXPECT_EQ(result.status().code(), StatusCode::parse_error);
          EXPECT_LT(result.status().message().size(), 300u);
        }
      }
    }
}

TEST(Expression, RandomTextsNeverCrash) {
  constexpr std::string_view pieces[] = {"u",  "v", "1", ".5", "2e3", "+", "-",    "*",      "/",  "^",  "(",  ")",
                                         ",",  "?", ":", "<",  "==",  "!", "sin(", "min(",   "pi", "e",  "&&", "||",
                                         "\"", "=", " ", "w",  "_",   "%", "[",    "atan2(", "'",  "\\", "\n", "\x80"};
  test::Random random(5);
  int accepted = 0;
  for (int k = 0; k < 20000; ++k) {
    std::string text;
    for (std::size_t n = 1 + random() % 12; n > 0; --n) text += pieces[random() % std::size(pieces)];
    const Result<Expression> result = Expression::compile(text, uv);
    if (result) accepted += std::isfinite((*result)(std::array{0.5, 2.0}));
  }
  EXPECT_GT(accepted, 200);
}

TEST(Expression, ManyThreadsSeeTheirOwnVariables) {
  const Expression expression = compiled("u*1000 + v");
  std::array<int, 8> wrong{};
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < wrong.size(); ++t)
    threads.emplace_back([&, t] {
      for (int k = 0; k < 2000; ++k) {
        const double u = static_cast<double>(t), v = k;
        wrong[t] += expression(std::array{u, v}) != 1000 * u + v;
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const int count : wrong) EXPECT_EQ(count, 0);
}

TEST(Expression, ConstantsHaveNoVariablesAndAreFinite) {
  EXPECT_EQ(test::value_of(constant_value("sqrt(2)/2")), std::sqrt(2.0) / 2);
  EXPECT_EQ(test::value_of(constant_value("2*pi")), 2 * std::numbers::pi);
  test::expect_refused(constant_value("u"), StatusCode::parse_error, Status::no_index, "\"u\" found at position 0");
  test::expect_refused(constant_value("1/0"), StatusCode::non_finite, Status::no_index, "is not finite");
  test::expect_refused(constant_value("0/0"), StatusCode::non_finite, Status::no_index, "is not finite");
}

}}  // namespace tessera
