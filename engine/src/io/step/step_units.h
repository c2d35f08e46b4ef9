#pragma once
// The units of a STEP file (ISO 10303-41), as a representation's context states them:
//
//   #9=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#8))
//       GLOBAL_UNIT_ASSIGNED_CONTEXT((#5,#6,#7))REPRESENTATION_CONTEXT('',''));

#include <cstdint>
#include <string>

#include "io/step/step_geometry.h"
#include "io/step/step_index.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The units of a context. A length or an angle that has none is in millimetres or in radians.
struct StepContextUnits {
  StepUnits units;         ///< lengths in millimetres
  double uncertainty = 0;  ///< of lengths, in millimetres; 0: none is stated
  std::string length;      ///< the file's word for its unit of length: "millimetre", "INCH"; empty: none is stated
};

/// Reads the units of a context. Of several units of one kind the first counts. An uncertainty that is not above 0, or
/// that cannot be read, counts as none.
///
/// Errors name the instance and its line: parse_error (no such instance; a unit of length or angle that is missing, not
/// above 0, malformed, or made of more than 8 others, such as a cycle), non_finite (a unit beyond the range of double).
/// Threads: any number of calls at once.
Result<StepContextUnits> step_units(const StepIndex& index, std::uint64_t context);

}}  // namespace tessera::abi_0_1
