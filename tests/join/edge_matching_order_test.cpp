// Matching of edges: any order of faces, edges that are joined already, loops of any division, bad input.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <sstream>

#include "join/unjoined_faces.h"
#include "support/errors.h"
#include "tessera/coons_patch.h"
#include "tessera/nurbs_surface.h"
#include "tessera/parametric_surface.h"

namespace tessera::test { namespace {

void append(std::ostream& out, const Curve& curve) {
  for (const Vec3& p : curve.points()) out << p.x << ' ' << p.y << ' ' << p.z << ' ';
  for (const double weight : curve.weights()) out << weight << ' ';
  for (const double knot : curve.knots()) out << knot << ' ';
  out << '[' << curve.domain().from << ' ' << curve.domain().to << ']';
}

/// All that is known of each edge, to the last bit; faces by their names.
std::multiset<std::string> facts_of(const Shape& shape) {
  std::multiset<std::string> all;
  const EdgeUses uses = value_of(edge_uses(shape));
  for (std::size_t k = 0; k < shape.edges.size(); ++k) {
    const BrepEdge& edge = shape.edges[k];
    std::ostringstream text;
    text << std::hexfloat << edge.range.from << ' ' << edge.range.to << ' ' << edge.degenerate;
    for (const std::uint32_t end : {edge.start, edge.end}) {
      const Vec3& p = shape.vertices[end].position;
      text << " (" << p.x << ' ' << p.y << ' ' << p.z << ')';
    }
    std::multiset<std::string> curves;
    for (const EdgeUse& use : uses[k]) {
      const ShapeFace& face = shape.faces[use.face];
      const TrimLoop& loop = edge_loops(face)[use.loop];
      std::ostringstream curve;
      curve << std::hexfloat << *face.name << (loop.coedges[use.curve].reversed ? " back " : " forth ");
      append(curve, loop.curves[use.curve]);
      if (loop.coedges[use.curve].parameter) append(curve, *loop.coedges[use.curve].parameter);
      curves.insert(curve.str());
    }
    for (const std::string& curve : curves) text << "; " << curve;
    all.insert(text.str());
  }
  return all;
}

/// A field of curved faces whose borders are apart by up to `gap`, of several degrees and parametrizations.
std::vector<ModelSurface> frayed_field(int n, double gap, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> fray(-0.28 * gap, 0.28 * gap), weight(0.5, 2);
  std::vector<ModelSurface> faces;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      const int degree = 2 + (a + b) % 2;
      std::vector<Vec3> points;
      std::vector<double> weights;
      const double ratio = weight(random), other = weight(random);
      const Vec3 shift{fray(random), fray(random), fray(random)};
      for (int i = 0; i <= degree; ++i)
        for (int j = 0; j <= degree; ++j) {
          const double x = a + double(i) / degree, y = b + double(j) / degree;
          points.push_back(Vec3{x, y, 0.2 * a * b + 0.2 * (a * (y - b) + b * (x - a)) + 0.2 * (x - a) * (y - b)} +
                           shift);
          weights.push_back(std::pow(ratio, i) * std::pow(other, j));
        }
      // Weights in powers change the pace, not the surface, which is bilinear.
      faces.push_back(
          {"face " + std::to_string(faces.size()), value_of(BezierPatch::rational(degree, degree, points, weights))});
    }
  return faces;
}

TEST(EdgeMatchingOrder, AnyOrderOfFacesGivesTheSameEdges) {
  std::vector<std::vector<ModelSurface>> models{frayed_field(4, 1e-3, 3), one_against_three(0.3, 0.7, 5e-4),
                                                one_against_three(0.5, 0.5004), cube()};
  models.push_back({quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), quad({1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}),
                    quad({1, 0, 1e-4}, {1, 0, 1}, {1, 1, 1}, {1, 1, 1e-4}),
                    quad({1, 0, 4e-4}, {1, 0, -1}, {1, 1, -1}, {1, 1, 4e-4})});
  std::mt19937 random(7);
  for (std::vector<ModelSurface>& faces : models) {
    for (std::size_t k = 0; k < faces.size(); ++k) faces[k].name = "face " + std::to_string(k);
    const std::multiset<std::string> expected = facts_of(joined(faces, 1e-3));
    for (int trial = 0; trial < 12; ++trial) {
      std::shuffle(faces.begin(), faces.end(), random);
      ASSERT_EQ(facts_of(joined(faces, 1e-3)), expected);
    }
  }
}

