#pragma once
// Holds disjoint sets whose members have a direction relative to each other.

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

/// Sets of 0 .. count - 1, each represented by its least member (Tarjan 1975, with path halving).
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parents_(count), turned_(count, 0) {
    std::iota(parents_.begin(), parents_.end(), std::uint32_t{0});
  }

  struct Root {
    std::uint32_t member;
    bool turned;  ///< whether it runs against the member that find() was called for
  };
  Root find(std::uint32_t k) {
    bool turned = false;
    while (parents_[k] != k) {
      const std::uint32_t above = parents_[k];
      turned_[k] = static_cast<std::uint8_t>(turned_[k] ^ turned_[above]);
      parents_[k] = parents_[above];
      turned = turned != (turned_[k] != 0);
      k = parents_[k];
    }
    return {k, turned};
  }
  /// Unites the sets of a and b; `turned`: a runs against b. Does nothing if they are in one set already.
  void unite(std::uint32_t a, std::uint32_t b, bool turned = false) {
    Root low = find(a), high = find(b);
    if (low.member == high.member) return;
    if (low.member > high.member) std::swap(low, high);
    parents_[high.member] = low.member;
    turned_[high.member] = (low.turned != high.turned) != turned;
  }

 private:
  std::vector<std::uint32_t> parents_;
  std::vector<std::uint8_t> turned_;  ///< whether a member runs against its parent; 0 for roots
};

}}  // namespace tessera::abi_0_1
