#include "tess/bounds/turning_bound.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include "base/infinity.h"
#include "tess/bounds/degree_reduction.h"
#include "tess/bounds/normal_net.h"
#include "tess/bounds/rounded_up.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Pieces of up to 2^-max_depth of each parameter are looked at; rectangles have 2^-rectangle_depth.
constexpr int max_depth = 6, rectangle_depth = 3;
/// A bound is good enough within this factor of the turning at corners. Pieces with corners that turn by less than a
/// share of the bound are cut into rectangles.
constexpr double close_enough = 1.25, varied = 0.7;
/// Pieces that need no more cells than this along a parameter are not cut.
constexpr double few_cells = 1.5;
/// Turning per unit of a parameter that is below float's rounding of normals.
constexpr double negligible = 0x1p-20;
/// Pieces with more control points get fewer if that moves none by more than this, as a share of the field's length and
/// of the angle to keep: bounds over the smallest pieces then rise by about a hundredth of the angle.
constexpr double negligible_move = 0x1p-18;
constexpr int many_points = 128;
/// Radians per unit of a parameter beyond which the normal has nearly no direction somewhere.
constexpr double max_turning = 32;

/// The control points of a piece of the normal's net, `[component][i][j]`.
struct NormalPiece {
  int rows, columns;
  double* at[3];

  int count() const { return rows * columns; }
  Vec3 point(int i, int j) const {
    const int k = i * columns + j;
    return {at[0][k], at[1][k], at[2][k]};
  }
};

/// Cuts each row or column of a net at 1/2 by de Casteljau: `high` becomes the upper half, `low` the lower one.
void cut(const NormalPiece& high, const NormalPiece& low, bool along_u) {
  const int rows = high.rows, columns = high.columns;
  for (int c = 0; c < 3; ++c) {
    double *const from = high.at[c], *const to = low.at[c];
    if (along_u) {
      for (int k = 0; k < rows; ++k) {
        std::copy_n(from, columns, to + k * columns);
        for (int at = 0; at < (rows - 1 - k) * columns; ++at) from[at] = 0.5 * (from[at] + from[at + columns]);
      }
    } else {
      for (int i = 0; i < rows; ++i) {
        double *const row = from + i * columns, *const lower = to + i * columns;
        for (int k = 0; k < columns; ++k) {
          lower[k] = row[0];
          for (int j = 0; j + 1 < columns - k; ++j) row[j] = 0.5 * (row[j] + row[j + 1]);
        }
      }
    }
  }
}

/// The largest and the least turning at the corners of a piece.
struct AtCorners {
  Turning most, least{infinity, infinity};
};

/// Numbers of a piece, one for each control point; with room for a few more.
struct Scratch {
  double *first, *second, *third;
};

/// Returns the largest of `count` numbers that are at least 0. Four at a time, because the compiler may not reorder
/// comparisons.
double largest(const double* numbers, int count) {
  double most[4] = {0, 0, 0, 0};
  int k = 0;
  for (; k + 4 <= count; k += 4)
    for (int lane = 0; lane < 4; ++lane) most[lane] = numbers[k + lane] > most[lane] ? numbers[k + lane] : most[lane];
  for (; k < count; ++k) most[0] = std::max(most[0], numbers[k]);
  return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
}

/// One piece of the field: bounds over it, and the turning at its corners.
class Piece {
 public:
  /// `scale`: the factors from derivatives by the piece's parameters to those by the patch's.
  Piece(const NormalPiece& net, const Turning& scale, double rounding, const Scratch& scratch)
      : net_(net), scratch_(scratch), scale_(scale), rounding_(rounding) {
    const double *const x = net.at[0], *const y = net.at[1], *const z = net.at[2];
    const int count = net.count();
    Vec3 sum;
    for (int k = 0; k < count; ++k) sum += Vec3{x[k], y[k], z[k]};
    axis_ = normalized(sum);
    double *const squared = scratch.first, *const shortness = scratch.second;
    for (int k = 0; k < count; ++k) {
      const double along = axis_.x * x[k] + axis_.y * y[k] + axis_.z * z[k], inverse = 1 / along;
      const double dx = x[k] - along * axis_.x, dy = y[k] - along * axis_.y, dz = z[k] - along * axis_.z;
      squared[k] = (dx * dx + dy * dy + dz * dz) * (inverse * inverse);
      shortness[k] = along > 0 ? inverse : infinity;
    }
    // The net's shortest part along the axis, and the tangent of its widest angle with it.
    const double least = 1 / largest(shortness, count), tangent = std::sqrt(largest(squared, count));
    least_ = least * (1 - 0x1p-50) - rounding;
    const double rounded = (tangent * least + rounding) / least_;
    sine_ = rounded / std::sqrt(1 + rounded * rounded);  // bound() uses it only if all of the net lies along the axis
  }

