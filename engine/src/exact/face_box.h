#pragma once
// The rectangle of parameters that a face of a CAD file uses.

#include <vector>

#include "tessera/geometry.h"
#include "tessera/trim_loop.h"

namespace tessera { inline namespace abi_0_1 {

/// The part of a surface's parameters that a face uses, and its tolerance in them.
struct FaceBox {
  Domain domain;
  double tolerance_u = 0, tolerance_v = 0;
  bool ends_u = false, ends_v = false;  ///< a side across u, or v, of the box is one of the surface
};

/// One direction of the box, while it is found.
struct FreeRange {
  double from = 0, to = 0;         ///< of the face
  double first = 0, last = 0;      ///< of the surface; infinite where it has no end
  double period = 0;               ///< 0: not periodic
  double length_tolerance = 0;     ///< of the face, in units of the parameter
  std::vector<double> knots = {};  ///< of the surface, if any

  double tolerance() const;
  bool ends_with_surface() const { return period == 0 && (from == first || to == last); }
  /// Moves the ends to knots and ends of the surface that are within the tolerance, and into the surface. A range of
  /// nearly a period becomes one.
  void settle();
};

/// Tells whether one loop goes around the box along its sides, so that nothing is trimmed.
bool is_whole_box(const std::vector<TrimLoop>& loops, const FaceBox& box);

}}  // namespace tessera::abi_0_1
