#pragma once
// Points of a patch in double, one by one and along lines of a grid.

#include <array>
#include <span>
#include <vector>

#include "surface/net/homogeneous.h"
#include "tessera/bezier_patch.h"

namespace tessera::inline abi_0_1 {

/// Evaluates a patch at parameters in [0,1]^2. On a side only the side's control points count, because Bernstein values
/// at 0 and 1 are exact; so neighbours with the same control points get the same bits. Rounding: f64_vertex_rounding().
class PatchPoints {
 public:
  /// Prepares points relative to `origin`.
  PatchPoints(const BezierPatch& patch, const Vec3& origin) : net_(patch, origin) {}

  Vec3 at(const ParameterPoint& local);
  /// Tabulates the parameters v = lines[j] of a grid.
  void set_lines(std::span<const double> lines);
  /// Goes to the line u = const; then in_row(j) is at({u, lines[j]}), bit for bit.
  void begin_row(double u);
  Vec3 in_row(std::size_t j) const { return sum(&of_lines_[j * values_per_line]); }

 private:
  static constexpr std::size_t values_per_line = max_degree + 1;
  Vec3 sum(const double* of_v) const;

  HomogeneousNet net_;
  std::array<Homogeneous, max_degree + 1> row_;
  std::vector<double> of_lines_;  ///< `[line][max_degree + 1]`
};

}  // namespace tessera::inline abi_0_1
