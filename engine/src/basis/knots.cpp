#include "basis/knots.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/text.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::string knot_text(std::span<const double> knots, std::string_view name, std::size_t k) {
  return std::string(name) + "[" + std::to_string(k) + "] = " + text(knots[k]);
}

Status check_order(std::span<const double> knots, std::string_view name) {
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const auto index = static_cast<std::ptrdiff_t>(k);
    if (!std::isfinite(knots[k]))
      return {StatusCode::non_finite, knot_text(knots, name, k) + ", it must be finite", index};
    if (k > 0 && knots[k] < knots[k - 1])
      return {StatusCode::invalid_argument,
              knot_text(knots, name, k) + " is below the knot before it, " + text(knots[k - 1]), index};
  }
  if (!std::isfinite(knots.back() - knots.front()))
    return {StatusCode::non_finite,
            "the range of " + std::string(name) + " is too large: last minus first is not finite"};
  return {};
}

Status check_multiplicity(int degree, std::span<const double> knots, std::string_view name) {
  const std::size_t p = static_cast<std::size_t>(degree);
  const double start = knots[p], end = knots[knots.size() - p - 1];
  for (std::size_t k = 0; k < knots.size();) {
    std::size_t count = 1;
    while (k + count < knots.size() && knots[k + count] == knots[k]) ++count;
    const bool inner = knots[k] > start && knots[k] < end;
    if (count > p + (inner ? 0 : 1))
      return {StatusCode::invalid_argument,
              knot_text(knots, name, k) + " has multiplicity " + std::to_string(count) + ", at degree " +
                  std::to_string(degree) + (inner ? " an inner knot" : " a knot") + " has at most " +
                  std::to_string(p + (inner ? 0 : 1)),
              static_cast<std::ptrdiff_t>(k)};
    k += count;
  }
  return {};
}

}  // namespace

Status check_knots(int degree, std::span<const double> knots, std::string_view name) {
  const std::size_t p = static_cast<std::size_t>(degree);
  if (knots.size() < 2 * (p + 1))
    return {StatusCode::count_mismatch, "degree " + std::to_string(degree) + " needs at least " +
                                            std::to_string(2 * (p + 1)) + " " + std::string(name) + ", found " +
                                            std::to_string(knots.size())};
  if (Status status = check_order(knots, name); !status.ok()) return status;
  const std::size_t last = knots.size() - p - 1;
  if (!(knots[p] < knots[last]))
    return {StatusCode::invalid_argument,
            "the domain is empty: it runs from " + knot_text(knots, name, p) + " to " + knot_text(knots, name, last),
            static_cast<std::ptrdiff_t>(p)};
  return check_multiplicity(degree, knots, name);
}

Status check_range(int degree, std::span<const double> knots, double from, double to, std::string_view name) {
  const double first = knots[static_cast<std::size_t>(degree)],
               last = knots[knots.size() - static_cast<std::size_t>(degree) - 1];
  if (first <= from && from < to && to <= last) return {};
  const std::string range = std::string(name) + " [" + text(from) + ", " + text(to) + "]";
  if (!std::isfinite(from) || !std::isfinite(to)) return {StatusCode::non_finite, range + " must be finite"};
  if (!(from < to)) return {StatusCode::invalid_argument, range + " is empty"};
  return {StatusCode::invalid_argument,
          range + " exceeds that of the knots, [" + text(first) + ", " + text(last) + "]"};
}

std::size_t multiplicity(std::span<const double> knots, double t) {
  const auto [first, last] = std::equal_range(knots.begin(), knots.end(), t);
  return static_cast<std::size_t>(last - first);
}

std::size_t find_span(const KnotLine& line, double t) {
  const auto after = [&](double x) {
    return static_cast<std::size_t>(std::upper_bound(line.knots.begin(), line.knots.end(), x) - line.knots.begin());
  };
  if (t < line.to) return after(std::max(t, line.from)) - 1;
  return static_cast<std::size_t>(std::lower_bound(line.knots.begin(), line.knots.end(), line.to) -
                                  line.knots.begin()) -
         1;
}

std::vector<std::size_t> distinct_spans(const KnotLine& line) {
  std::vector<std::size_t> spans;
  for (std::size_t k = find_span(line, line.from), last = find_span(line, line.to); k <= last; ++k)
    if (line.knots[k] < line.knots[k + 1]) spans.push_back(k);
  return spans;
}

template <class Real>
void blossom_weights(int degree, std::span<const double> knots, std::size_t span, const Real* arguments,
                     Real* weights) {
  assert(knots[span] < knots[span + 1]);
  weights[0] = 1;
  for (std::size_t r = 1; r <= static_cast<std::size_t>(degree); ++r) {
    const Real t = arguments[r - 1];
    Real carried = 0;
    for (std::size_t j = 0; j < r; ++j) {
      const Real left = knots[span + 1 + j - r], right = knots[span + 1 + j];
      const Real value = weights[j];
      weights[j] = carried + (right - t) / (right - left) * value;  // the ratios are exactly 0 and 1 at the ends
      carried = (t - left) / (right - left) * value;
    }
    weights[r] = carried;
  }
}

template void blossom_weights(int, std::span<const double>, std::size_t, const double*, double*);
template void blossom_weights(int, std::span<const double>, std::size_t, const long double*, long double*);

}}  // namespace tessera::abi_0_1
