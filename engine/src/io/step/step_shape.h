#pragma once
// One part of a STEP file as a shape.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/step/step_geometry.h"
#include "io/step/step_styles.h"
#include "tessera/execution.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A part: items of representations that stand together.
struct StepShapeInput {
  std::span<const std::uint64_t> items;
  StepUnits units;
  double uncertainty = 0;  ///< of lengths, in the model's unit; 0: none is stated
  std::string name;
  bool is_mirrored = false;              ///< whether the shape is to be turned inside out
  std::uint64_t representation = 0;      ///< whose colour is that of items without one
  const StepColours* colours = nullptr;  ///< of items; may be null
};

/// Faces that a shape lacks, or has otherwise than the file.
struct StepShapeFaults {
  std::vector<std::string> left_out;                ///< faces, one sentence each
  std::vector<std::string> changed;                 ///< faces that differ from the file, one sentence each
  std::size_t fitted = 0;                           ///< surfaces that had to be fitted
  double worst_fit = 0;                             ///< their largest distance
  StatusCode first_code = StatusCode::parse_error;  ///< of the first face that is left out
};

/// Reads a part. Faces that cannot be read are left out, with a sentence in `faults`.
///
/// Errors: unsupported (a part that is far larger than its file, since faces share loops or surfaces), cancelled,
/// out_of_memory.
Result<Shape> step_shape(const StepIndex& index, const StepShapeInput& input, StepShapeFaults& faults,
                         const Execution& execution);

}}  // namespace tessera::abi_0_1
