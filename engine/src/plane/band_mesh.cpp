#include "plane/band_mesh.h"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace tessera { inline namespace abi_0_1 {

void BandMesh::link(std::vector<Triangle>& triangles, std::size_t first) {
  triangles_ = &triangles;
  first_ = static_cast<std::uint32_t>(first);
  links_.assign(triangles.size() - first, {});
  by_ends_.clear();
  for (std::uint32_t t = begin(); t < end(); ++t)
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const Edge edge{t, corner};
      const std::uint64_t a = start(edge), b = finish(edge);
      by_ends_.emplace_back(std::min(a, b) << 32 | std::max(a, b), edge);
    }
  std::ranges::sort(by_ends_, {}, [](const auto& entry) {
    return std::tuple(entry.first, entry.second.triangle, entry.second.corner);
  });
  for (std::size_t from = 0, to = 0; from < by_ends_.size(); from = to) {
    while (to < by_ends_.size() && by_ends_[to].first == by_ends_[from].first) ++to;
    if (to - from == 2 && start(by_ends_[from].second) == finish(by_ends_[from + 1].second))
      join(by_ends_[from].second, by_ends_[from + 1].second);
  }
}

void BandMesh::join(Edge a, Edge b) {
  if (a.exists()) links_[a.triangle - first_][a.corner] = b;
  if (b.exists()) links_[b.triangle - first_][b.corner] = a;
}

// The triangle (a, b, c) becomes (a, m, c), the new one is (m, b, c); the neighbour (b, a, d) becomes (b, m, d), the
// new one is (m, a, d). Corners keep their places.
void BandMesh::divide(Edge edge, std::uint32_t middle) {
  const Edge other = across(edge);
  assert(other.exists());
  const auto halve = [&](Edge of) {
    const auto added = end();
    Triangle half = triangle(of.triangle);
    half[of.corner] = middle;
    (*triangles_)[of.triangle][next(of.corner)] = middle;
    triangles_->push_back(half);
    links_.emplace_back();
    const Edge moved{of.triangle, next(of.corner)}, side{added, next(of.corner)};  // from b to c
    join(side, across(moved));
    join(moved, {added, before(of.corner)});  // from m to c
    return Edge{added, of.corner};
  };
  const Edge half = halve(edge), other_half = halve(other);
  join(edge, other_half);
  join(half, other);
}

std::pair<BandMesh::Triangle, BandMesh::Triangle> BandMesh::flipped(Edge edge) const {
  const Edge other = across(edge);
  Triangle own = triangle(edge.triangle), others = triangle(other.triangle);
  own[next(edge.corner)] = apex(other);
  others[next(other.corner)] = apex(edge);
  return {own, others};
}

bool BandMesh::flip(Edge edge) {
  const Edge other = across(edge);
  assert(other.exists());
  const Edge diagonal{edge.triangle, next(edge.corner)}, other_diagonal{other.triangle, next(other.corner)};
  const Edge beside = across(diagonal), beside_other = across(other_diagonal);
  if (beside.triangle == other.triangle || beside_other.triangle == edge.triangle) return false;
  std::tie((*triangles_)[edge.triangle], (*triangles_)[other.triangle]) = flipped(edge);
  join(edge, beside_other);
  join(other, beside);
  join(diagonal, other_diagonal);
  return true;
}

}}  // namespace tessera::abi_0_1
