#pragma once
// Reads the quadrics of a RIB file: Sphere, Cone, Cylinder, Hyperboloid, Paraboloid, Disk and Torus.

#include "io/rib/rib_surfaces.h"
#include "tessera/geometry.h"
#include "tessera/surface.h"

namespace tessera { inline namespace abi_0_1 {

/// A surface, and the map from its coordinates to those of the request.
struct RibQuadric {
  Surface surface;
  Affine placement = {};
};

/// Reads the numbers of the quadric that `text.request` names. Its u and v run as the Interface's do, u with the angle,
/// so its normal points to the same side; they do not have the same pace. Errors: parse_error, with the line (a missing
/// number, an angle beyond a full turn, a size of 0).
Result<RibQuadric> read_quadric(const RibSurfaceText& text);

}}  // namespace tessera::abi_0_1
