#pragma once
// The edges that a sweep line crosses, from below to above.

#include <cstdint>
#include <vector>

#include "basis/exact_sign.h"
#include "plane/funnel.h"
#include "plane/sweep_points.h"

namespace tessera { inline namespace abi_0_1 {

/// The edges that the line crosses, in places that stay while an edge is replaced by its successor. Place `bottom` lies
/// below all edges. Search, insertion and removal take O(log n): the places form a treap (Seidel and Aragon 1996,
/// Randomized search trees), with priorities that depend only on the order of insertions.
class SweepLine {
 public:
  static constexpr std::uint32_t bottom = 0;

  struct Place {
    std::uint32_t start, end;    ///< ranks of the edge's ends
    std::uint32_t edge = no_id;  ///< the caller's number of the edge
    std::uint32_t below = no_id, above = no_id;
    Gap gap;  ///< between this edge and the one above
  };

  /// Empties the line but for `bottom`, whose gap is outside.
  void clear();
  Place& at(std::uint32_t place) { return places_[place]; }
  /// Positive if a point lies above the edge of a place, 0 if on it.
  int side(const SweepPoints& points, std::uint32_t place, std::uint32_t rank) const {
    return orientation(points.at(places_[place].start), points.at(places_[place].end), points.at(rank));
  }
  /// Returns the place of an edge through a point, if there is one, or else of the edge below it.
  struct Found {
    std::uint32_t place;
    bool is_on_edge;
  };
  Found find(const SweepPoints& points, std::uint32_t rank) const;
  /// Returns a new place just above another.
  std::uint32_t insert_above(std::uint32_t place);
  void erase(std::uint32_t place);

 private:
  struct Node {
    std::uint32_t parent = no_id, left = no_id, right = no_id, priority = 0;
  };
  std::uint32_t& link_to(std::uint32_t place);
  void rotate_up(std::uint32_t place);

  std::vector<Place> places_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> free_;
  std::uint32_t root_ = no_id, random_ = 1;
};

}}  // namespace tessera::abi_0_1
