#pragma once
// A rectangle cut into cells by breakpoints along u and v, and halved where the error is too large.

#include <cstddef>
#include <vector>

#include "base/function_ref.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The error on one cell, and the part of it that halving the cell in each direction reduces.
struct CellError {
  double total = 0, along_u = 0, along_v = 0;
};
using CellErrorFunction = FunctionRef<Result<CellError>(const Domain& cell)>;

struct RefinementLimits {
  double tolerance = 0;           ///< accepted if a limit stops the refinement; named in messages
  double accepted = 0;            ///< cells are halved until their total error is at most this
  double shortest = 0;            ///< lower bound of a cell's length over its largest parameter
  std::size_t largest_count = 0;  ///< limit on the number of cells
};

struct TensorBreaks {
  std::vector<double> u, v;
  double error = 0;  ///< the largest total
};

/// Refines the rectangle from start breakpoints, which include its ends. A column or row is halved if it has a cell
/// whose error is above `accepted`: in the direction of the larger part, and in the other too if its part is above half
/// of `accepted`. Calls `error` once for each cell that arises: at most four times the number of final cells. Errors:
/// invalid_argument (a limit: says which one and where), those of `error`.
Result<TensorBreaks> refine(std::vector<double> u, std::vector<double> v, const RefinementLimits& limits,
                            CellErrorFunction error);

}}  // namespace tessera::abi_0_1