TEST(EdgeMatchingOrder, FrayedFieldsAreJoined) {
  for (const double gap : {1e-9, 1e-6, 1e-3})
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
      constexpr std::size_t n = 8;
      const Shape shape = joined(frayed_field(n, gap, seed), gap);
      EXPECT_EQ(counts_of(shape), (Counts{{1, 4 * n}, {2, 2 * n * (n - 1)}})) << gap;
      EXPECT_EQ(shape.vertices.size(), (n + 1) * (n + 1));
      EXPECT_EQ(shape.shells.size(), 1u);
      EXPECT_LT(largest_gap(shape), gap + 1e-8) << gap;
    }
}

TEST(EdgeMatchingOrder, EdgesThatAreJoinedStay) {
  std::vector<ModelSurface> faces = cube();
  const ModelSurface last = faces.back();
  faces.pop_back();
  Shape open = joined(faces, 1e-3);
  ASSERT_EQ(counts_of(open), (Counts{{1, 4}, {2, 8}}));
  const std::multiset<std::string> before = facts_of(open);
  EXPECT_EQ(facts_of(value_of(joined_edges(open, 1e-3))), before);
  for (BrepEdge& edge : open.edges) edge.tolerance = 0.125;
  open.faces.push_back({last});
  const Shape closed = value_of(joined_edges(open, 1e-3));
  EXPECT_EQ(counts_of(closed), (Counts{{2, 12}}));
  EXPECT_EQ(closed.vertices.size(), 8u);
  EXPECT_EQ(closed.solid_count, 1u);
  for (const BrepEdge& edge : closed.edges) EXPECT_EQ(edge.tolerance, 0.125);
  EXPECT_EQ(facts_of(value_of(joined_edges(closed, 1e-3))), facts_of(closed));
}

/// Edges with curves, reversed coedges and parameters of their own keep these when they are divided.
TEST(EdgeMatchingOrder, DividedEdgesKeepTheirCurves) {
  const std::vector<ModelSurface> faces = one_against_three(0.3, 0.7);
  for (const bool reversed : {false, true})
    for (const bool with_table : {false, true}) {
      Shape shape;
      for (const ModelSurface& face : faces) shape.faces.push_back({face});
      const Curve side = space_line({1, 0, 0}, {1, 1, 0});
      // The face's curve is as long as 2; edges run from 1 to 3.
      const Curve in_face = value_of(Curve::bezier(std::vector<Vec3>{{1, 0, 0}, {1, 1, 0}}, {}, {1, 3}));
      shape.vertices = {{{1, 0, 0}, 1e-5}, {{1, 1, 0}, 2e-5}};
      BrepEdge edge{0, 1, {1, 3}, {}, 1e-6, false, true};
      std::vector<Vec3> ends{side.points()[0], side.points()[1]};
      Coedge coedge{0, reversed, {}};
      if (reversed) std::swap(ends[0], ends[1]), std::swap(edge.start, edge.end);
      edge.curve = value_of(Curve::bezier(ends, {}, {1, 3}));
      if (with_table) {
        const std::vector<Vec3> t =
            reversed ? std::vector<Vec3>{{3, 0, 0}, {1, 0, 0}} : std::vector<Vec3>{{1, 0, 0}, {3, 0, 0}};
        coedge.parameter = value_of(Curve::bezier(t, {}, {1, 3}));
      }
      shape.edges.push_back(edge);
      TrimLoop loop{{in_face}, false, {coedge}};
      for (const auto& [from, to] : {std::pair(Vec3{1, 1, 0}, Vec3{0, 1, 0}), std::pair(Vec3{0, 1, 0}, Vec3{0, 0, 0}),
                                     std::pair(Vec3{0, 0, 0}, Vec3{1, 0, 0})}) {
        loop.curves.push_back(space_line(from, to));
        loop.coedges.push_back({static_cast<std::uint32_t>(shape.edges.size())});
        shape.edges.push_back({});
      }
      shape.faces[0].outline = std::vector<TrimLoop>{loop};
      const Shape made = value_of(joined_edges(shape, 1e-3));
      EXPECT_EQ(counts_of(made), (Counts{{1, 8}, {2, 5}}));
      EXPECT_LT(largest_gap(made), 1e-14);
      std::size_t with_curve = 0;
      for (const BrepEdge& e : made.edges) {
        if (!e.curve) continue;
        ++with_curve;
        EXPECT_LT(length(position(*e.curve, e.range.from) - made.vertices[e.start].position), 1e-14);
        EXPECT_LT(length(position(*e.curve, e.range.to) - made.vertices[e.end].position), 1e-14);
      }
      EXPECT_LE(with_curve, 3u);
    }
}

