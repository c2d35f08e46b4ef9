#include "trim/region_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/impl_access.h"
#include "trim/trim_region_impl.h"
#include "trim/trim_shapes.h"

namespace tessera { namespace {

using test::value_of;

/// The side of a point by all pieces, without cells.
TrimSide by_all_pieces(const TrimRegion::Impl& region, double u, double v) {
  bool inside = region.starts_inside;
  for (const TrimPiece& piece : region.pieces) {
    const PieceSide side = side_of(piece, {u, v});
    if (side == PieceSide::near) return TrimSide::border;
    inside ^= side == PieceSide::left;
  }
  return inside ? TrimSide::inside : TrimSide::outside;
}

/// Moves and scales the curves of a loop.
TrimLoop placed(const TrimLoop& loop, const Domain& domain) {
  TrimLoop moved{{}, loop.hole};
  for (const Curve& curve : loop.curves) {
    std::vector<Vec3> points;
    for (const Vec3& p : curve.points()) points.push_back({domain.u_at(p.x), domain.v_at(p.y), 0});
    moved.curves.push_back(curve.is_rational()
                               ? value_of(Curve::nurbs(curve.degree(), points, curve.weights(), curve.knots()))
                               : value_of(Curve::b_spline(curve.degree(), points, curve.knots())));
  }
  return moved;
}

/// Loops of all kinds in the unit square: splines, polygons on a coarse grid, clusters of small ones, long slivers.
std::vector<TrimLoop> random_loops(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<TrimLoop> loops;
  const int count = 1 + static_cast<int>(random() % 5);
  for (int k = 0; k < count; ++k) {
    if (random() % 3 == 0) {
      std::vector<ParameterPoint> corners;
      for (unsigned i = 0; i < 3 + random() % 20; ++i)
        corners.push_back({static_cast<double>(random() % 9) / 8, static_cast<double>(random() % 9) / 8});
      loops.push_back(test::polyline(corners));
    } else if (random() % 3 == 0) {
      const double size = std::pow(10, -6 * uniform(random)), u = uniform(random), v = uniform(random);
      const Domain cluster{u, u + size, v, v + size};
      for (int i = 0; i < 12; ++i) loops.push_back(placed(test::random_loop(random), cluster));
    } else if (random() % 4 == 0) {
      const double v = uniform(random), height = std::pow(10, -12 * uniform(random));
      loops.push_back(test::polygon({{0.01, v}, {0.99, v + height}, {0.5, v + 2 * height}}));
    } else {
      loops.push_back(test::random_loop(random));
    }
  }
  return loops;
}

/// A point anywhere, next to a piece, at the height of an end, or at an end.
ParameterPoint region_cells_random_point(std::mt19937& random, const TrimRegion::Impl& region) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const Domain& d = region.domain;
  ParameterPoint q{d.u_at(uniform(random)), d.v_at(uniform(random))};
  if (region.pieces.empty()) return q;
  const TrimPiece& piece = region.pieces[random() % region.pieces.size()];
  const unsigned kind = random() % 8;
  const double size = std::pow(10, -16 * uniform(random));
  if (kind == 0) q.v = piece.start().v;
  if (kind == 1) q = piece.end();
  if (kind >= 2 && kind < 6) {
    const ParameterPoint on = precise_point(piece.curve, uniform(random)).rounded();
    q = {on.u + size * (d.u1 - d.u0) * (uniform(random) - 0.5), on.v + size * (d.v1 - d.v0) * (uniform(random) - 0.5)};
  }
  if (kind == 6) q = {piece.start().u, d.v_at(uniform(random))};
  return q;
}

/// A box about a point, 1e-1 to 1e-12 of the domain wide, and within it.
Domain random_box(std::mt19937& random, const Domain& domain, const ParameterPoint& q) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double u = std::pow(10, -1 - 11 * uniform(random)) * (domain.u1 - domain.u0);
  const double v = std::pow(10, -1 - 11 * uniform(random)) * (domain.v1 - domain.v0);
  return {std::max(q.u - u * uniform(random), domain.u0), std::min(q.u + u * uniform(random), domain.u1),
          std::max(q.v - v * uniform(random), domain.v0), std::min(q.v + v * uniform(random), domain.v1)};
}

// Where cells tell the side of a box, each point of it has that side.
TEST(RegionCells, TellTheSidesOfBoxes) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  const Domain domains[] = {{0, 1, 0, 1}, {-3, 5, 1e4, 1e5}, {1e6, 1e6 + 1, -1e-6, 1e-6}};
  std::size_t told = 0, checked = 0;
  for (int k = 0; k < 150; ++k) {
    const Domain& domain = domains[k % 3];
    std::vector<TrimLoop> loops;
    for (const TrimLoop& loop : random_loops(random)) loops.push_back(placed(loop, domain));
    const TrimRegion region = value_of(TrimRegion::make(loops, domain));
    const TrimRegion::Impl& impl = impl_of(region);
    for (int i = 0; i < 1000; ++i) {
      const ParameterPoint q = region_cells_random_point(random, impl);
      if (!domain.contains(q.u, q.v)) continue;
      const Domain box = random_box(random, domain, q);
      ++checked;
      const TrimSide side = impl.cells.locate_all(box);
      if (side == TrimSide::border) continue;
      ++told;
      for (const double u : {box.u0, box.u1, q.u, box.u_at(uniform(random))})
        for (const double v : {box.v0, box.v1, q.v, box.v_at(uniform(random))})
          ASSERT_EQ(by_all_pieces(impl, u, v), side) << k << ": " << u << ' ' << v;
    }
  }
  EXPECT_GT(checked, 100000u);
  EXPECT_GT(told, checked / 4);
}

TEST(RegionCells, AnswerAsAllPiecesTogetherDo) {
  std::mt19937 random(1);
  const Domain domains[] = {{0, 1, 0, 1}, {-3, 5, 1e4, 1e5}, {1e6, 1e6 + 1, -1e-6, 1e-6}, {0, 6.3, -1e9, 1e9}};
  std::size_t border = 0, checked = 0;
  for (int k = 0; k < 400; ++k) {
    const Domain& domain = domains[k % 4];
    std::vector<TrimLoop> loops;
    for (const TrimLoop& loop : random_loops(random)) loops.push_back(placed(loop, domain));
    std::vector<double> breaks_u{domain.u0, domain.u1}, breaks_v = {domain.v0, domain.v1};
    if (k % 3 == 0) breaks_u.insert(breaks_u.begin() + 1, {domain.u_at(0.25), domain.u_at(0.3)});
    if (k % 5 == 0) breaks_v.insert(breaks_v.begin() + 1, domain.v_at(0.5));
    TrimOptions options{.periodic_u = k % 7 == 0, .periodic_v = k % 11 == 0};
    if (k % 6 == 5) options.snap = 1e-3;
    const TrimRegion region = value_of(TrimRegion::make(loops, breaks_u, breaks_v, options));
    for (int i = 0; i < 1000; ++i) {
      const ParameterPoint q = region_cells_random_point(random, impl_of(region));
      if (!domain.contains(q.u, q.v)) continue;
      const TrimSide expected = by_all_pieces(impl_of(region), q.u, q.v);
      ASSERT_EQ(region.locate(q.u, q.v), expected) << k << ": " << q.u << ' ' << q.v;
      border += expected == TrimSide::border;
      ++checked;
    }
  }
  EXPECT_GT(checked, 300000u);
  EXPECT_GT(border, checked / 20);
  EXPECT_LT(border, checked / 2);
}

}}  // namespace tessera
