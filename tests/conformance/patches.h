#pragma once
// Compares a model's patches with its surfaces' own evaluators.

#include <cstddef>

#include "tessera/model.h"

namespace tessera::test {

struct PatchFigures {
  std::size_t patches = 0, points = 0;
  /// Errors of positions, in units of 2^-52 and 2^-23 of the patch's size.
  double double_error = 0, float_error = 0;
};

/// Converts the model, and expects that each patch has its surface's positions at 5 x 5 of its parameters: in double
/// within rounding and the stated fit error, by the float kernels also within their own rounding.
PatchFigures expect_patches_follow_surfaces(const Model& model);

}  // namespace tessera::test
