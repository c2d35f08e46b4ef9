#pragma once
// Checks of numbers for every kind of surface and curve, with messages that name the offending element.

#include <span>
#include <string>

#include "base/function_ref.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns how messages name element k of a list: "[i][j]".
using Place = FunctionRef<std::string(std::size_t k)>;
/// Returns "[k / row][k % row]".
std::string place_in_rows(std::size_t k, std::size_t row);

/// Checks that the degree is 1 to max_degree. `name` is "degree u" or the like. Errors: unsupported_degree.
Status check_degree(int degree, const char* name);
/// Checks that all points are finite. Errors: non_finite (index = the point).
Status check_points(std::span<const Vec3> points, Place place);
/// Checks that weights are finite, above 0, and at least 1e-100 of the largest. Errors: invalid_weight (index = the
/// weight).
Status check_weights(std::span<const double> weights, Place place);
/// Returns whether all weights are equal by ==, so that the surface is polynomial.
bool all_equal(std::span<const double> weights);

}}  // namespace tessera::abi_0_1
