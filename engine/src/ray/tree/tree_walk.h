#pragma once
// The walks of lines through the library's own trees.

#include <cstddef>

#include "base/function_ref.h"
#include "kernel/ray/ray_kernels.h"
#include "ray/line/ray_line.h"
#include "ray/tree/box_nodes.h"

namespace tessera { inline namespace abi_0_1 {

/// Begins the walk of a line, which must not be empty, through a tree.
void start_walk(const RayLine& line, const BoxNodes& tree, kernel::TreeWalk& walk);
/// Begins the walk of 1 to TreePacket::size lines; line(k) is line k of `count`.
void start_walk(std::size_t count, FunctionRef<const RayLine&(std::size_t)> line, const BoxNodes& tree,
                kernel::TreePacket& packet);

/// Returns the far end of a walk up to `s`, padded as boxes are.
float far_of_walk(double s);

}}  // namespace tessera::abi_0_1
