#pragma once
// Divides chords where they cross, so that a polygon of loops that cross themselves or each other can be triangulated.

#include <utility>
#include <vector>

#include "plane/polygon_triangles.h"

namespace tessera { inline namespace abi_0_1 {

/// Finds and divides crossing chords. An object serves one thread at a time.
class ChordCrossings {
 public:
  /// Appends a point for each crossing, and divides both chords there. The point is rounded, within the boxes of both
  /// chords, so a chord may then cross another one: the search is repeated up to 16 times. Returns false if some still
  /// cross. Parity is that of the chords as given, but for slivers of a few units in the last place.
  ///
  /// Time: O(n log n) for n chords, plus the pairs whose boxes overlap along u.
  ///
  /// `marks`: one per chord; parts of a chord have its mark.
  bool divide(std::vector<ParameterPoint>& points, std::vector<PlaneSegment>& chords,
              std::vector<std::uint32_t>& marks);

 private:
  /// Divides once. Returns whether any chords crossed.
  bool divide_once(std::vector<ParameterPoint>& points, std::vector<PlaneSegment>& chords,
                   std::vector<std::uint32_t>& marks);

  std::vector<std::uint32_t> order_;                              ///< chords by growing u
  std::vector<std::pair<std::uint32_t, std::uint32_t>> divided_;  ///< chord, point inside it
  std::vector<PlaneSegment> next_;
  std::vector<std::uint32_t> next_marks_;
};

}}  // namespace tessera::abi_0_1
