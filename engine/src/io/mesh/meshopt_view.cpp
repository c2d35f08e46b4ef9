#include "io/mesh/meshopt.h"

namespace tessera { inline namespace abi_0_1 {

bool is_allowed(const MeshoptView& view) {
  const auto [mode, filter, count, stride] = view;
  if (mode != MeshoptMode::attributes && filter != MeshoptFilter::none) return false;
  switch (mode) {
    case MeshoptMode::triangles:
      return count % 3 == 0 && (stride == 2 || stride == 4);
    case MeshoptMode::indices:
      return stride == 2 || stride == 4;
    case MeshoptMode::attributes:
      break;
  }
  if (filter == MeshoptFilter::octahedral) return stride == 4 || stride == 8;
  if (filter == MeshoptFilter::quaternion) return stride == 8;
  constexpr std::size_t largest = 256;
  return stride > 0 && stride <= largest && stride % 4 == 0;
}

}}  // namespace tessera::abi_0_1
