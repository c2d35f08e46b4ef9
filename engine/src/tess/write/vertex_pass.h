#pragma once
// Writes positions and normals of some patches of a certified mesh and leaves the rest unchanged.

#include "tess/write/patch_writer.h"
#include "tess/write/vertex_job.h"

namespace tessera { inline namespace abi_0_1 {

/// Writes patch after patch, fastest in the order of the mesh, and nothing outside their records. Lives on a task's
/// stack; allocates nothing.
class VertexPass {
 public:
  explicit VertexPass(const PatchWriter& writer) : writer_(writer) {}
  VertexPass(const VertexPass&) = delete;
  VertexPass& operator=(const VertexPass&) = delete;

  void write(std::size_t patch);
  /// Completes the writes; must be called once, at the end.
  void finish();

 private:
  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

  const PatchWriter& writer_;
  std::size_t next_ = nowhere;  ///< the vertex at which writes past the caches stand
  VertexJob vertices_;
};

}}  // namespace tessera::abi_0_1
