#pragma once
// A face's rectangle of parameters, and its loops in it.

#include <opencascade/TopoDS_Face.hxx>
#include <vector>

#include "io_occt/face_surface.h"
#include "tessera/geometry.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// OpenCASCADE's parameters that a face uses, and what its tolerance is in them.
struct FaceBox {
  Domain domain;
  double tolerance_u = 0, tolerance_v = 0;
};
/// Moved to the surface's own knots and ends where they are within the tolerance. Errors: unsupported (unbounded, or
/// no extent). May throw Standard_Failure.
Result<FaceBox> face_box(const TopoDS_Face& face);

/// The face's loops in our parameters; none where its edges run along the sides of the box, all of them once. Errors:
/// unsupported (an edge without a curve in the parameters), those of trim_curve. May throw Standard_Failure.
Result<std::vector<TrimLoop>> face_loops(const TopoDS_Face& face, const FaceBox& box,
                                         const Reparametrization& parameters);

}  // namespace tessera::inline abi_0_1
