#pragma once
// Splits polygons of files into fans of triangles.

#include "tessera/mesh.h"

namespace tessera { inline namespace abi_0_1 {

/// Makes a quad of the last two triangles, a fan of four corners.
inline void join_last_quad(Mesh& mesh) {
  const auto fan = mesh.indices.end() - 6;  // a b c a c d
  mesh.quads.insert(mesh.quads.end(), {fan[0], fan[1], fan[2], fan[5]});
  mesh.indices.erase(fan, mesh.indices.end());
}

}}  // namespace tessera::abi_0_1
