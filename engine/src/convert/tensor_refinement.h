#pragma once
// A rectangle cut into cells by breakpoints along u and v, halved where an error is too large.

#include <cstddef>
#include <vector>

#include "base/function_ref.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// The error on one cell, and the parts of it that halving the cell in a direction makes smaller.
struct CellError {
  double total = 0, along_u = 0, along_v = 0;
};
using CellErrorFunction = FunctionRef<Result<CellError>(const Domain& cell)>;

struct RefinementLimits {
  double tolerance = 0;  ///< for messages
  double accepted = 0;   ///< the total error to which cells are halved; the tolerance is enough where limits end it
  double shortest = 0;   ///< a cell's length over its largest parameter is at least this
  std::size_t largest_count = 0;  ///< of cells
};

struct TensorBreaks {
  std::vector<double> u, v;
  double error = 0;  ///< the largest total
};

/// From breakpoints at the start, the ends of the rectangle among them: halves all columns and rows with a cell whose
/// error is above what is accepted: in the direction of the larger part, and in the other too if its part is above a
/// half of that. Asks for the error of each cell that arises once: at most four times as many as there are in the end.
/// Errors: invalid_argument (limits: says what was reached, and where), those of `error`.
Result<TensorBreaks> refine(std::vector<double> u, std::vector<double> v, const RefinementLimits& limits,
                            CellErrorFunction error);

}  // namespace tessera::inline abi_0_1
