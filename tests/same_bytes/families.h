#pragma once
// One hash per family of results.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <tessera/execution.h>
#include <tessera/patch_set.h>

struct Family {
  std::string name;
  std::function<std::uint64_t(tessera::Isa)> hash;
};

/// Scalar code in double: conversions, reference evaluators, curvatures, joins. They ignore the instruction set.
std::vector<Family> surface_families();
/// Grids, scattered points, meshes.
std::vector<Family> set_families();
/// The certified mesh of a set, its bounds and angles.
std::uint64_t certified_hash(const tessera::PatchSet& set, double tolerance, tessera::Isa isa);
#ifdef SAME_BYTES_RAYS
std::vector<Family> ray_families();
/// The hits of `count` rays in the set's box, by exact mode or grid mode.
std::uint64_t hits_hash(const tessera::PatchSet& set, std::size_t count, bool exact, tessera::Isa isa);
#endif
