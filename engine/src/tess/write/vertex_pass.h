#pragma once
// Positions and normals of some patches of a certified mesh, the rest of which stays as it is.

#include "tess/write/patch_writer.h"
#include "tess/write/vertex_job.h"

namespace tessera::inline abi_0_1 {

/// Takes patch after patch: fastest in the order of the mesh. Writes nothing outside their records. Lives on a task's
/// stack; allocates nothing.
class VertexPass {
 public:
  explicit VertexPass(const PatchWriter& writer) : writer_(writer) {}
  VertexPass(const VertexPass&) = delete;
  VertexPass& operator=(const VertexPass&) = delete;

  void write(std::size_t patch);
  /// What is still on its way. Once, at the end.
  void finish();

 private:
  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

  const PatchWriter& writer_;
  std::size_t next_ = nowhere;  ///< the vertex at which the lines stand
  VertexJob vertices_;
};

}  // namespace tessera::inline abi_0_1
