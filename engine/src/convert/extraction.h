#pragma once
// How the Bezier points of all spans of a spline direction come from its control points: the extraction operators of
// Borden, Scott, Evans, Hughes 2011 (Isogeometric finite element data structures based on Bezier extraction), by
// blossoms.

#include <cstddef>
#include <vector>

#include "basis/knots.h"

namespace tessera::inline abi_0_1 {

/// Row r of the operator, r = span * degree + i, gives Bezier point i of that span; the last of a span is the first of
/// the next, one row. Each weight is >= 0 and right to half a unit in the last place.
struct Extraction {
  struct Row {
    std::size_t first = 0;    ///< the first control point that acts
    std::size_t count = 0;    ///< how many do; 1: the Bezier point is that control point, with weight 1
    std::size_t weights = 0;  ///< where its weights begin
  };
  std::vector<double> breaks;  ///< of the spans: one more than these
  std::vector<Row> rows;
  std::vector<double> weights;

  std::size_t span_count() const { return breaks.size() - 1; }
  const double* weights_of(const Row& row) const { return &weights[row.weights]; }
};

Extraction make_extraction(const KnotLine& line);

}  // namespace tessera::inline abi_0_1
