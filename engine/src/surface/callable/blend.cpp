#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.h"
#include "basis/double_double.h"
#include "surface/callable/callables.h"
#include "surface/callable/differences.h"
#include "surface/net/validate.h"
#include "tessera/coons_patch.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double largest_coefficient = 1e6;  // rounding of larger ones would hide the conditions
constexpr double polynomial_tolerance = 1e-12, callable_tolerance = 1e-9;
constexpr int samples = 65;

std::string name_of(std::size_t a) { return a == 0 ? "f1" : "f2"; }

/// Returns p(t) by Horner's scheme in double-double, since power coefficients cancel near t = 1.
double polynomial_value(std::span<const double> coefficients, double t) {
  DoubleDouble p;
  for (std::size_t i = coefficients.size(); i-- > 0;) p = p * t + DoubleDouble{coefficients[i], 0};
  return p.rounded();
}

/// Returns p(t), p'(t) and p''(t) in the same way.
std::array<double, 3> polynomial_jet(std::span<const double> coefficients, double t) {
  std::array<DoubleDouble, 3> p{};
  for (std::size_t i = coefficients.size(); i-- > 0;) {
    p[2] = p[2] * t + p[1];
    p[1] = p[1] * t + p[0];
    p[0] = p[0] * t + DoubleDouble{coefficients[i], 0};
  }
  return {p[0].rounded(), p[1].rounded(), 2 * p[2].rounded()};
}

Result<double> value_of(const std::function<double(double)>& f, std::size_t a, double t) {
  const auto place = [&] { return "blending function " + name_of(a) + " at t = " + text(t); };
  Result<double> value = called([&] { return f(t); }, place);
  if (value && !std::isfinite(*value))
    return Status(StatusCode::non_finite, place() + " is " + text(*value) + ", it must be finite");
  return value;
}

Result<std::array<double, 3>> jet_by_differences(const std::function<double(double)>& f, std::size_t a, double t) {
  const auto middle = value_of(f, a, t);
  if (!middle) return middle.status();
  const DifferenceStencil stencil(t, 0, 1);
  std::array<double, DifferenceStencil::size> values;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto value = value_of(f, a, stencil.at[k]);
    if (!value) return value.status();
    values[k] = *value;
  }
  return std::array{*middle, stencil.derivative(stencil.first, values, *middle),
                    stencil.derivative(stencil.second, values, *middle)};
}

/// Checks that `condition` holds: |error| <= tolerance.
Status check_condition(const char* condition, double error, double tolerance) {
  if (std::abs(error) <= tolerance) return {};
  return {StatusCode::invalid_argument, std::string("the blending functions must satisfy ") + condition +
                                            ", they miss it by " + text(std::abs(error)) + "; the tolerance is " +
                                            text(tolerance)};
}

/// Checks f1 at 0 and 1; the caller checks the sum f1 + f2.
Status check_ends(double at_zero, double at_one, double tolerance) {
  if (Status status = check_condition("f1(0) = 1", at_zero - 1, tolerance); !status.ok()) return status;
  return check_condition("f1(1) = 0", at_one, tolerance);
}

/// Returns finite coefficients that are not too large, without leading zeros; their number gives the degree.
Result<std::vector<double>> coefficients_of(std::span<const double> given, std::size_t a) {
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto bad = [&](StatusCode code, const std::string& wanted) {
      return Status(code,
                    "coefficient [" + std::to_string(i) + "] of " + name_of(a) + " is " + text(given[i]) +
                        ", it must be " + wanted,
                    static_cast<std::ptrdiff_t>(i));
    };
    if (!std::isfinite(given[i])) return bad(StatusCode::non_finite, "finite");
    if (std::abs(given[i]) > largest_coefficient)
      return bad(StatusCode::invalid_argument, "at most " + text(largest_coefficient) + " in size");
  }
  std::vector<double> coefficients(given.begin(), given.end());
  while (!coefficients.empty() && coefficients.back() == 0) coefficients.pop_back();
  const int degree = static_cast<int>(std::min<std::size_t>(coefficients.size(), 1000)) - 1;
  if (Status status = check_degree(degree, ("the degree of " + name_of(a)).c_str()); !status.ok()) return status;
  return coefficients;
}

double coefficient(const std::vector<double>& c, std::size_t i) { return i < c.size() ? c[i] : 0; }

}  // namespace