  /// Returns the bound. With N within the angle phi of the axis,
  ///   |N_u x n| <= |N_u across the axis| + |N_u along it| sin phi.
  Turning bound() const {
    if (!(least_ > 0)) return {infinity, infinity};
    const int m = net_.rows - 1, n = net_.columns - 1;
    const double u = std::max(m, 1) * largest_difference(net_.columns, net_.count()),
                 v = std::max(n, 1) * largest_difference(1, net_.columns);
    return std::isnan(u + v) ? Turning{infinity, infinity} : Turning{u * scale_.u / least_, v * scale_.v / least_};
  }
  /// Returns a lower bound on the field's length along its mean direction; not above 0 if it may turn away from that.
  double least() const { return least_; }
  /// Returns the turning at the corners, a lower bound of the largest over the piece.
  AtCorners at_corners() const {
    AtCorners corners;
    const int m = net_.rows - 1, n = net_.columns - 1;
    for (int i = 0; i <= m; i += std::max(m, 1))
      for (int j = 0; j <= n; j += std::max(n, 1)) {
        const Vec3 normal = net_.point(i, j);
        const double size = dot(normal, normal);
        if (!(size > rounding_ * rounding_)) continue;
        const int i1 = i == 0 ? std::min(1, m) : m - 1, j1 = j == 0 ? std::min(1, n) : n - 1;
        const double u = m * scale_.u * length(cross(normal, net_.point(i1, j))) / size,
                     v = n * scale_.v * length(cross(normal, net_.point(i, j1))) / size;
        corners.most = {std::max(corners.most.u, u), std::max(corners.most.v, v)};
        corners.least = {std::min(corners.least.u, u), std::min(corners.least.v, v)};
      }
    return corners;
  }

 private:
  /// Bounds |d across the axis| + |d along it| sin phi over the differences d of points `step` apart in rows of `row`
  /// points. With lengths a and b and a sine s, a + s b is at most the root of (1 + s) (a^2 + s b^2), and at most the
  /// sum of the largest of each.
  double largest_difference(int step, int row) const {
    const double *const x = net_.at[0], *const y = net_.at[1], *const z = net_.at[2];
    const int count = net_.count() - step;
    if (count <= 0) return 4 * rounding_;
    if (row == 1) return 4 * rounding_ * (1 + 0x1p-40);  // points of different rows
    double *const across = scratch_.first, *const along = scratch_.second, *const both = scratch_.third;
    for (int k = 0; k < count; ++k) {
      const double dx = x[k + step] - x[k], dy = y[k + step] - y[k], dz = z[k + step] - z[k];
      const double b = axis_.x * dx + axis_.y * dy + axis_.z * dz;
      const double px = dx - b * axis_.x, py = dy - b * axis_.y, pz = dz - b * axis_.z;
      across[k] = px * px + py * py + pz * pz;
      along[k] = b * b;
      both[k] = across[k] + sine_ * along[k];
    }
    for (int end = row - 1; end < count; end += row) across[end] = along[end] = both[end] = 0;  // to the next row
    const double a = std::sqrt(largest(across, count)), b = std::sqrt(largest(along, count)),
                 most = std::min(a + sine_ * b, std::sqrt((1 + sine_) * largest(both, count)));
    return (most + 4 * rounding_) * (1 + 0x1p-40);
  }

  const NormalPiece& net_;
  const Scratch& scratch_;
  Turning scale_;
  double rounding_;
  Vec3 axis_;
  double least_, sine_;
};

}  // namespace

/// Finds the bounds over all rectangles.
class TurningSearch {
 public:
  TurningSearch(const NormalNet& normal, double angle, TurningBound& bound)
      : angle_(angle),
        rows_(normal.net.degree_u + 1),
        columns_(normal.net.degree_v + 1),
        memory_(std::make_unique_for_overwrite<double[]>(size_of_net() * (4 * max_depth + 2))),
        bound_(bound) {
    double* const start = memory_.get() + size_of_net() * (4 * max_depth + 1);
    scratch_ = {start, start + rows_ * columns_, start + 2 * rows_ * columns_};
    const NormalPiece whole = net(0, 0, rows_, columns_);
    for (int k = 0; k < whole.count(); ++k) {
      const Vec3& n = normal.net.at[static_cast<std::size_t>(k)];
      whole.at[0][k] = n.x, whole.at[1][k] = n.y, whole.at[2][k] = n.z;
    }
    visit(whole, {.rounding = normal.rounding});
  }

