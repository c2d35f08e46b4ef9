#include "tess/write/vertex_pass.h"

namespace tessera { inline namespace abi_0_1 {

void VertexPass::write(std::size_t patch) {
  if (writer_.plan_.division(patch).empty) return;
  if (writer_.plan_.shares_vertices()) return writer_.write_owned(patch, vertices_);
  const std::size_t first = writer_.plan_.first_vertex(patch), end = writer_.plan_.first_vertex(patch + 1);
  if (writer_.streaming_ && first != next_) {
    vertices_.finish_lines(writer_.kernels_);
    vertices_.start_lines(writer_.out_, first);
  }
  next_ = end;
  writer_.write_vertices(patch, end, vertices_);
}

void VertexPass::finish() {
  if (!writer_.streaming_) return;
  vertices_.finish_lines(writer_.kernels_);
  writer_.kernels_.finish_streaming();
}

}}  // namespace tessera::abi_0_1
