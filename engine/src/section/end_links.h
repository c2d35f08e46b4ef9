#pragma once
// Joins the ends of strands: at borders that patches share, along edges that faces share, and where they are near.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "section/strands.h"
#include "tess/closing/edge_runs.h"

namespace tessera { inline namespace abi_0_1 {

/// How ends are joined.
struct LinkOptions {
  const EdgeRuns* runs = nullptr;  ///< null: no face names edges
  double max_gap = 0;              ///< of ends along one edge
  double near = 0;                 ///< of other ends
};

/// Joins the strands of one plane; keeps its memory. End 2 k + e is end e of strand k.
class EndLinks {
 public:
  void join(std::span<const Strand> strands, std::span<const SectionPoint> points, const LinkOptions& options);

  /// The end that an end is joined to; none if it is open.
  std::uint32_t other(std::uint32_t end) const { return other_[end]; }
  double largest_gap() const { return largest_gap_; }

 private:
  /// An end on an edge.
  struct EdgeEnd {
    std::uint32_t edge, use;
    double place;
    std::uint32_t end;
  };
  struct Pair {
    double distance;
    std::uint32_t a, b;
  };
  const StrandEnd& at(std::uint32_t end) const { return strands_[end / 2].ends[end % 2]; }
  const SectionPoint& point(std::uint32_t end) const;
  void join_borders();
  void join_edges(const LinkOptions& options);
  void join_near(double distance);
  void join_pairs();
  void link(std::uint32_t a, std::uint32_t b) { other_[a] = b, other_[b] = a; }

  std::span<const Strand> strands_;
  std::span<const SectionPoint> points_;
  std::vector<std::uint32_t> other_;
  std::vector<std::uint32_t> ends_;
  std::vector<EdgeEnd> on_edges_;
  std::vector<Pair> pairs_;
  double largest_gap_ = 0;
};

}}  // namespace tessera::abi_0_1
