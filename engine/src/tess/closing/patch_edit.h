#pragma once
// Vertices inserted into the boundary of a patch: the triangles there become fans.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/function_ref.h"
#include "tess/closing/edge_segments.h"

namespace tessera { inline namespace abi_0_1 {

/// The vertices and triangles that a whole patch has besides those of its division.
struct PatchEdit {
  using Triangle = CutPatch::Triangle;
  std::uint32_t patch = 0;
  std::vector<ParameterPoint> vertices;                     ///< they follow the patch's own, in its own parameters
  std::vector<std::pair<std::uint32_t, Triangle>> changed;  ///< triangles that replace those of the division
  std::vector<Triangle> added;                              ///< they follow the patch's own
};

/// Inserts vertices into the boundary of a patch's triangles.
///
/// A triangle with a side on the boundary becomes a fan about its opposite corner: as many triangles more as vertices.
/// Bound: on a straight side, the parameters of the fan are those of the triangle.
///
/// - `inserted`: of this patch, those of one segment together and by growing `at`. The k-th becomes vertex first + k.
/// - `pole`: the vertex that stands for a patch's own one: one and the same for all at a pole, as a triangle there has
///   only one of them.
/// - `triangles`: changed in place; new ones are appended.
///
/// Returns the triangles that were changed, without new ones. Vertices in segments that no triangle has as a side
/// belong to none.
std::vector<std::uint32_t> insert_vertices(std::span<const InsertedVertex> inserted, std::uint32_t first,
                                           FunctionRef<std::uint32_t(std::uint32_t)> pole,
                                           std::vector<CutPatch::Triangle>& triangles);

}}  // namespace tessera::abi_0_1
