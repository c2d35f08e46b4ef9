#pragma once
// Edges in the order of their places, so that those that are near each other are found by a search on both sides.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include "parallel/parallel_for.h"
#include "tess/edges/side_curve.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// An edge, and where its middle lies along `unaligned`.
struct EdgePlace {
  EdgePlace(std::uint32_t of, const Vec3& at) : edge(of), middle(at), along(dot(unaligned, at)) {}
  bool operator<(const EdgePlace& other) const {
    return along < other.along || (along == other.along && edge < other.edge);
  }

  std::uint32_t edge;
  Vec3 middle;  ///< of the edge's ends, relative to the set's origin
  double along;
};

/// Sorts a list by pieces, and joins these two by two, on all threads.
inline void sort_by_pieces(std::vector<EdgePlace>& list) {
  constexpr std::size_t piece = 4096;
  const auto for_runs = [&](std::size_t run, const auto& work) {
    const Status status = parallel_for(list.size(), run, {}, [&](std::size_t begin, std::size_t end) {
      work(list.begin() + static_cast<std::ptrdiff_t>(begin), list.begin() + static_cast<std::ptrdiff_t>(end));
    });
    if (!status.ok()) throw std::bad_alloc();
  };
  for_runs(piece, [](auto begin, auto end) { std::sort(begin, end); });
  for (std::size_t run = piece; run < list.size(); run *= 2)
    for_runs(2 * run, [run](auto begin, auto end) {
      if (static_cast<std::size_t>(end - begin) > run)
        std::inplace_merge(begin, begin + static_cast<std::ptrdiff_t>(run), end);
    });
}

}}  // namespace tessera::abi_0_1
