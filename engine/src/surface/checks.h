#pragma once
// What the kinds of surfaces over geometry matrices and knots ask of their numbers, with messages that name the
// offending one.

#include <span>
#include <string>

#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Finite vectors in rows of `columns`; `what` names one ("geometry element"). Errors: non_finite (index = the vector).
Status check_vectors(std::span<const Vec3> vectors, std::size_t columns, const std::string& what);
/// At least two, finite, each above the one before it by a finite length; `what` and `direction` name one: "knot u[3] =
/// 2".
/// Errors: invalid_argument, non_finite (index = the value).
Status check_increasing(std::span<const double> values, const std::string& what, const std::string& direction);
/// Finite, from < to, with a length and its reciprocal that are finite too; `name` is "the domain along u" or the like.
/// Errors: invalid_argument, non_finite.
Status check_interval(double from, double to, const std::string& name);
/// Finite, u0 < u1 and v0 < v1, with lengths and their reciprocals that are finite too. Errors: invalid_argument,
/// non_finite.
Status check_domain(const Domain& domain);

/// " at (u, v) = (0, 1)".
std::string text_at(double u, double v);
/// What a surface gave at (u, v). Errors: non_finite (names the vector and (u, v)).
Status check_finite(const Vec3& position, double u, double v);
Status check_finite(const SurfaceJet& jet, double u, double v);

}  // namespace tessera::inline abi_0_1
