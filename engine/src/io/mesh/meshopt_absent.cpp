// For builds without meshoptimizer.

#include "io/mesh/meshopt.h"

namespace tessera { inline namespace abi_0_1 {

bool has_meshopt() { return false; }

std::string pack_attributes(std::string_view, std::size_t) { return {}; }
std::string pack_triangles(std::span<const std::uint32_t>) { return {}; }
std::string unpack(const MeshoptView&, std::string_view) { return {}; }

}}  // namespace tessera::abi_0_1
