#pragma once
// The parameter rectangle of a face, and its loops in it.

#include <vector>

#include "exact/face_box.h"
#include "occt/face_border.h"
#include "occt/face_surface.h"
#include "occt/shape_edges.h"
#include "tessera/geometry.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The box of a face. Moves its ends to knots and ends of the surface that are within the tolerance. Errors:
/// unsupported (unbounded, or no extent). May throw Standard_Failure.
Result<FaceBox> face_box(const FaceBorder& border);

/// The loops of a face.
struct FaceLoops {
  std::vector<TrimLoop> loops;
  bool whole = false;     ///< one loop runs along all sides of the box, and trims nothing
  bool unshared = false;  ///< a loop names no edges, because a curve of it does not run along its edge
};
/// The loops of the face in our parameters, with coedges of `edges`. Errors: unsupported (an edge without a curve in
/// the parameters), those of trim_curve. May throw Standard_Failure.
Result<FaceLoops> face_loops(const FaceBorder& border, const FaceBox& box, const Reparametrization& parameters,
                             const ShapeEdges& edges);

}}  // namespace tessera::abi_0_1