Blend Blend::linear() {
  Blend blend;
  blend.first_ = {1, -1};
  blend.second_ = {0, 1};
  blend.count_ = 2;
  return blend;
}

Blend Blend::cubic() {
  Blend blend;
  blend.first_ = {1, 0, -3, 2};
  blend.second_ = {0, 0, 3, -2};
  blend.count_ = 4;
  return blend;
}

Result<Blend> Blend::polynomial(std::span<const double> first, std::span<const double> second) {
  return guarded([&]() -> Result<Blend> {
    auto f1 = coefficients_of(first, 0), f2 = coefficients_of(second, 1);
    if (!f1) return f1.status();
    if (!f2) return f2.status();
    double largest = 1;
    for (const auto* f : {&*f1, &*f2})
      for (const double c : *f) largest = std::max(largest, std::abs(c));
    const double tolerance = polynomial_tolerance * largest;
    for (std::size_t i = 0; i < std::max(f1->size(), f2->size()); ++i) {
      const double error = (coefficient(*f1, i) + coefficient(*f2, i)) - (i == 0 ? 1 : 0);
      const std::string condition =
          i == 0 ? "f1 + f2 = 1" : "f1 + f2 = 1 in the coefficients of t^" + std::to_string(i);
      if (Status status = check_condition(condition.c_str(), error, tolerance); !status.ok()) return status;
    }
    if (Status status = check_ends(polynomial_value(*f1, 0), polynomial_value(*f1, 1), tolerance); !status.ok())
      return status;
    Blend blend;
    blend.count_ = f1->size();
    std::copy(f1->begin(), f1->end(), blend.first_.begin());
    // Corrects the accepted errors of the conditions, so that patches meet their borders exactly.
    blend.first_[0] = 1;
    blend.first_[1] -= polynomial_value(blend.first(), 1);
    for (std::size_t i = 1; i < blend.count_; ++i) blend.second_[i] = -blend.first_[i];
    return blend;
  });
}

Result<Blend> Blend::callable(std::function<double(double)> first, std::function<double(double)> second) {
  return guarded([&]() -> Result<Blend> {
    for (const auto* f : {&first, &second})
      if (!*f)
        return Status(StatusCode::invalid_argument, "blending function " + name_of(f == &first ? 0 : 1) + " is empty");
    double at_zero = 0, at_one = 0;
    for (int k = 0; k < samples; ++k) {
      const double t = static_cast<double>(k) / (samples - 1);
      const auto f1 = value_of(first, 0, t), f2 = value_of(second, 1, t);
      if (!f1) return f1.status();
      if (!f2) return f2.status();
      const std::string condition = "f1 + f2 = 1 at t = " + text(t);
      if (Status status = check_condition(condition.c_str(), (*f1 + *f2) - 1, callable_tolerance); !status.ok())
        return status;
      if (k == 0) at_zero = *f1;
      at_one = *f1;
    }
    if (Status status = check_ends(at_zero, at_one, callable_tolerance); !status.ok()) return status;
    Blend blend;
    blend.callables_ = {std::move(first), std::move(second)};
    return blend;
  });
}

Result<Blend::Jet> Blend::at(double t) const {
  return guarded([&]() -> Result<Jet> {
    Jet jet{};
    for (std::size_t a = 0; a < 2; ++a) {
      const Result<std::array<double, 3>> of_one =
          is_polynomial() ? polynomial_jet(a == 0 ? first() : second(), t) : jet_by_differences(callables_[a], a, t);
      if (!of_one) return of_one.status();
      for (std::size_t k = 0; k < 3; ++k) jet[k][a] = (*of_one)[k];
    }
    if (t == 0) jet[0] = {1, 0};
    if (t == 1) jet[0] = {0, 1};
    return jet;
  });
}

Result<std::array<double, 2>> Blend::values_at(double t) const {
  return guarded([&]() -> Result<std::array<double, 2>> {
    if (t == 0) return std::array<double, 2>{1, 0};
    if (t == 1) return std::array<double, 2>{0, 1};
    if (is_polynomial()) return std::array{polynomial_value(first(), t), polynomial_value(second(), t)};
    const auto f1 = value_of(callables_[0], 0, t), f2 = value_of(callables_[1], 1, t);
    if (!f1) return f1.status();
    if (!f2) return f2.status();
    return std::array{*f1, *f2};
  });
}

}}  // namespace tessera::abi_0_1
