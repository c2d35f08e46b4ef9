#include "tess/vertex_pass.h"

#include <limits>

namespace tessera {

void VertexPass::write(std::size_t patch) {
  if (writer_.plan_.division(patch).empty) return;
  writer_.prepare(patch, vertices_);
  const std::size_t first = writer_.plan_.first_vertex(patch), count = writer_.plan_.first_vertex(patch + 1) - first;
  if (writer_.streaming_) return write_streaming(first, count);
  vertices_.job.position = records(writer_.out_.position, first);
  vertices_.job.normal = records(writer_.out_.normal, first);
  vertices_.job.writable = static_cast<int>(std::min<std::size_t>(count, std::numeric_limits<int>::max()));
  writer_.kernels_.mesh_vertices(vertices_.job);
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
  vertices_.job.position = packed_records(position ? position : streams_.positions.out());
  vertices_.job.normal = with_normals ? packed_records(normal ? normal : streams_.normals.out()) : kernel::MeshRecords{};
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