 private:
  std::size_t size_of_net() const { return 3 * static_cast<std::size_t>(rows_ * columns_); }
  /// The memory of piece `quarter` at a depth; at depth 0 there is one piece. It has room for `rows_` and `columns_`.
  NormalPiece net(int depth, int quarter, int rows, int columns) const {
    const std::size_t place = depth == 0 ? 0 : static_cast<std::size_t>(4 * (depth - 1) + quarter + 1);
    double* const start = memory_.get() + size_of_net() * place;
    return {rows, columns, {start, start + rows_ * columns_, start + 2 * rows_ * columns_}};
  }

  /// The place of a piece: one of 2^depth parts along each parameter.
  struct Place {
    int level = 0;  ///< how often the patch was cut
    int depth_u = 0, depth_v = 0;
    int i = 0, j = 0;                           ///< among those of its depth
    bool is_flat_u = false, is_flat_v = false;  ///< whether the normal does not turn there, so that nothing is cut
    double rounding = 0;                        ///< the largest error of a control point
  };

  void visit(const NormalPiece& net, Place at) {
    if (!bound_.is_finite_) return;
    const Turning scale{std::ldexp(1, at.depth_u), std::ldexp(1, at.depth_v)};
    const Piece piece(net, scale, at.rounding, scratch_);
    const Turning bound = piece.bound();
    const AtCorners corners = piece.at_corners();
    if (std::max(corners.most.u, corners.most.v) > max_turning) bound_.is_finite_ = false;
    const Turning& known =
        known_[at.i >> std::max(at.depth_u - rectangle_depth, 0)][at.j >> std::max(at.depth_v - rectangle_depth, 0)];
    const bool is_small = bound.u / scale.u + bound.v / scale.v <= few_cells * angle_;
    if (at.level == max_depth || is_small || !is_worth_cutting(at.level, bound, corners, known)) {
      take(bound, at);
      return;
    }
    at.is_flat_u = at.is_flat_u || bound.u <= negligible;
    at.is_flat_v = !at.is_flat_u && (at.is_flat_v || bound.v <= negligible);
    cut_and_visit(net, at, negligible_move * angle_ * piece.least());
  }

  /// Visits the parts of a piece: halves if the normal turns along one parameter alone, else quarters. `free_move`: how
  /// far control points may move.
  void cut_and_visit(const NormalPiece& net, Place at, double free_move) {
    NormalPiece part[4];
    part[3] = lowered(net, at, free_move);
    for (int k = 0; k < 3; ++k) part[k] = this->net(at.level + 1, k, part[3].rows, part[3].columns);
    const bool cuts_u = !at.is_flat_u, cuts_v = !at.is_flat_v;
    if (cuts_u) cut(part[3], part[1], true);
    if (cuts_u && cuts_v) cut(part[1], part[0], false);
    if (cuts_v) cut(part[3], part[2], false);
    for (int k = 0; k < 4; ++k) {
      if ((!cuts_u && k < 2) || (!cuts_v && k % 2 == 0)) continue;
      Place next = at;
      ++next.level;
      if (cuts_u) ++next.depth_u, next.i = 2 * at.i + k / 2;
      if (cuts_v) ++next.depth_v, next.j = 2 * at.j + k % 2;
      visit(part[k], next);
    }
  }

