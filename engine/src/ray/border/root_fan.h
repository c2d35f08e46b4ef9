#pragma once
// The places of a root in the patches around it, from border to border.

#include <array>
#include <cstddef>
#include <span>

#include "ray/border/root_places.h"

namespace tessera { inline namespace abi_0_1 {

/// The places of a root beyond all borders, vertices and poles that it reaches. `apart` bounds how far a point for the
/// same root can be off across the line.
class RootFan {
 public:
  RootFan(const SetView& set, const Adjacency& borders, const LeafRoot& root, double apart);
  /// Returns the places without the root itself.
  std::span<const LeafRoot> beyond() const { return std::span(places_).first(count_).subspan(1); }

 private:
  static constexpr std::size_t most = 32;  // around a vertex of more patches the far ones are left out

  void spread(const LeafRoot& from);
  void add(const LeafRoot& place);

  const SetView& set_;
  const Adjacency& borders_;
  double apart_;
  std::array<LeafRoot, most> places_;
  std::size_t count_ = 0;
};

}}  // namespace tessera::abi_0_1
