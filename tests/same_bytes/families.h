#pragma once
// One hash per family of results.

#include <cstdint>
#include <string>
#include <vector>

#include <tessera/execution.h>

struct Family {
  std::string name;
  std::uint64_t (*hash)(tessera::Isa);
};

/// Scalar code in double: conversions, reference evaluators, curvatures, joins. They ignore the instruction set.
std::vector<Family> surface_families();
/// Grids, scattered points, meshes.
std::vector<Family> set_families();
#ifdef SAME_BYTES_RAYS
std::vector<Family> ray_families();
#endif
