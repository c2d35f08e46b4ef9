#pragma once
// Extractions that curves of equal knots share.

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "convert/spline/extraction.h"
#include "surface/spline/spline_lines.h"
#include "tessera/curve.h"

namespace tessera { inline namespace abi_0_1 {

/// Keeps the extractions of the last few knot vectors: the curves of a file often have equal ones.
class CurveExtractions {
 public:
  /// Returns the extraction of a curve's knots and domain, to stay until the next call.
  const Extraction& of(const Curve& curve) {
    const auto is_same = [&](const Known& known) {
      return known.first.degree() == curve.degree() && known.first.domain() == curve.domain() &&
             std::ranges::equal(known.first.knots(), curve.knots());
    };
    if (const auto found = std::ranges::find_if(known_, is_same); found != known_.end()) return found->second;
    if (known_.size() == max_known) known_.clear();
    return known_.emplace_back(curve, make_extraction(line_of(curve))).second;
  }

 private:
  using Known = std::pair<Curve, Extraction>;
  static constexpr std::size_t max_known = 32;  // a search takes a few percent of an extraction
  std::vector<Known> known_;
};

}}  // namespace tessera::abi_0_1
