#pragma once
// Elementary surfaces of files: parts of quadrics, and of surfaces of revolution about the z axis.

#include <numbers>

#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/quadric.h"
#include "tessera/status.h"
#include "tessera/surface.h"

namespace tessera { inline namespace abi_0_1 {

inline constexpr double pi = std::numbers::pi;
/// Files print angles with 15 digits or fewer: within this, an angle is taken as a full turn, or as that of a pole.
inline constexpr double printed = 1e-9;

/// A part of a quadric in the canonical frame, by its canonical parameters. Errors: invalid_argument (another kind than
/// `kind`, an empty range).
Result<Surface> quadric_part(QuadricKind kind, const QuadricCoefficients& coefficients, const Domain& range);

/// Revolves a profile about the z axis by `turn` radians, above 0 and at most a full turn. u begins at 0 and runs along
/// the arcs of a circle over [0,1]; v is the profile's parameter. Errors: invalid_argument.
Result<Surface> revolved_part(const Curve& profile, double turn);

/// A torus about the z axis. `range` holds the angles of the turn (u) and of the tube (v), in radians; u and v of the
/// surface begin at 0, on rational arcs. Errors: invalid_argument (a range that is empty or above a full turn).
Result<Surface> torus_part(double major, double minor, const Domain& range);

/// Tells whether `turn` radians are above 0 and at most a full turn, up to the rounding of angles in files.
bool is_turn(double turn);

}}  // namespace tessera::abi_0_1
