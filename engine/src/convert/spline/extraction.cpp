#include "convert/spline/extraction.h"

#include <algorithm>
#include <array>

#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using Blossom = std::array<long double, max_degree + 1>;

/// Appends the blossom f(a, .., a, b, .., b), with b i times: Bezier point i of [a, b] within the span (Farin, Curves
/// and Surfaces for CAGD, 5th ed., sec. 8.6). Every step is convex there.
void append_row(Extraction& extraction, const KnotLine& line, std::size_t span, double a, double b, std::size_t i) {
  const std::size_t p = static_cast<std::size_t>(line.degree);
  Blossom arguments{}, weights;
  std::fill_n(arguments.begin(), p - i, a);
  std::fill_n(arguments.begin() + static_cast<std::ptrdiff_t>(p - i), i, b);
  blossom_weights(line.degree, line.knots, span, arguments.data(), weights.data());
  std::size_t first = 0, last = p;
  while (first < last && weights[first] == 0) ++first;
  while (last > first && weights[last] == 0) --last;
  extraction.rows.push_back({span - p + first, last - first + 1, extraction.weights.size()});
  for (std::size_t k = first; k <= last; ++k) extraction.weights.push_back(static_cast<double>(weights[k]));
}

}  // namespace

Extraction make_extraction(const KnotLine& line) {
  const std::size_t p = static_cast<std::size_t>(line.degree);
  const std::vector<std::size_t> spans = distinct_spans(line);
  Extraction extraction;
  extraction.rows.reserve(spans.size() * p + 1);
  extraction.weights.reserve((spans.size() * p + 1) * (p + 1));
  extraction.breaks.reserve(spans.size() + 1);
  extraction.breaks.push_back(line.from);
  for (const std::size_t span : spans) {
    const double a = extraction.breaks.back(), b = std::min(line.knots[span + 1], line.to);
    for (std::size_t i = extraction.rows.empty() ? 0 : 1; i <= p; ++i) append_row(extraction, line, span, a, b, i);
    extraction.breaks.push_back(b);
  }
  return extraction;
}

}}  // namespace tessera::abi_0_1
