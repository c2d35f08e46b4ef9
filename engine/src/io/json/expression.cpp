#include "io/json/expression.h"
#include "io/file/text_cursor.h"

#include <muParser.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>

#include "base/text.h"
#include "parallel/workspaces.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t largest_count = 3;  // of variables

double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : x; }
double mod(double a, double b) { return a - b * std::floor(a / b); }

struct NamedFunction {
  const char* name;
  double (*function)(double);
};
constexpr auto functions = std::to_array<NamedFunction>({
    {"sin", std::sin},     {"cos", std::cos},     {"tan", std::tan},     {"asin", std::asin},   {"acos", std::acos},
    {"atan", std::atan},   {"sinh", std::sinh},   {"cosh", std::cosh},   {"tanh", std::tanh},   {"asinh", std::asinh},
    {"acosh", std::acosh}, {"exp", std::exp},     {"atanh", std::atanh}, {"ln", std::log},      {"log", std::log},
    {"log2", std::log2},   {"sqrt", std::sqrt},   {"cbrt", std::cbrt},   {"log10", std::log10}, {"abs", std::fabs},
    {"sign", sign},        {"floor", std::floor},
});
struct NamedFunction2 {
  const char* name;
  double (*function)(double, double);
};
constexpr auto functions2 = std::to_array<NamedFunction2>({
    {"atan2", std::atan2},
    {"hypot", std::hypot},
    {"min", std::fmin},
    {"max", std::fmax},
    {"mod", mod},
});

/// Reads a number at the begin of a text. Replaces muParser's own reader, which uses a stream: for a stream, running
/// out of memory looks like the end of the number.
int read_literal(const char* text, int* at, double* value) {
  if (!std::isdigit(static_cast<unsigned char>(text[0])) && text[0] != '.') return 0;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), *value);
  if (error != std::errc{} || std::isalpha(static_cast<unsigned char>(*end))) return 0;  // as muParser's stream does
  *at += static_cast<int>(end - text);
  return 1;
}

/// muParser with the vocabulary of expression.h alone. Its own pi has 13 digits, and it has random numbers.
class Evaluator {
 public:
  Evaluator(const std::string& text, std::span<const std::string> variables) {
    parser_.ClearConst();
    parser_.ClearFun();
    parser_.AddValIdent(read_literal);
    parser_.EnableOptimizer(false);  // the optimizer reorders sums
    parser_.DefineConst("pi", std::numbers::pi);
    parser_.DefineConst("e", std::numbers::e);
    for (const NamedFunction& f : functions) parser_.DefineFun(f.name, f.function);
    for (const NamedFunction2& f : functions2) parser_.DefineFun(f.name, f.function);
    for (std::size_t k = 0; k < variables.size(); ++k) parser_.DefineVar(variables[k], &values_[k]);
    parser_.SetExpr(text);
  }
  Evaluator(const Evaluator&) = delete;  // the parser holds pointers to the values
  Evaluator& operator=(const Evaluator&) = delete;

  double operator()(std::span<const double> values) {
    std::copy(values.begin(), values.end(), values_.begin());
    return parser_.Eval();
  }
  /// The number of values in the text, separated by commas.
  int count() {
    int count = 0;
    parser_.Eval(count);
    return count;
  }

 private:
  std::array<double, largest_count> values_{};
  mu::Parser parser_;
};

Status refusal(std::string_view text, std::string_view reason) {
  return {StatusCode::parse_error, quote(text) + ": " + std::string(reason)};
}

/// The error for a character that muParser would take beyond the vocabulary: assignments, strings, control characters.
std::optional<Status> foreign_character(std::string_view text) {
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    const bool is_word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!is_word && std::string_view("+-*/^()<>=!&|?:,. \t\n\r").find(c) == std::string_view::npos)
      return refusal(text, "unexpected character " + quote(text.substr(k, 1)) + " at position " + std::to_string(k));
    if (c != '=') continue;
    const bool ends_comparison = k > 0 && std::string_view("<>!=").find(text[k - 1]) != std::string_view::npos;
    const bool begins_comparison = k + 1 < text.size() && text[k + 1] == '=';
    if (!ends_comparison && !begins_comparison)
      return refusal(text, "there are no assignments (\"=\" at position " + std::to_string(k) + "); == compares");
  }
  return {};
}

/// muParser's message, made printable and bounded in length.
std::string reason(const mu::ParserError& error) {
  constexpr std::size_t longest = 120;
  std::string words;
  for (const char c : error.GetMsg().substr(0, longest)) words += c >= 0x20 && c < 0x7f ? c : '?';
  if (error.GetMsg().size() > longest) words += "...";
  while (!words.empty() && (words.back() == '.' && words.size() <= longest)) words.pop_back();
  return words;
}

}  // namespace

struct Expression::Pool {
  std::string text;
  std::vector<std::string> variables;
  Workspaces<Evaluator> evaluators;

  Workspaces<Evaluator>::Lease take() { return evaluators.take(text, variables); }
};

Result<Expression> Expression::compile(std::string_view text, std::span<const std::string_view> variables) {
  if (text.size() > largest_length)
    return refusal(text, "longer than " + std::to_string(largest_length) + " characters");
  if (variables.size() > largest_count) return refusal(text, "too many variables");
  if (const std::optional<Status> status = foreign_character(text)) return *status;
  auto pool = std::make_shared<Pool>();
  pool->text = text;
  pool->variables.assign(variables.begin(), variables.end());
  try {
    if ((*pool->take()).count() != 1) return refusal(text, "expected one value, found a list");
  } catch (const mu::ParserError& error) {
    return refusal(text, reason(error));
  }
  return Expression(std::move(pool));
}

double Expression::operator()(std::span<const double> values) const { return (*pool_->take())(values); }

const std::string& Expression::text() const { return pool_->text; }

Result<double> constant_value(std::string_view text) {
  const Result<Expression> expression = Expression::compile(text, {});
  if (!expression) return expression.status();
  const double value = (*expression)({});
  if (!std::isfinite(value))
    return Status(StatusCode::non_finite, quote(text) + ": the value " + tessera::text(value) + " is not finite");
  return value;
}

}}  // namespace tessera::abi_0_1
