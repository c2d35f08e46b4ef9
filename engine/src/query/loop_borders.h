#pragma once
// The borders of what the loops of a set's faces keep, and the patches and edges along which they run.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ray/line/set_view.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// A part of the border of what is kept of a patch.
struct SetBorder {
  std::uint32_t patch = no_id;
  const TrimPiece* piece = nullptr;  ///< the piece of a loop that it is; null: a side
  Side side{};                       ///< without a piece: in the direction of growing parameters
  std::int8_t direction = 1;         ///< 1: the kept part is on the left, as the patch's normals see it; -1: the right
  std::uint32_t use = no_id;         ///< a number of the coedge, below LoopBorders::uses.size()
};
/// 1 if a patch is on the left of its side, in the direction of growing parameters; else -1.
inline std::int8_t direction_of(Side side) { return side == Side::v0 || side == Side::u1 ? 1 : -1; }

/// Returns the point of a border at t in [0, 1].
Vec3 position_on(const SetView& set, const SetBorder& border, double t);

/// The use of an edge by a face.
struct BorderUse {
  std::uint32_t edge = no_id;   ///< index into PatchEdges::edges
  std::uint32_t patch = no_id;  ///< of the face
  double along = 0;             ///< its length, negative if it runs against the edge with the kept part on its left
};

struct LoopBorders {
  std::vector<SetBorder> borders;      ///< along the loops of all faces that name edges or have a cut patch
  std::vector<BorderUse> uses;         ///< `[use]`
  std::vector<std::uint32_t> face_of;  ///< `[patch]`: the first patch of such a face, or no_id
};
LoopBorders find_loop_borders(const SetView& set);

}}  // namespace tessera::abi_0_1
