#include "ray/scene/exact_options.h"

#include <cmath>
#include <string>

#include "base/text.h"

namespace tessera { inline namespace abi_0_1 {

Status check_exact(const RaySceneOptions& options) {
  if (const int pieces = options.pieces; pieces != 1 && pieces != 2 && pieces != 4 && pieces != 8) {
    return Status(
        StatusCode::invalid_argument,
        "a patch of an exact ray scene is cut into 1, 2, 4 or 8 pieces per side, not " + std::to_string(pieces));
  }
  if (options.tolerance && !(*options.tolerance > 0 && std::isfinite(*options.tolerance))) {
    return Status(StatusCode::invalid_argument,
                  "the tolerance of a ray scene must be a finite length above 0, not " + text(*options.tolerance));
  }
  if (options.rebuild_after < 0) {
    return Status(StatusCode::invalid_argument, "the number of refits until a rebuild is " +
                                                    std::to_string(options.rebuild_after) +
                                                    ", it must be at least 1, or 0 for none");
  }
  return {};
}

Result<Box3> frame_box(const RaySceneOptions& options, const Box3& box) {
  if (!options.box) return box;
  if (!options.box->contains(box))
    return Status(StatusCode::invalid_argument, "the box of the ray scene, " + text(*options.box) +
                                                    ", must contain that of the patch set, " + text(box));
  return *options.box;
}

}}  // namespace tessera::abi_0_1
