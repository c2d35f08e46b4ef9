#pragma once
// Points of faces along the curves of their loops.

#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A face's point on a curve of its loops, and the derivative by the curve's parameter.
struct FacePoint {
  Vec3 position, first;
};
/// Evaluates at the curve's parameter t. Curves may cross the seam of a closed surface, where the domain ends. Errors:
/// those of evaluate_jet().
Result<FacePoint> face_point(const ModelSurface& face, const Curve& curve, double t);

}}  // namespace tessera::abi_0_1
