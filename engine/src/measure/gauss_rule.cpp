#include "measure/gauss_rule.h"

#include <cmath>
#include <numbers>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Legendre's polynomial of degree n and its derivative at x, by the recurrence of three terms.
struct Legendre {
  long double value, slope;
  Legendre(int n, long double x) {
    long double before = 1;
    value = x;
    for (int k = 2; k <= n; ++k) {
      const long double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
      before = value;
      value = next;
    }
    slope = n * (x * value - before) / (x * x - 1);
  }
};

GaussRule make_rule(int n) {
  GaussRule rule{.count = n};
  for (int k = 0; k < n; ++k) {
    long double x = std::cos(std::numbers::pi_v<long double> * (k + 0.75L) / (n + 0.5L));
    for (int step = 0; step < 8; ++step) {  // Newton's method converges from these starts in 4 steps
      const Legendre p(n, x);
      x -= p.value / p.slope;
    }
    const Legendre p(n, x);
    const auto at = static_cast<std::size_t>(n - 1 - k);
    rule.nodes[at] = static_cast<double>((1 + x) / 2);
    rule.weights[at] = static_cast<double>(1 / ((1 - x * x) * p.slope * p.slope));
  }
  return rule;
}

std::array<GaussRule, max_gauss + 1> make_rules() {
  std::array<GaussRule, max_gauss + 1> rules;
  rules[1] = {.count = 1, .nodes = {0.5}, .weights = {1}};
  for (int n = 2; n <= max_gauss; ++n) rules[static_cast<std::size_t>(n)] = make_rule(n);
  return rules;
}

}  // namespace

const GaussRule& gauss_rule(int count) {
  static const std::array<GaussRule, max_gauss + 1> rules = make_rules();
  return rules[static_cast<std::size_t>(count)];
}

GaussChoice gauss_choice(double bound, double rho, double tolerance) {
  const double factor = 1 / (rho * rho);
  double error = 32.0 / 15.0 * bound * factor / (1 - factor);
  for (int n = 2; n <= max_gauss; ++n) {
    error *= factor;
    if (error <= tolerance) return {n, error};
  }
  return {};
}

}}  // namespace tessera::abi_0_1
