#pragma once
// Extraction operators of a spline direction: how the Bezier points of all its spans come from its control points
// (Borden, Scott, Evans, Hughes, Isogeometric finite element data structures based on Bezier extraction, 2011), by
// blossoms.

#include <cstddef>
#include <vector>

#include "basis/knots.h"

namespace tessera { inline namespace abi_0_1 {

/// The operator of one direction. Row r = span * degree + i gives Bezier point i of that span. The last point of a span
/// is the first of the next, so they share a row. Each weight is >= 0 and right to half a unit in the last place.
struct Extraction {
  struct Row {
    std::size_t first = 0;    ///< index of the first control point that acts
    std::size_t count = 0;    ///< number of control points that act; 1: the Bezier point is that control point, with
                              ///< weight 1
    std::size_t weights = 0;  ///< index of its first weight
  };
  std::vector<double> breaks;  ///< parameters between the spans: one more than spans
  std::vector<Row> rows;
  std::vector<double> weights;

  std::size_t span_count() const { return breaks.size() - 1; }
  const double* weights_of(const Row& row) const { return &weights[row.weights]; }
};

Extraction make_extraction(const KnotLine& line);

}}  // namespace tessera::abi_0_1
