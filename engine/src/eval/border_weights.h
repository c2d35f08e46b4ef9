#pragma once
// Weights of border curves, whose bits do not depend on the direction in which the curve runs.

#include "base/aligned.h"

namespace tessera { inline namespace abi_0_1 {

/// Bernstein weights at k / rate, `[k][i]`: B_i = C(n,i) (t^i s^(n-i)) with t = k / rate and s = (rate - k) / rate, so
/// that B_i at k is B_{n-i} at rate - k, bit for bit.
AlignedVector<float> symmetric_weights(int degree, int rate);

}}  // namespace tessera::abi_0_1
