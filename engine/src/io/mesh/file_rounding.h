#pragma once
// How far positions move when a file holds them in the model's coordinates.

#include <cstdint>

#include "tessera/mesh.h"

namespace tessera { inline namespace abi_0_1 {

/// The numbers that decide how positions round.
struct PositionRange {
  Vec3 origin = {};
  Vec3 reach = {};           ///< largest |x|, |y|, |z| relative to the origin
  bool has_doubles = false;  ///< whether the mesh has positions in double

  static PositionRange of(const Mesh& mesh);
};

/// Whether a text file or one with properties of any type holds sums of origin and position as doubles: floats would
/// move vertices by more than 2^-16 of the reach. Meshes with positions in double have these written in any case.
bool needs_double_sums(const PositionRange& range);

}}  // namespace tessera::abi_0_1
