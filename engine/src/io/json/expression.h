#pragma once
// Formulas in text: borders and surfaces of models, and numbers like sqrt(2)/2.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A real function of named variables, such as u and v.
///   numbers    1  .5  2.5e-3, always with a point
///   constants  pi, e
///   operators  ^ before a sign before * / before + - before < > <= >= == != before && before || before a ? b : c;
///              ^ groups from the right, so 2^3^2 = 512, -2^2 = -4, 2^-1 = 0.5; the others from the left
///   functions  sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp, ln and log (both to the base e),
///              log2 log10 sqrt cbrt abs sign floor, and of two arguments atan2(y, x) hypot min max and
///              mod (a - b floor(a/b))
/// Angles are in radians. Computes in double, in the order written: 1/2 is 0.5, 1e17 + 1 - 1e17 is 0. A comparison is 1
/// or 0. There are no assignments, strings, lists or other functions; two signs in a row need parentheses. Const calls
/// may be made from any number of threads: each takes an evaluator of its own from a pool. Copies share the pool.
class Expression {
 public:
  static constexpr std::size_t largest_length = 4096;
  /// Compiles `text`, with at most three variables. Errors: parse_error (names the place in the expression), also for
  /// an empty text or one of more than 4096 characters.
  static Result<Expression> compile(std::string_view text, std::span<const std::string_view> variables);

  /// Evaluates at one value per variable. The result is NaN or infinite where the formula has no value.
  double operator()(std::span<const double> values) const;
  const std::string& text() const;

 private:
  struct Pool;
  explicit Expression(std::shared_ptr<Pool> pool) : pool_(std::move(pool)) {}
  std::shared_ptr<Pool> pool_;
};

/// The value of an expression without variables. Errors: as above, and non_finite.
Result<double> constant_value(std::string_view text);

}}  // namespace tessera::abi_0_1
