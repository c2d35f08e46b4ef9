#pragma once
// The triangulation of a face, from the vertices and triangles that its patches have in a mesh.

#include <opencascade/Poly_Triangulation.hxx>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tessera/mesh.h"
#include "tessera/model.h"
#include "tessera/occt.h"
#include "tessera/patch_set.h"
#include "tessera/tessellation.h"

namespace tessera { inline namespace abi_0_1 {

/// Makes the triangulations of the faces that a set is made of. A face has one node where vertices have the same
/// position, but two along a seam, where parameters differ by the range of the face. Vertices that no triangle and no
/// edge has are left out, and so are triangles two of whose corners are one position.
///
/// Threads: any number of calls of make() at once, each of a face of its own.
class FaceTriangulations {
 public:
  /// All must outlive this object. `mesh`: of the plan, with normals and patches' parameters. `on_edges`: of the plan;
  /// `shape`, `sources`: of the set.
  FaceTriangulations(const PatchSet& set, const Tessellation& plan, const Mesh& mesh,
                     std::span<const EdgeVertex> on_edges, const Shape& shape, const OcctShape& sources);

  /// Makes the triangulation of a face; null if it has no triangles. May throw Standard_Failure.
  opencascade::handle<Poly_Triangulation> make(std::size_t face);
  /// The largest bound of the face's patches.
  double bound(std::size_t face) const;
  /// The patches of a face.
  std::span<const std::uint32_t> patches(std::size_t face) const {
    return std::span(patches_).subspan(first_patch_[face], first_patch_[face + 1] - first_patch_[face]);
  }
  /// The node of a vertex, from 1, once its face's triangulation is made; 0 if it has none.
  int node(std::uint32_t vertex) const { return static_cast<int>(nodes_[same_[vertex]]); }

 private:
  class Maker;

  const PatchSet& set_;
  const Tessellation& plan_;
  const Mesh& mesh_;
  const Shape& shape_;
  const OcctShape& sources_;
  std::vector<std::uint32_t> first_patch_, patches_;  ///< by face
  std::vector<std::array<std::uint32_t, 2>> poles_;   ///< faces, and a vertex at each of their poles, by faces
  std::vector<std::uint32_t> linked_;                 ///< by vertex: a lesser one at the same parameter of an edge
  std::vector<std::uint32_t> same_;                   ///< by vertex: the vertex that stands for it
  std::vector<std::uint32_t> nodes_;                  ///< by vertex that stands for others: 0, or its node
};

}}  // namespace tessera::abi_0_1
