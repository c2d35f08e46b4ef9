#pragma once
// Numbers packed as EXT_meshopt_compression states (Khronos Group, glTF extensions, 2022), by meshoptimizer.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tessera { inline namespace abi_0_1 {

/// How elements are packed.
enum class MeshoptMode : std::uint8_t {
  attributes,  ///< bytes of vectors
  triangles,   ///< indices, three for each triangle
  indices,     ///< indices in any order
};
/// How attributes are turned into numbers after they are unpacked.
enum class MeshoptFilter : std::uint8_t { none, octahedral, quaternion, exponential };

/// Whether this build packs and unpacks.
bool has_meshopt();

/// Packs vectors of `stride` bytes, a multiple of 4 up to 256; all bits are kept. Requires has_meshopt(). Throws
/// std::bad_alloc.
std::string pack_attributes(std::string_view elements, std::size_t stride);
/// Packs triangles, three indices each, in their order. A triangle may begin at another of its corners, and turns as
/// before. Requires has_meshopt(). Throws std::bad_alloc.
std::string pack_triangles(std::span<const std::uint32_t> indices);

/// The kind, number and size of a view's packed elements.
struct MeshoptView {
  MeshoptMode mode = MeshoptMode::attributes;
  MeshoptFilter filter = MeshoptFilter::none;
  std::size_t count = 0, stride = 0;  ///< elements, and bytes of each
};
/// Whether elements of these kinds can have this stride and count.
bool is_allowed(const MeshoptView& view);
/// Unpacks elements. Returns count * stride bytes, or none where the packed bytes are damaged. Requires has_meshopt()
/// and is_allowed(). Throws std::bad_alloc.
std::string unpack(const MeshoptView& view, std::string_view packed);

}}  // namespace tessera::abi_0_1
