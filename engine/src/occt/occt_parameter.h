#pragma once
// Parameters of OpenCASCADE as the maps of a model state them.

#include <optional>

#include "exact/arcs.h"
#include "tessera/occt.h"

namespace tessera { inline namespace abi_0_1 {

inline OcctParameter occt_parameter(const std::optional<Arcs>& arcs) {
  if (!arcs) return {};
  return {Interval{arcs->from(), arcs->to()}};
}

}}  // namespace tessera::abi_0_1
