#pragma once
// Halves the triangles of a cut patch that are too large for its tolerance.

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/function_ref.h"
#include "tessera/geometry.h"

namespace tessera::inline abi_0_1 {

/// Divides large triangles by the middle of their longest edge, together with the neighbour there (Rivara 1984,
/// Algorithms for refining triangular grids). An object serves one thread at a time.
class BandRefiner {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  /// Divides triangles [first, end) until none is too large, or its longest edge belongs to no second one of them.
  ///
  /// - `vertices`: parameters; new ones are appended.
  /// - `length`: of an edge, from one vertex to another.
  void run(std::vector<ParameterPoint>& vertices, std::vector<Triangle>& triangles, std::size_t first,
           FunctionRef<bool(const Triangle&)> is_large, FunctionRef<double(std::uint32_t, std::uint32_t)> length);

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
  }
  void add_edge(std::uint32_t a, std::uint32_t b, std::uint32_t triangle);
  void move_edge(std::uint32_t a, std::uint32_t b, std::uint32_t from, std::uint32_t to);
  /// Divides a triangle at the middle m of its edge from a to b. Returns the number of the new one.
  std::uint32_t divide(std::vector<Triangle>& triangles, std::uint32_t triangle, std::uint32_t a, std::uint32_t b,
                       std::uint32_t m);

  std::unordered_map<std::uint64_t, std::array<std::uint32_t, 2>> edges_;  ///< the triangles at each edge
  std::vector<std::uint32_t> large_;
};

}  // namespace tessera::inline abi_0_1
