#pragma once
// A ray as the tree of facets takes it.

#include <array>

namespace tessera { inline namespace abi_0_1 {

/// A ray in Embree's form: every number finite, 0 <= tnear <= tfar, direction not zero.
struct FacetRay {
  std::array<float, 3> origin{}, direction{};
  float tnear = 0, tfar = 0;
};

}}  // namespace tessera::abi_0_1
