#pragma once
// The patches that share a border, so that a root that lies just across a border is searched on the other side.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "ray/line/set_view.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {

/// The four edges in a fixed order, for indices.
inline constexpr std::array<Side, 4> link_sides{Side::u0, Side::u1, Side::v0, Side::v1};

/// The other side of an edge.
struct EdgeLink {
  std::uint32_t patch = no_id;
  std::uint8_t edge = 0;  ///< index into link_sides
  bool reversed = false;  ///< the two run along the edge in opposite directions
  bool exists() const { return patch != no_id; }
};

/// Links two edges if they, and no third one, have the same control points and weights (by ==), in either order.
/// Collapsed edges are not linked.
class Adjacency {
 public:
  Adjacency() = default;
  explicit Adjacency(const SetView& set);

  const EdgeLink& across(std::uint32_t patch, int edge) const { return links_[patch][static_cast<std::size_t>(edge)]; }
  std::size_t memory_bytes() const { return links_.capacity() * sizeof(links_[0]); }

 private:
  std::vector<std::array<EdgeLink, 4>> links_;
};

}}  // namespace tessera::abi_0_1
