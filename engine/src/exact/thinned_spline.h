#pragma once
// Splines of many short spans, written with fewer.

#include <optional>

#include "exact/straight_lines.h"

namespace tessera { inline namespace abi_0_1 {

/// How far a surface is from another one, at equal parameters.
struct SplineShift {
  double distance = 0;  ///< of points
  double angle = 0;     ///< of normals, radians
};

/// Removes knots along one direction of a strip, which has at least 32 spans along it and at most 8 control points
/// across, so that the surface moves by at most `most`, both proven: a mesh has two triangles or more for each span,
/// and files write strips of smooth wings with hundreds. Halves the number of spans as long as the limits are kept.
/// Returns how far the surface has moved; nothing if it is unchanged.
///
/// The new control points are those whose net, with the old knots inserted, has the least sum of squared distances from
/// the old one. The surfaces differ by at most the largest of these distances, because B-splines add up to 1. Normals
/// follow from the same bound on derivatives. Rational surfaces stay as they are.
std::optional<SplineShift> thin(StraightenedNet& net, const SplineShift& most);

}}  // namespace tessera::abi_0_1
