#pragma once
// Triangulates the part of a polygon between two edges while a line sweeps over it (Garey, Johnson, Preparata, Tarjan
// 1978, Triangulating a simple polygon; de Berg et al., Computational Geometry, 3rd ed., sec. 3.3).

#include <array>
#include <cassert>
#include <cstdint>
#include <utility>
#include <vector>

#include "basis/exact_sign.h"
#include "plane/sweep_points.h"

namespace tessera { inline namespace abi_0_1 {

/// The edge of an interval that a point lies on.
enum class Bank : std::uint8_t { lower, upper };

/// Points of one bank that still need triangles, the latest on top. Only the lowest may be on the other bank. All turn
/// away from the interval, or lie on a line: else they would have their triangles.
struct Funnel {
  std::uint32_t top = no_id;  ///< a place in Funnels
  Bank bank = Bank::lower;
};

/// The part of an interval between two edges that has no triangles yet.
struct Gap {
  Funnel lower, upper;  ///< `upper` only after two gaps have met in a point, which is on top of both
  bool is_inside = false;

  bool is_double() const { return upper.top != no_id; }
};

/// The funnels of one sweep, and the triangles so far, counter-clockwise, three ranks each.
class Funnels {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  void clear() { links_.clear(), triangles_.clear(); }
  void reserve(std::size_t links, std::size_t triangles) { links_.reserve(links), triangles_.reserve(triangles); }
  std::vector<Triangle>& triangles() { return triangles_; }

  /// Begins a gap at a point.
  Gap begin(std::uint32_t rank) { return {{push(rank, no_id), Bank::lower}, {}, true}; }
  /// Adds a point on a bank of a gap.
  void add(const SweepPoints& points, Gap& gap, std::uint32_t rank, Bank bank) {
    if (gap.is_double()) {
      close(bank == Bank::lower ? gap.lower : gap.upper, rank);
      if (bank == Bank::lower) gap.lower = gap.upper;
      gap.upper = {};
    }
    add(points, gap.lower, rank, bank);
  }
  /// Ends a gap in a point.
  void end(Gap& gap, std::uint32_t rank) {
    close(gap.lower, rank);
    if (gap.is_double()) close(gap.upper, rank);
    gap = {};
  }
  /// Splits a gap at a point within it. Returns the part above the point; `gap` becomes the part below.
  Gap split(const SweepPoints& points, Gap& gap, std::uint32_t rank);
  /// Joins two gaps in a point, which is on the upper bank of `below` and on the lower one of `above`.
  void join(const SweepPoints& points, Gap& below, Gap& above, std::uint32_t rank) {
    add(points, below, rank, Bank::upper);
    add(points, above, rank, Bank::lower);
    below.upper = above.lower;
  }

 private:
  struct Link {
    std::uint32_t rank, below;
  };

  std::uint32_t push(std::uint32_t rank, std::uint32_t below) {
    links_.push_back({rank, below});
    return static_cast<std::uint32_t>(links_.size() - 1);
  }
  void add(const SweepPoints& points, Funnel& funnel, std::uint32_t rank, Bank bank);
  /// Joins a point to all points of a funnel.
  void close(const Funnel& funnel, std::uint32_t rank);

  std::vector<Link> links_;
  std::vector<Triangle> triangles_;
};

inline void Funnels::close(const Funnel& funnel, std::uint32_t rank) {
  std::uint32_t top = funnel.top;
  for (std::uint32_t below = links_[top].below; below != no_id; top = below, below = links_[top].below) {
    const std::uint32_t first = links_[below].rank, second = links_[top].rank;
    triangles_.push_back(funnel.bank == Bank::lower ? Triangle{first, second, rank} : Triangle{second, first, rank});
  }
}

inline void Funnels::add(const SweepPoints& points, Funnel& funnel, std::uint32_t rank, Bank bank) {
  std::uint32_t top = funnel.top;
  if (bank != funnel.bank && links_[top].below != no_id) {
    close(funnel, rank);
    links_[top].below = no_id;
  }
  const ParameterPoint& at = points.at(rank);
  for (std::uint32_t below = links_[top].below; below != no_id; top = below, below = links_[top].below) {
    const std::uint32_t first = links_[below].rank, second = links_[top].rank;
    const int turn = orientation(points.at(first), points.at(second), at);
    if (bank == Bank::lower ? turn <= 0 : turn >= 0) break;
    triangles_.push_back(bank == Bank::lower ? Triangle{first, second, rank} : Triangle{second, first, rank});
  }
  funnel = {push(rank, top), bank};
}

}}  // namespace tessera::abi_0_1
