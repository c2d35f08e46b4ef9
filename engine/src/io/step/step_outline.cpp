#include "io/step/step_outline.h"

#include <algorithm>
#include <array>
#include <utility>

#include "tessera/convert.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The border curve of a clamped surface on a side, along the growing parameter.
Result<Curve> side_curve(const BSplineSurface& s, Side side) {
  const bool along_u = side == Side::v0 || side == Side::v1, is_last = side == Side::u1 || side == Side::v1;
  const std::size_t count = along_u ? s.count_u() : s.count_v(),
                    row = is_last ? (along_u ? s.count_v() : s.count_u()) - 1 : 0;
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (std::size_t k = 0; k < count; ++k) {
    points.push_back(along_u ? s.point(k, row) : s.point(row, k));
    weights.push_back(along_u ? s.weight(k, row) : s.weight(row, k));
  }
  return Curve::nurbs(along_u ? s.degree_u() : s.degree_v(), points, weights, along_u ? s.knots_u() : s.knots_v());
}

bool is_point(const Curve& curve, double tolerance) {
  return std::ranges::all_of(curve.points(),
                             [&](const Vec3& p) { return length(p - curve.points().front()) <= tolerance; });
}

bool is_same(const Curve& a, const Curve& b, double tolerance) {
  for (std::size_t k = 0; k < a.points().size(); ++k)
    if (!(length(a.points()[k] - b.points()[k]) <= tolerance)) return false;
  return true;
}

}  // namespace

Status add_outline(StepFaceResult& face, double tolerance) {
  const Result<BSplineSurface> clamped = clamp_ends(face.surface);
  if (!clamped) return clamped.status();
  const Domain& d = face.surface.domain();
  const std::array<Vec3, 4> corners{Vec3{d.u0, d.v0, 0}, {d.u1, d.v0, 0}, {d.u1, d.v1, 0}, {d.u0, d.v1, 0}};
  constexpr std::array sides{Side::v0, Side::u1, Side::v1, Side::u0};
  std::array<std::optional<std::size_t>, 4> edge_of;  // index into own_edges
  std::vector<Curve> curves;
  TrimLoop& loop = face.loops.emplace_back();
  for (std::size_t k = 0; k < 4; ++k) {
    Result<Curve> curve = side_curve(*clamped, sides[k]);
    if (!curve) return curve.status();
    const bool backwards = k >= 2;
    const Interval range = curve->domain();
    const std::array<double, 4> knots{range.from, range.from, range.to, range.to};
    Result<Curve> line = Curve::b_spline(1, std::array{corners[k], corners[(k + 1) % 4]}, knots);
    if (!line) return line.status();
    loop.curves.push_back(*std::move(line));
    loop.coedges.push_back({no_id, backwards, {}});
    const bool is_pole = is_point(*curve, tolerance);
    if (backwards && !is_pole && is_same(curves[k - 2], *curve, tolerance)) {
      edge_of[k] = edge_of[k - 2];
    } else {
      edge_of[k] = face.own_edges.size();
      StepOwnEdge& own = face.own_edges.emplace_back();
      own.edge.degenerate = is_pole;
      own.edge.range = range;
      if (!is_pole) own.edge.curve = *curve, own.edge.same_parameter = true;
    }
    face.own_edges[*edge_of[k]].uses.push_back({face.loops.size() - 1, k});
    curves.push_back(*std::move(curve));
  }
  return {};
}

}}  // namespace tessera::abi_0_1
