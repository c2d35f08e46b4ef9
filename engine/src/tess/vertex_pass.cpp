#include "tess/vertex_pass.h"

namespace tessera {

void VertexPass::write(std::size_t patch) {
  if (writer_.plan_.division(patch).empty) return;
  if (writer_.plan_.shares_vertices()) return writer_.write_owned(patch, vertices_);
  const std::size_t first = writer_.plan_.first_vertex(patch), end = writer_.plan_.first_vertex(patch + 1);
  if (!writer_.streaming_) return writer_.write_vertices(patch, end, vertices_);
  writer_.prepare(patch, vertices_);
  write_streaming(first, end - first);
}

void VertexPass::write_streaming(std::size_t first, std::size_t count) {
  const MeshViews& out = writer_.out_;
  const bool with_normals = !out.normal.empty();
  if (first != next_) {
    stop();
    streams_.positions.start(out.position.component[0] + 3 * first);
    if (with_normals) streams_.normals.start(out.normal.component[0] + 3 * first);
  }
  next_ = first + count;
  float* const position = streams_.positions.next(3 * count);
  float* const normal = with_normals ? streams_.normals.next(3 * count) : nullptr;
  const bool staged = position && (normal || !with_normals);
  set_packed(vertices_.job.position, position ? position : streams_.positions.out());
  set_packed(vertices_.job.normal, !with_normals ? nullptr : normal ? normal : streams_.normals.out());
  vertices_.job.writable = static_cast<int>(count + (staged ? LineStream<float>::slack / 3 : 0));
  streams_.share(vertices_.job, count);
  writer_.kernels_.mesh_vertices(vertices_.job);
  position ? streams_.positions.commit(3 * count) : streams_.positions.skip(3 * count);
  if (with_normals) normal ? streams_.normals.commit(3 * count) : streams_.normals.skip(3 * count);
}

void VertexPass::stop() {
  if (next_ == nowhere) return;
  streams_.positions.finish();
  if (!writer_.out_.normal.empty()) streams_.normals.finish();
}

void VertexPass::finish() {
  stop();
  next_ = nowhere;
  if (writer_.streaming_) writer_.kernels_.finish_streaming();
}

}  // namespace tessera
