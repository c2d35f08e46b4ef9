#pragma once
// The rectangle of parameters that the loops of a face need.

#include <span>
#include <vector>

#include "exact/face_box.h"
#include "io/step/step_trace.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Finds the rectangle, and moves loops by whole periods so that they lie in it, as far as possible: the trim takes
/// what crosses its sides on a surface that closes.
///
/// - `vertices`: places of vertex loops.
/// - `agrees`: whether loops keep the face on their left.
/// - `tolerance`: a length.
///
/// Errors: unsupported (no bounds, no extent).
Result<FaceBox> step_face_box(const SurfaceInverse& inverse, std::span<const BrepEdge> edges,
                              std::vector<LoopTrace>& loops, std::span<const ParameterPoint> vertices, bool agrees,
                              double tolerance);

/// Tells whether loops keep what is outside of them, on a surface without sides, such as a ball with a hole.
bool keep_outside(const SurfaceInverse& inverse, std::span<const LoopTrace> loops, bool agrees);

}}  // namespace tessera::abi_0_1
