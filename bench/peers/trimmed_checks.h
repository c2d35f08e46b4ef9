#pragma once
// Meshes and regions of trimmed faces against OpenCASCADE's areas and sides.

#include <cstddef>
#include <span>

#include "peers/mesh_distance.h"
#include "peers/trimmed_case.h"

namespace tessera::bench {

/// The areas of faces in a mesh against those of BRepGProp.
struct AreaCheck {
  double worst = 0;      ///< the largest relative difference
  std::size_t face = 0;  ///< where it is
  double expected = 0;   ///< the largest difference over bound x perimeter + 1e-3 of the area: at most 1 is expected
  std::size_t expected_face = 0;
};
AreaCheck check_areas(const TrimmedCase& one, std::span<const SurfaceTriangle> mesh, double bound);

/// TrimRegion::locate() against BRepTopAdaptor_FClass2d.
struct SideCheck {
  std::size_t points = 0, borders = 0;  ///< asked, and answered by `border`
  std::size_t near = 0;                 ///< answers that differ within 1e-6 of the box from the border
  std::size_t apart = 0;                ///< answers that differ elsewhere
  double farthest = 0;                  ///< the largest distance from the border of these, as a share of the box
};
/// Prints a line for each face with answers that differ apart from the border.
SideCheck check_sides(const TrimmedCase& one, std::size_t points_per_face);

}  // namespace tessera::bench
