#include "trim/grid_loops.h"

#include <cmath>
#include <string>
#include <utility>

#include "convert/fit/cubic_fit.h"
#include "surface/quadric/quadric_profile.h"
#include "tessera/convert.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double tolerance = 1e-9;  // of the ranges
constexpr double max_ranges = 64;

/// The map of canonical parameters to those of the grid.
class ToGrid {
 public:
  explicit ToGrid(const QuadricPiece& piece) : profile_(profiles(piece.quadric().kind())), range_(piece.range()) {}

  bool is_identity() const { return !is_arc(profile_.u) && !is_arc(profile_.v); }

  /// Maps a curve. `keeps_pace`: its points keep their parameters.
  Result<Curve> mapped(const Curve& curve, bool keeps_pace) const {
    const Result<BezierPieces> pieces = to_bezier(curve);
    if (!pieces) return pieces.status();
    return stays_straight(*pieces, keeps_pace) ? mapped_points(*pieces) : fitted(*pieces);
  }

  bool is_near(const Vec3& p, const Vec3& q, double share) const {
    return std::abs(p.x - q.x) <= share * (range_.u1 - range_.u0) &&
           std::abs(p.y - q.y) <= share * (range_.v1 - range_.v0);
  }

 private:
  /// Whether a curve consists of lines along the parameters. Along an arc, these change their pace.
  bool stays_straight(const BezierPieces& pieces, bool keeps_pace) const {
    if (pieces.degree != 1 || !pieces.weights.empty()) return false;
    for (std::size_t k = 0; k + 1 < pieces.points.size(); ++k) {
      const bool moves_u = pieces.points[k].x != pieces.points[k + 1].x,
                 moves_v = pieces.points[k].y != pieces.points[k + 1].y;
      if (moves_u && moves_v) return false;
      if (keeps_pace && ((moves_u && is_arc(profile_.u)) || (moves_v && is_arc(profile_.v)))) return false;
    }
    return true;
  }

  Result<Curve> mapped_points(const BezierPieces& pieces) const {
    std::vector<Vec3> points;
    for (const Vec3& p : pieces.points) points.push_back({u(p.x).value, v(p.y).value, 0});
    std::vector<double> knots{pieces.breaks.front()};
    knots.insert(knots.end(), pieces.breaks.begin(), pieces.breaks.end());
    knots.push_back(pieces.breaks.back());
    return Curve::b_spline(1, points, knots);
  }

  Result<Curve> fitted(const BezierPieces& pieces) const {
    CubicFit fit;
    const auto near = [&](const Vec3& p, const Vec3& q) { return is_near(p, q, tolerance); };
    const auto degree = static_cast<std::size_t>(pieces.degree);
    for (std::size_t k = 0; k + 1 < pieces.breaks.size(); ++k) {
      const Interval range{pieces.breaks[k], pieces.breaks[k + 1]};
      const auto part = [&](const auto& values) { return std::span(values).subspan(k * degree, degree + 1); };
      const Result<Curve> piece = pieces.weights.empty()
                                      ? Curve::bezier(part(pieces.points), {}, range)
                                      : Curve::bezier(part(pieces.points), part(pieces.weights), range);
      if (!piece) return piece.status();
      fit.follow([&](double t) { return sample(*piece, t); }, near, range.from, range.to);
    }
    return std::move(fit).curve();
  }

  CurveSample sample(const Curve& curve, double t) const {
    const CurveJet jet = evaluate_jet(curve, t);
    const GridParameter x = u(jet.position.x), y = v(jet.position.y);
    return {t, {x.value, y.value, 0}, {x.slope * jet.first.x, y.slope * jet.first.y, 0}};
  }

  GridParameter u(double t) const { return grid_parameter(profile_.u, range_.u0, range_.u1, t); }
  GridParameter v(double t) const { return grid_parameter(profile_.v, range_.v0, range_.v1, t); }

  Profiles profile_;
  Domain range_;
};

}  // namespace

Result<std::vector<TrimLoop>> grid_loops(std::span<const TrimLoop> loops, const QuadricPiece& piece) {
  return guarded([&]() -> Result<std::vector<TrimLoop>> {
    const ToGrid to_grid(piece);
    std::vector<TrimLoop> result(loops.begin(), loops.end());
    if (to_grid.is_identity()) return result;
    for (std::size_t k = 0; k < result.size(); ++k)
      for (Curve& curve : result[k].curves) {
        for (const Vec3& p : curve.points())
          if (!to_grid.is_near(p, curve.points().front(), max_ranges))
            return Status(StatusCode::unsupported,
                          "loop " + std::to_string(k) + " runs over more than 64 times the ranges of the quadric",
                          static_cast<std::ptrdiff_t>(k));
        Result<Curve> mapped = to_grid.mapped(curve, !result[k].coedges.empty());
        if (!mapped) return mapped.status();
        curve = *std::move(mapped);
      }
    return result;
  });
}

}}  // namespace tessera::abi_0_1
