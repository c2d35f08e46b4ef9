#pragma once
// Points, directions and placements of a STEP file (ISO 10303-42).

#include <cstdint>
#include <vector>

#include "exact/swept_surface.h"
#include "io/step/step_entity.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The units and the dimension of a file's geometry.
struct StepUnits {
  double length = 1;  ///< the model's units in one of the file's; > 0
  double angle = 1;   ///< radians in one of the file's; > 0
  int dimension = 3;  ///< 2: curves in a surface's parameters, with z = 0
};

/// Converts points of a file. Threads: any number of calls at once.
///
/// Errors of all calls, here and in the classes above this one, name the instance and its line: parse_error (an
/// attribute that is missing, or of the wrong type, count or value; a reference to nothing or to the wrong kind; a
/// chain of more than 32 instances, such as a cycle), non_finite (a number too large).
class StepPoints {
 public:
  /// The index must outlive the object.
  explicit StepPoints(const StepIndex& index, const StepUnits& units = {}) : index_(index), units_(units) {}

  Result<Vec3> point(std::uint64_t number) const;
  Result<Vec3> direction(std::uint64_t number) const;  ///< of unit length
  /// Returns the axes of AXIS2_PLACEMENT_3D, AXIS2_PLACEMENT_2D and AXIS1_PLACEMENT. Where the file has no direction,
  /// or two that are parallel, the axes are those of ISO 10303-42, 4.4.
  Result<Frame> placement(std::uint64_t number) const;

 protected:
  static constexpr int max_depth = 32;  ///< of curves and surfaces that are made of others

  Result<std::vector<Vec3>> points(StepEntity& owner, std::size_t list) const;
  Result<Vec3> direction_or(StepEntity& owner, std::size_t at, const Vec3& otherwise) const;
  Result<Vec3> vector(std::uint64_t number) const;

  const StepIndex& index_;
  StepUnits units_;
};

}}  // namespace tessera::abi_0_1
