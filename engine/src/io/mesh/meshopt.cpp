#include "io/mesh/meshopt.h"

#include <meshoptimizer.h>

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {
namespace {

const unsigned char* bytes_of(std::string_view text) { return reinterpret_cast<const unsigned char*>(text.data()); }
unsigned char* bytes_of(std::string& text) { return reinterpret_cast<unsigned char*>(text.data()); }

/// Sets the versions of the streams that the extension has, once: they are settings of the process, and newer libraries
/// begin with others.
void set_versions() {
  static const bool is_done = (meshopt_encodeVertexVersion(0), meshopt_encodeIndexVersion(1), true);
  (void)is_done;
}

}  // namespace

bool has_meshopt() { return true; }

std::string pack_attributes(std::string_view elements, std::size_t stride) {
  set_versions();
  const std::size_t count = elements.size() / stride;
  std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
  packed.resize(meshopt_encodeVertexBuffer(bytes_of(packed), packed.size(), elements.data(), count, stride));
  packed.shrink_to_fit();
  return packed;
}

std::string pack_triangles(std::span<const std::uint32_t> indices) {
  set_versions();
  const std::size_t vertices = indices.empty() ? 0 : std::size_t{std::ranges::max(indices)} + 1;
  std::string packed(meshopt_encodeIndexBufferBound(indices.size(), vertices), '\0');
  packed.resize(meshopt_encodeIndexBuffer(bytes_of(packed), packed.size(), indices.data(), indices.size()));
  packed.shrink_to_fit();
  return packed;
}

std::string unpack(const MeshoptView& view, std::string_view packed) {
  const auto [mode, filter, count, stride] = view;
  std::string elements(count * stride, '\0');
  using Decode = int (*)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
  Decode decode = meshopt_decodeVertexBuffer;
  if (mode == MeshoptMode::triangles) decode = meshopt_decodeIndexBuffer;
  if (mode == MeshoptMode::indices) decode = meshopt_decodeIndexSequence;
  if (decode(elements.data(), count, stride, bytes_of(packed), packed.size()) != 0) return {};
  if (filter == MeshoptFilter::octahedral) meshopt_decodeFilterOct(elements.data(), count, stride);
  if (filter == MeshoptFilter::quaternion) meshopt_decodeFilterQuat(elements.data(), count, stride);
  if (filter == MeshoptFilter::exponential) meshopt_decodeFilterExp(elements.data(), count, stride);
  return elements;
}

}}  // namespace tessera::abi_0_1
