#pragma once
// The Bezier points of a whole surface, each once: patches that share a border share its points.

#include <vector>

#include "tessera/convert.h"

namespace tessera { inline namespace abi_0_1 {

/// A net of (count_u degree_u + 1) x (count_v degree_v + 1) points [i][j], i along u, over count_u x count_v patches,
/// with as many weights or none.
struct SurfaceNet {
  int degree_u, degree_v;
  std::vector<double> breaks_u, breaks_v;
  std::vector<Vec3> points;
  std::vector<double> weights;

  SurfaceNet(int m, std::vector<double> along_u, int n, std::vector<double> along_v, bool rational);

  std::size_t rows() const { return (breaks_u.size() - 1) * static_cast<std::size_t>(degree_u) + 1; }
  std::size_t columns() const { return (breaks_v.size() - 1) * static_cast<std::size_t>(degree_v) + 1; }
  std::size_t index(std::size_t i, std::size_t j) const { return i * columns() + j; }

  /// Returns the patches. Errors: non_finite (a point), invalid_weight (below 1e-100 of the largest of its patch); both
  /// say which patch.
  Result<PatchGrid> patches() const;
};

/// Returns the net with u and v exchanged.
SurfaceNet transposed(const SurfaceNet& net);

}}  // namespace tessera::abi_0_1
