#pragma once
// Checks of the options of exact scenes.

#include "tessera/ray_scene.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks what does not depend on the set. Errors: invalid_argument.
Status check_exact(const RaySceneOptions& options);

/// Returns the box that gives size and centre: that of the options, or the set's. Errors: invalid_argument.
Result<Box3> frame_box(const RaySceneOptions& options, const Box3& of_set);

}}  // namespace tessera::abi_0_1
