#pragma once
// Maps from one representation of a STEP file to another (ISO 10303-42, 10303-43).

#include <cstdint>

#include "io/step/step_geometry.h"
#include "io/step/step_index.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A placement or an operator, and the units of the representation that it is in.
struct StepPlace {
  std::uint64_t number = 0;
  StepUnits units;
};

/// Returns the map from the coordinates of a place to its representation: of AXIS2_PLACEMENT_3D, rigid, or of
/// CARTESIAN_TRANSFORMATION_OPERATOR_3D, which may scale and mirror. Lengths are in millimetres on both sides.
///
/// Errors name the instance and its line: parse_error (it is missing, malformed, of another kind, or its scale is not
/// above 0), non_finite (coordinates beyond the range of double). Threads: any number of calls at once.
Result<Affine> step_place(const StepIndex& index, const StepPlace& place);
/// Returns the map of space that takes `from` to `to`. Errors: those of step_place().
Result<Affine> step_move(const StepIndex& index, const StepPlace& from, const StepPlace& to);
/// Returns the inverse of a map that step_place() or step_move() has made.
Affine inverse_place(const Affine& map);

}}  // namespace tessera::abi_0_1
