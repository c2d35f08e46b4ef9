#pragma once
// The inside of a SurfaceMap.

#include <vector>

#include "tessera/evaluate.h"

namespace tessera { inline namespace abi_0_1 {

class SurfaceMap::Impl {
 public:
  /// Patch (a, b) is first_patch + a * (breaks_v.size() - 1) + b. No breakpoints: there is no such surface.
  struct Surface {
    std::size_t first_patch = 0;
    std::vector<double> breaks_u, breaks_v;

    Domain domain() const { return {breaks_u.front(), breaks_u.back(), breaks_v.front(), breaks_v.back()}; }
  };
  std::vector<Surface> surfaces;
  std::size_t patch_count = 0;
};

}}  // namespace tessera::abi_0_1
