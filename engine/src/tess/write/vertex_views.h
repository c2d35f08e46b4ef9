#pragma once
// Records of vertices in the views of a mesh.

#include <cstddef>

#include "tessera/mesh.h"

namespace tessera { inline namespace abi_0_1 {

template <class T>
void put_vector(const View3<T>& view, std::size_t at, const Vec3& p) {
  view.at(at, 0) = static_cast<T>(p.x);
  view.at(at, 1) = static_cast<T>(p.y);
  view.at(at, 2) = static_cast<T>(p.z);
}

template <class T>
void copy(const View3<T>& vectors, std::size_t from, std::size_t to) {
  for (int c = 0; c < 3; ++c) vectors.at(to, c) = vectors.at(from, c);
}

/// Copies a vertex's positions, of either precision.
inline void copy_positions(const MeshViews& out, std::size_t from, std::size_t to) {
  if (!out.position.empty()) copy(out.position, from, to);
  if (!out.model_position.empty()) copy(out.model_position, from, to);
}

}}  // namespace tessera::abi_0_1
