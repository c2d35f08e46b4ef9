#pragma once
// Checks of numbers for surfaces over geometry matrices and knots, with messages that name the offending one.

#include <span>
#include <string>

#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks that vectors in rows of `columns` are finite; `what` names one ("geometry element"). Errors: non_finite
/// (index = the vector).
Status check_vectors(std::span<const Vec3> vectors, std::size_t columns, const std::string& what);
/// Checks that there are at least two values, finite, each above the one before it by a finite length. `what` and
/// `direction` name one: "knot u[3] = 2". Errors: invalid_argument, non_finite (index = the value).
Status check_increasing(std::span<const double> values, const std::string& what, const std::string& direction);
/// Checks that both are finite, from < to, and that the length and its reciprocal are finite. `name` is "the domain
/// along u" or the like. Errors: invalid_argument, non_finite.
Status check_interval(double from, double to, const std::string& name);
/// Checks that the domain is finite, u0 < u1, v0 < v1, and that both lengths and their reciprocals are finite. Errors:
/// invalid_argument, non_finite.
Status check_domain(const Domain& domain);

/// Returns " at (u, v) = (0, 1)".
std::string text_at(double u, double v);
/// Checks that the surface's values at (u, v) are finite. Errors: non_finite (names the vector and (u, v)).
Status check_finite(const Vec3& position, double u, double v);
Status check_finite(const SurfaceJet& jet, double u, double v);

}}  // namespace tessera::abi_0_1
