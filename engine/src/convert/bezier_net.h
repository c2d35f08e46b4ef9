#pragma once
// Nets of Bezier points with their weights, polynomial or rational, under matrices that keep their hull.

#include <vector>

#include "convert/bernstein_matrices.h"
#include "tessera/bezier_operations.h"

namespace tessera::inline abi_0_1 {

/// rows * columns points [i][j], i along u; as many weights, or none. A curve is one row.
struct BezierNet {
  int rows = 0, columns = 0;
  std::vector<Vec3> points;
  std::vector<double> weights;

  BezierNet(int row_count, int column_count, bool rational);
  explicit BezierNet(const BezierPatch& patch);
  explicit BezierNet(const BezierPolygon& curve);

  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * columns + j); }
  /// Rational if there are weights, even equal ones: a part of a rational patch stays rational, as its neighbours do.
  /// Errors: those of BezierPatch::polynomial and rational.
  Result<BezierPatch> patch() const;
  /// A net of one row or one column.
  BezierPolygon polygon() const { return {points, weights}; }
};

// The matrix's columns() fit the net. Entries and rows as in bernstein_matrices.h; rational nets in homogeneous form.
// Sums are relative to the point with the largest entry, so equal points stay equal to the last bit, and what depends
// on the same points by the same entries is the same bits.

BezierNet transform_u(const Matrix& matrix, const BezierNet& net);
BezierNet transform_v(const Matrix& matrix, const BezierNet& net);

/// The same curve by a degree that is not lower.
BezierPolygon elevated(const BezierPolygon& curve, int degree);

/// The net with u and v exchanged.
BezierNet transpose(const BezierNet& net);

}  // namespace tessera::inline abi_0_1