/// Curves that an edge states decide, where the faces are farther apart.
TEST(EdgeMatchingOrder, StatedCurvesAreMatchedFirst) {
  Shape shape;
  for (const double gap : {0.0, 0.01}) {
    shape.faces.push_back({gap == 0 ? quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0})
                                    : quad({1 + gap, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1 + gap, 1, 0})});
    const double u = gap == 0 ? 1 : 0;
    const auto id = static_cast<std::uint32_t>(shape.edges.size());
    TrimLoop loop{{space_line({u, 0, 0}, {u, 1, 0}), space_line({u, 1, 0}, {1 - u, 1, 0}),
                   space_line({1 - u, 1, 0}, {1 - u, 0, 0}), space_line({1 - u, 0, 0}, {u, 0, 0})},
                  false,
                  {{id}, {id + 1}, {id + 2}, {id + 3}}};
    shape.edges.resize(id + 4);
    shape.edges[id].curve = space_line({1, 0, 0}, {1, 1, 0});
    shape.faces.back().outline = std::vector<TrimLoop>{loop};
  }
  const Shape made = value_of(joined_edges(shape, 1e-3));
  EXPECT_EQ(counts_of(made), (Counts{{1, 6}, {2, 1}}));
  EXPECT_NEAR(largest_gap(made), 0.01, 1e-12);
  for (BrepEdge& edge : shape.edges) edge.curve.reset();
  EXPECT_EQ(counts_of(value_of(joined_edges(shape, 1e-3))), (Counts{{1, 8}}));
}

/// Loops of one curve each, with corners, as OBJ has them; the second starts elsewhere and runs the other way.
TEST(EdgeMatchingOrder, LoopsOfOneCurveAreDividedAtCorners) {
  const auto closed = [](std::vector<Vec3> points) {
    points.push_back(points.front());
    std::vector<double> knots{0};
    for (std::size_t k = 0; k < points.size(); ++k) knots.push_back(static_cast<double>(k));
    knots.push_back(knots.back());
    return TrimLoop{{value_of(Curve::b_spline(1, points, knots))}, false, {}};
  };
  ModelSurface floor = quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}), hole = floor;
  const std::vector<Vec3> around{{0.25, 0.25, 0}, {0.5, 0.25, 0}, {0.5, 0.5, 0}, {0.25, 0.5, 0}},
      inside{{0.375, 0.25, 0}, {0.25, 0.25, 0}, {0.25, 0.5, 0}, {0.5, 0.5, 0}, {0.5, 0.25, 0}};
  TrimLoop rim = closed(inside);
  rim.hole = true;
  hole.trims = std::vector<TrimLoop>{space_polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), rim};
  floor.trims = std::vector<TrimLoop>{closed(around)};
  const Shape shape = joined({floor, hole}, 1e-3);
  EXPECT_EQ(counts_of(shape), (Counts{{1, 4}, {2, 5}}));
  EXPECT_LT(largest_gap(shape), 1e-15);
  // Alone, a loop is not divided.
  EXPECT_EQ(counts_of(joined({floor}, 1e-3)), (Counts{{1, 1}}));
}

TEST(EdgeMatchingOrder, HundredsOfEdgesInOnePlace) {
  std::vector<ModelSurface> faces(300, quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}));
  const Shape shape = joined(faces, 1e-3);
  EXPECT_EQ(counts_of(shape), (Counts{{300, 4}}));
  EXPECT_EQ(shape.vertices.size(), 4u);
}

TEST(EdgeMatchingOrder, BadInputIsRefused) {
  for (const double distance : {0.0, -1.0, not_a_number, infinity, -infinity})
    expect_refused(joined_shape(cube(), distance), StatusCode::invalid_argument, Status::no_index,
                   "must be a finite number above 0, not");
  Shape shape;
  EXPECT_TRUE(value_of(joined_edges(shape, 1)).shells.empty());
  shape.edges.push_back({3, 3});
  expect_refused(joined_edges(shape, 1), StatusCode::invalid_argument, 0, "edge 0 ends at vertex 3");
  EXPECT_EQ(counts_of(joined(cube(), 1e-300)), (Counts{{2, 12}}));
  EXPECT_EQ(counts_of(joined(cube(), 1e300)), (Counts{{0, 24}}));
  EXPECT_EQ(counts_of(joined(cube(1e200), 1e190)), (Counts{{1, 24}}));  // squares of lengths overflow: none is joined
  SurfaceFunctions functions;
  functions.position = [](double u, double v) { return Vec3{u > 0.2 && u < 0.3 ? not_a_number : u, v, 0}; };
  const std::vector<ModelSurface> failing{cube()[0], {"bad", value_of(ParametricSurface::make(functions))}};
  expect_refused(joined_shape(failing, 1e-3), StatusCode::non_finite, 1, "face 1 (bad): ");
}

}}  // namespace tessera::test
