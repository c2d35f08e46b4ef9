#include "convert/basis/bezier_net.h"

#include <cassert>

#include "surface/net/patch_pieces.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The point and weight that one row of the matrix makes of one column of the net.
struct Combination {
  const Matrix& matrix;
  const BezierNet& net;
  int row, column;

  long double entry(int i) const { return matrix(row, i); }
  const Vec3& point(int i) const { return net.points[net.index(i, column)]; }
  long double weight(int i) const { return net.weights.empty() ? 1 : net.weights[net.index(i, column)]; }

  int heaviest() const {
    int largest = 0;
    for (int i = 1; i < matrix.columns(); ++i)
      if (entry(i) > entry(largest)) largest = i;
    return largest;
  }

  /// Returns sum c_i w_i.
  double combined_weight() const {
    const int centre = heaviest();
    long double sum = 0;
    for (int i = 0; i < matrix.columns(); ++i) sum += entry(i) * (weight(i) - weight(centre));
    return static_cast<double>(weight(centre) + sum);
  }

  /// Returns sum c_i w_i p_i / sum c_i w_i.
  Vec3 combined_point() const {
    const Vec3& centre = point(heaviest());
    long double total = 0, x = 0, y = 0, z = 0;
    for (int i = 0; i < matrix.columns(); ++i) {
      const long double factor = entry(i) * weight(i);
      const Vec3& p = point(i);
      total += factor;
      x += factor * (static_cast<long double>(p.x) - centre.x);
      y += factor * (static_cast<long double>(p.y) - centre.y);
      z += factor * (static_cast<long double>(p.z) - centre.z);
    }
    return {static_cast<double>(centre.x + x / total), static_cast<double>(centre.y + y / total),
            static_cast<double>(centre.z + z / total)};
  }
};

}  // namespace

BezierNet::BezierNet(int row_count, int column_count, bool rational)
    : rows(row_count), columns(column_count), points(static_cast<std::size_t>(row_count * column_count)) {
  if (rational) weights.resize(points.size());
}

BezierNet::BezierNet(const BezierPatch& patch)
    : rows(patch.degree_u() + 1),
      columns(patch.degree_v() + 1),
      points(patch.points().begin(), patch.points().end()),
      weights(patch.weights().begin(), patch.weights().end()) {}

BezierNet::BezierNet(const BezierPolygon& curve)
    : rows(1), columns(static_cast<int>(curve.points.size())), points(curve.points), weights(curve.weights) {}

Result<BezierPatch> BezierNet::patch() const {
  if (weights.empty()) return BezierPatch::polynomial(rows - 1, columns - 1, points);
  Result<BezierPatch> checked = BezierPatch::rational(rows - 1, columns - 1, points, weights);
  if (!checked || checked->is_rational()) return checked;
  return PatchPieces::single(rows - 1, columns - 1, points, weights);  // all weights are equal, and kept
}

BezierNet transform_u(const Matrix& matrix, const BezierNet& net) {
  assert(matrix.columns() == net.rows);
  BezierNet result(matrix.rows(), net.columns, !net.weights.empty());
  for (int i = 0; i < result.rows; ++i)
    for (int j = 0; j < result.columns; ++j) {
      const Combination combination{matrix, net, i, j};
      result.points[result.index(i, j)] = combination.combined_point();
      if (!net.weights.empty()) result.weights[result.index(i, j)] = combination.combined_weight();
    }
  return result;
}

BezierNet transform_v(const Matrix& matrix, const BezierNet& net) {
  return transpose(transform_u(matrix, transpose(net)));
}

BezierPolygon elevated(const BezierPolygon& curve, int degree) {
  const int from = static_cast<int>(curve.points.size()) - 1;
  if (degree == from) return curve;
  return transform_v(elevation_matrix(from, degree), BezierNet(curve)).polygon();
}

BezierNet transpose(const BezierNet& net) {
  BezierNet result(net.columns, net.rows, !net.weights.empty());
  for (int i = 0; i < net.rows; ++i)
    for (int j = 0; j < net.columns; ++j) {
      result.points[result.index(j, i)] = net.points[net.index(i, j)];
      if (!net.weights.empty()) result.weights[result.index(j, i)] = net.weights[net.index(i, j)];
    }
  return result;
}

}}  // namespace tessera::abi_0_1
