#pragma once
// Nets of Bezier points with their weights, polynomial or rational, and matrix products that keep them in their hull.

#include <vector>

#include "convert/basis/bernstein_matrices.h"
#include "tessera/bezier_operations.h"

namespace tessera { inline namespace abi_0_1 {

/// A net of rows * columns points [i][j], i along u, with as many weights or none. A curve is one row.
struct BezierNet {
  int rows = 0, columns = 0;
  std::vector<Vec3> points;
  std::vector<double> weights;

  BezierNet(int row_count, int column_count, bool rational);
  explicit BezierNet(const BezierPatch& patch);
  explicit BezierNet(const BezierPolygon& curve);

  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * columns + j); }
  /// Returns the patch. It is rational if there are weights, even equal ones: a part of a rational patch stays
  /// rational, as its neighbours do. Errors: those of BezierPatch::polynomial and BezierPatch::rational.
  Result<BezierPatch> patch() const;
  /// Returns a net of one row or one column as a curve.
  BezierPolygon polygon() const { return {points, weights}; }
};

// Apply a matrix to each column (u) or row (v) of the net; its columns() must fit the net. Entries and rows are as in
// bernstein_matrices.h; rational nets are transformed in homogeneous form. Sums are relative to the point with the
// largest entry. So equal points stay equal to the last bit, and results from the same points and the same entries are
// bit-equal.

BezierNet transform_u(const Matrix& matrix, const BezierNet& net);
BezierNet transform_v(const Matrix& matrix, const BezierNet& net);

/// Returns the curve with a degree that is not lower.
BezierPolygon elevated(const BezierPolygon& curve, int degree);

/// Returns the net with u and v exchanged.
BezierNet transpose(const BezierNet& net);

}}  // namespace tessera::abi_0_1