  /// Copies a piece to the last one of the next depth, with about half the degrees if that moves it little: cutting and
  /// looking at it takes as long as it has points. The error counts as rounding of `at`, times the ratio of degrees, as
  /// the field's derivatives may differ by the higher degree times it.
  NormalPiece lowered(const NormalPiece& net, Place& at, double free_move) {
    const auto lower = [](int count) { return count > 8 ? count / 2 + 1 : count; };
    const int rows = lower(net.rows), columns = lower(net.columns);
    if (net.count() > many_points && net.rows > 1 && net.columns > 1) {
      const NormalPiece made = this->net(at.level + 1, 3, rows, columns);
      const NetReduction reduction(reduction_of(net.rows, rows), reduction_of(net.columns, columns));
      double moved = 0;
      for (int c = 0; c < 3; ++c) moved = std::max(moved, reduction.apply(net.at[c], made.at[c], scratch_.first));
      const double ratio = std::max((net.rows - 1.0) / (rows - 1), (net.columns - 1.0) / (columns - 1)),
                   rounding = ratio * (at.rounding + 1.75 * moved);  // 1.75 > sqrt(3)
      if (rounding <= free_move) {
        at.rounding = rounding;
        return made;
      }
    }
    const NormalPiece copy = this->net(at.level + 1, 3, net.rows, net.columns);
    for (int c = 0; c < 3; ++c) std::copy_n(net.at[c], net.count(), copy.at[c]);
    return copy;
  }
  const DegreeReduction& reduction_of(int count, int lower) {
    for (const DegreeReduction& known : reductions_)
      if (known.from() == count - 1 && known.to() == lower - 1) return known;
    return reductions_.emplace_back(count - 1, lower - 1);
  }

  /// Whether smaller pieces may have bounds that save cells.
  bool is_worth_cutting(int depth, const Turning& bound, const AtCorners& corners, const Turning& known) const {
    const auto is_loose = [&](double of, double most, double had) {
      return of > std::max({close_enough * most, had, negligible});
    };
    if (depth >= rectangle_depth)
      return is_loose(bound.u, corners.most.u, known.u) || is_loose(bound.v, corners.most.v, known.v);
    const auto is_uneven = [&](double of, double least) { return of > negligible && least < varied * of; };
    return is_uneven(bound.u, corners.least.u) || is_uneven(bound.v, corners.least.v) ||
           is_loose(bound.u, corners.most.u, 0) || is_loose(bound.v, corners.most.v, 0);
  }

  /// Raises the bounds of the rectangles that the piece lies in, or that lie in it.
  void take(const Turning& bound, const Place& at) {
    if (!(std::max(bound.u, bound.v) <= max_turning)) bound_.is_finite_ = false;
    if (!bound_.is_finite_) return;
    const auto first = [](int k, int depth) {
      return depth > rectangle_depth ? k >> (depth - rectangle_depth) : k << (rectangle_depth - depth);
    };
    const auto count = [](int depth) { return 1 << std::max(rectangle_depth - depth, 0); };
    const int i = first(at.i, at.depth_u), j = first(at.j, at.depth_v);
    const float u = rounded_up(bound.u), v = rounded_up(bound.v);
    for (int k = i; k < i + count(at.depth_u); ++k)
      for (int l = j; l < j + count(at.depth_v); ++l) {
        const std::size_t rectangle = TurningBound::at(k, l);
        bound_.u_[rectangle] = std::max(bound_.u_[rectangle], u);
        bound_.v_[rectangle] = std::max(bound_.v_[rectangle], v);
        known_[k][l] = {bound_.u_[rectangle], bound_.v_[rectangle]};
      }
  }

  double angle_;
  int rows_, columns_;
  std::unique_ptr<double[]> memory_;
  Scratch scratch_;
  Turning known_[TurningBound::parts][TurningBound::parts];
  std::deque<DegreeReduction> reductions_;  ///< as they come to be needed
  TurningBound& bound_;
};

TurningBound::TurningBound(const BezierPatch& patch, double angle) {
  TurningSearch(normal_net(patch), angle, *this);
  largest_ = rounded_up(double(*std::max_element(u_.begin(), u_.end())) + *std::max_element(v_.begin(), v_.end()));
}

bool TurningBound::is_even() const {
  const auto are_equal = [](const auto& bounds) {
    return std::all_of(bounds.begin(), bounds.end(), [&](float bound) { return bound == bounds[0]; });
  };
  return are_equal(u_) && are_equal(v_);
}

double TurningBound::without_rounding(double angle) const { return angle - (0x1p-24 * double(largest_) + 0x1p-21); }

double TurningBound::angle(PatchSegments segments) const {
  double step[2][parts], most = 0;
  for (int e = 0; e < parts; ++e) {
    step[0][e] = 1 / segments.u.rate_in(e).value();
    step[1][e] = 1 / segments.v.rate_in(e).value();
  }
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < parts; ++j) most = std::max(most, step[0][i] * u(i, j) + step[1][j] * v(i, j));
  return (1 + 0x1p-40) * most + (0x1p-24 * double(largest_) + 0x1p-21);
}

}}  // namespace tessera::abi_0_1
