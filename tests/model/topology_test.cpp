// Shapes, instances, and the edges that faces share.

#include "tessera/topology.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "join/unjoined_faces.h"
#include "support/errors.h"
#include "support/synthetic_sets.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

constexpr std::array<std::array<std::uint32_t, 4>, 6> cube_faces{
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

Vec3 corner(std::uint32_t k) { return {double(k & 1), double(k >> 1 & 1), double(k >> 2 & 1)}; }

/// A cube of bilinear faces; vertices are the bits of their coordinates. Faces 0 to 2 are trimmed along their sides,
/// the others have outlines.
Shape cube() {
  Shape shape;
  shape.name = std::string("cube");
  for (std::uint32_t k = 0; k < 8; ++k) shape.vertices.push_back({corner(k), 1e-7});
  const auto edge = [&](std::uint32_t from, std::uint32_t to) -> Coedge {
    for (std::uint32_t k = 0; k < shape.edges.size(); ++k) {
      if (shape.edges[k].start == from && shape.edges[k].end == to) return {k, false};
      if (shape.edges[k].start == to && shape.edges[k].end == from) return {k, true};
    }
    shape.edges.push_back({from, to, {0, 1}, space_line(corner(from), corner(to)), 1e-7});
    return {static_cast<std::uint32_t>(shape.edges.size() - 1), false};
  };
  for (const auto& at : cube_faces) {
    const std::vector<Vec3> points{corner(at[0]), corner(at[3]), corner(at[1]), corner(at[2])};
    TrimLoop loop;
    const std::array<Vec3, 4> uv{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    for (std::size_t k = 0; k < 4; ++k) {
      loop.curves.push_back(space_line(uv[k], uv[(k + 1) % 4]));
      loop.coedges.push_back(edge(at[k], at[(k + 1) % 4]));
    }
    ShapeFace face{{"side", value_of(BezierPatch::polynomial(1, 1, points))}};
    (shape.faces.size() < 3 ? face.trims : face.outline) = std::vector<TrimLoop>{loop};
    shape.faces.push_back(face);
  }
  shape.shells = {{{0, 1, 2, 3, 4, 5}, 0}};
  shape.solid_count = 1;
  return shape;
}

Model two_cubes() {
  Model model{"cubes", {}};
  model.shapes = {cube()};
  model.instances = {{0, 0, "left", {}, Colour{1, 0, 0}}, {0, 6, "right", Affine::translated({3, 0, 0}), {}}};
  model.surfaces = value_of(placed_faces(model.shapes, model.instances));
  return model;
}

TEST(Topology, FacesOfInstancesArePlacedAndShareTheirGeometry) {
  Model model = two_cubes();
  model.shapes[0].faces[1].placement = Affine::translated({0, 1, 0});
  model.surfaces = value_of(placed_faces(model.shapes, model.instances));
  ASSERT_EQ(model.surfaces.size(), 12u);
  EXPECT_TRUE(check_topology(model).ok());
  EXPECT_EQ(model.surfaces[6].placement, Affine::translated({3, 0, 0}));
  EXPECT_EQ(model.surfaces[7].placement, Affine::translated({3, 1, 0}));
  EXPECT_EQ(&*model.surfaces[6].trims, &*model.shapes[0].faces[0].trims);
}

TEST(Topology, EveryEdgeOfACubeIsUsedByTwoFacesInOppositeDirections) {
  const Shape shape = cube();
  ASSERT_EQ(shape.edges.size(), 12u);
  const EdgeUses uses = value_of(edge_uses(shape));
  EXPECT_EQ(uses.uses.size(), 24u);
  for (std::size_t edge = 0; edge < 12; ++edge) {
    ASSERT_EQ(uses[edge].size(), 2u);
    int sum = 0;
    for (const EdgeUse& use : uses[edge]) {
      const Coedge& coedge = edge_loops(shape.faces[use.face])[use.loop].coedges[use.curve];
      EXPECT_EQ(coedge.edge, edge);
      sum += coedge.reversed ? -1 : 1;
    }
    EXPECT_EQ(sum, 0);
    EXPECT_LT(uses[edge][0].face, uses[edge][1].face);
  }
  EXPECT_EQ(value_of(edge_uses({})).uses.size(), 0u);
}

TEST(Topology, ShellsWithoutFreeEdgesAreClosed) {
  Shape shape = cube();
  shape.shells = {{{0, 1, 2, 3, 4, 5}, 0}, {{0, 1, 2, 3, 4}}, {{}}, {{0, 1, 2, 3, 4, 5}, 0}, {{0, 0}}};
  EXPECT_EQ(value_of(closed_shells(shape)), (std::vector<bool>{true, false, false, true, true}));
  shape.faces[4].outline = {};
  EXPECT_EQ(value_of(closed_shells(shape))[0], false);
  Shape open = cube();
  open.shells = {{{0, 1, 2, 3, 4}}};
  for (BrepEdge& edge : open.edges) edge.degenerate = true;
  EXPECT_EQ(value_of(closed_shells(open))[0], true);
}

TEST(Topology, GapsAreTheDistancesOfFacesAtEqualParameters) {
  Shape shape = cube();
  for (const double gap : value_of(edge_gaps(shape))) EXPECT_EQ(gap, 0);
  shape.faces[5].placement = Affine::translated({0, 0, 0.25});
  const std::vector<double> gaps = value_of(edge_gaps(shape, 2));
  EXPECT_EQ(std::count(gaps.begin(), gaps.end(), 0.25), 4);
  EXPECT_EQ(std::count(gaps.begin(), gaps.end(), 0.0), 8);
  expect_refused(edge_gaps(shape, 1), StatusCode::invalid_argument, Status::no_index, "at least 2 samples, not 1");
}

/// A quarter disc in a plane and a quarter of a cylinder's wall. They meet along a circle, whose angle is divided into
/// one arc in the plane, and into arcs of 30 and 60 degrees on the wall.
TEST(Topology, AParameterCurvePairsArcsThatAreDividedDifferently) {
  const double half = std::sqrt(0.5), turn = std::numbers::pi / 2;
  const auto stereographic = [](double angle, double from, double to) {
    const double h = (to - from) / 2, m = (to + from) / 2;
    return m + h * std::tan((angle - m) / 2) / std::tan(h / 2);
  };
  const Curve arc =
      value_of(Curve::nurbs(2, std::vector<Vec3>{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, std::vector<double>{1, half, 1},
                            std::vector<double>{0, 0, 0, turn, turn, turn}));
  const double third = turn / 3, a = std::cos(turn / 6), b = std::cos(turn / 3);
  const auto on_circle = [](double angle, double radius) {
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), 0};
  };
  std::vector<Vec3> points;
  std::vector<double> weights;
  const std::array<std::pair<Vec3, double>, 5> row{{{on_circle(0, 1), 1},
                                                    {on_circle(third / 2, 1 / a), a},
                                                    {on_circle(third, 1), 1},
                                                    {on_circle(2 * third, 1 / b), b},
                                                    {on_circle(turn, 1), 1}}};
  for (const auto& [p, w] : row)
    for (const double z : {0.0, 1.0}) {
      points.push_back(p + Vec3{0, 0, z});
      weights.push_back(w);
    }
  const std::vector<double> knots{0, 0, 0, third, third, turn, turn, turn}, across{0, 0, 1, 1};
  const std::vector<Vec3> square{{-2, -2, 0}, {-2, 2, 0}, {2, -2, 0}, {2, 2, 0}};
  const std::vector<double> plane_knots{-2, -2, 2, 2};
  // At the edge's parameter s, which is that of the arc in the plane: t = s' on the wall, in two Moebius pieces.
  std::vector<Vec3> t_points;
  std::vector<double> t_weights, t_knots;
  double weight = 1;
  const std::array<double, 3> ends{0, third, turn};
  const auto s_of = [&](double angle) { return stereographic(angle, 0, turn); };
  for (std::size_t k = 0; k < 3; ++k) {
    t_points.push_back({ends[k], 0, 0});
    t_weights.push_back(weight);
    t_knots.insert(t_knots.end(), k == 1 ? 1 : 2, s_of(ends[k]));
    if (k == 2) break;
    const double middle = 0.5 * (s_of(ends[k]) + s_of(ends[k + 1]));
    const double angle = turn / 2 + 2 * std::atan(std::tan(turn / 4) * (middle - turn / 2) / (turn / 2));
    const double t = stereographic(angle, ends[k], ends[k + 1]);
    weight *= (t - ends[k]) / (ends[k + 1] - t);
  }
  Shape shape;
  shape.edges.push_back({no_id, no_id, {0, turn}, arc});
  const Curve side =
      value_of(Curve::b_spline(1, std::vector<Vec3>{{0, 0, 0}, {turn, 0, 0}}, std::vector<double>{0, 0, turn, turn}));
  TrimLoop in_plane{{arc}, false, {{0, false}}}, on_wall{{side}, false, {{0, false, {}}}};
  shape.faces.push_back({{"plane",
                          value_of(BSplineSurface::polynomial(1, plane_knots, 1, plane_knots, square)),
                          {},
                          std::vector{in_plane}}});
  shape.faces.push_back(
      {{"wall", value_of(BSplineSurface::rational(2, knots, 1, across, points, weights))}, std::vector{on_wall}});
  EXPECT_GT(value_of(edge_gaps(shape, 33))[0], 1e-3);
  on_wall.coedges[0].parameter = value_of(Curve::nurbs(1, t_points, t_weights, t_knots));
  shape.faces[1].outline = std::vector{on_wall};
  EXPECT_LT(value_of(edge_gaps(shape, 33))[0], 1e-15);
}

/// A loop may cross the seam of a closed surface; a seam's two curves lie on its two sides.
TEST(Topology, LoopsBeyondTheDomainOfAClosedSurfaceAreMeasuredWithinIt) {
  const BSplineSurface ball = value_of(make_nurbs_sphere({}, 2));
  const Domain d = ball.domain();
  const double width = d.u1 - d.u0;
  const auto across = [&](double shift) {
    return TrimLoop{
        {space_line({d.u_at(0.75) + shift, d.v_at(0.5), 0}, {d.u_at(1.25) + shift, d.v_at(0.5), 0})}, false, {{0}}};
  };
  Shape shape;
  shape.edges.resize(1);
  for (const double turns : {0.0, -1.0, 2.0})
    shape.faces.push_back({{"ball", ball, {}, std::vector<TrimLoop>{across(turns * width)}}});
  EXPECT_LT(value_of(edge_gaps(shape, 9))[0], 1e-14);
  shape.faces[1].trims = std::vector<TrimLoop>{across(0.25 * width)};
  EXPECT_GT(value_of(edge_gaps(shape, 9))[0], 1);
}

TEST(Topology, UsesOfEdgesThatAShapeDoesNotHaveAreRefused) {
  Shape shape = cube();
  shape.edges.resize(7);
  EXPECT_EQ(edge_uses(shape).status().code(), StatusCode::invalid_argument);
  EXPECT_NE(edge_uses(shape).status().message().find(", there are 7 edges"), std::string::npos);
  EXPECT_FALSE(closed_shells(shape).ok());
  EXPECT_FALSE(edge_gaps(shape).ok());
  shape = cube();
  shape.shells[0].faces[2] = 6;
  EXPECT_EQ(closed_shells(shape).status().code(), StatusCode::invalid_argument);
}

TEST(Topology, IdsOfNothingAreRefused) {
  const auto refused = [](auto damage, std::ptrdiff_t index, const std::string& words) {
    Model model = two_cubes();
    damage(model);
    expect_refused(Result<int>(check_topology(model)), StatusCode::invalid_argument, index, words);
  };
  refused([](Model& m) { m.shapes[0].edges[3].end = 8; }, 0,
          "shape 0 (cube): edge 3 ends at vertex 8, there are 8 vertices");
  refused([](Model& m) { m.shapes[0].vertices[3].position.y = not_a_number; }, 0,
          "shape 0 (cube): vertex 3 is not finite");
  refused([](Model& m) { m.shapes[0].edges[3].tolerance = -1; }, 0, "shape 0 (cube): edge 3 has the tolerance -1");
  refused([](Model& m) { m.shapes[0].edges[3].range.to = infinity; }, 0, "shape 0 (cube): edge 3 has the range from 0");
  refused([](Model& m) { m.shapes[0].edges[3].range = {1, 1}; }, 0, "shape 0 (cube): edge 3 has the range from 1 to 1");
  refused([](Model& m) { m.shapes[0].shells[0].faces[2] = 6; }, 0,
          "shape 0 (cube): shell 0 has face 6, there are 6 faces");
  refused([](Model& m) { m.shapes[0].shells[0].solid = 1; }, 0,
          "shape 0 (cube): shell 0 is of solid 1, there is 1 solid");
  refused([](Model& m) { m.instances[1].shape = 1; }, 1, "instance 1 (right): it is of shape 1, there is 1 shape");
  refused([](Model& m) { m.instances[1].first_surface = 5; }, 1,
          "instance 1 (right): its 6 faces begin at surface 5, they must begin at surface 6 of 12");
  refused([](Model& m) { m.surfaces.pop_back(); }, 1, "they must begin at surface 6 of 11");
  refused([](Model& m) { m.surfaces.push_back(m.surfaces[0]); }, Status::no_index,
          "the instances have 12 faces, the model has 13 surfaces");
  const auto with_loop = [&](auto damage, const std::string& words) {
    refused(
        [&](Model& m) {
          std::vector<TrimLoop> loops = m.shapes[0].faces[2].trims;
          damage(loops[0]);
          m.shapes[0].faces[2].trims = loops;
        },
        0, words);
  };
  with_loop([](TrimLoop& loop) { loop.coedges.pop_back(); },
            "shape 0 (cube): face 2, loop 0 has 3 coedges for 4 curves");
  with_loop([](TrimLoop& loop) { loop.coedges[1].edge = 12; },
            "shape 0 (cube): face 2, loop 0 uses edge 12, there are 12 edges");
  with_loop([](TrimLoop& loop) { loop.coedges[1].edge = no_id; }, "uses edge 4294967295");
  // A table of the parameter: values at s = 0, 1/2 and 1, over `range`.
  const auto with_table = [&](std::size_t coedge, const std::array<double, 3>& t, const std::string& words,
                              const Interval& range = {0, 1}) {
    const std::vector<Vec3> values{{t[0], 0, 0}, {t[1], 0, 0}, {t[2], 0, 0}};
    const double middle = (range.from + range.to) / 2;
    const std::vector<double> knots{range.from, range.from, middle, range.to, range.to};
    with_loop(
        [&](TrimLoop& loop) {
          ASSERT_EQ(loop.coedges[coedge].reversed, coedge == 2);
          loop.coedges[coedge].parameter = value_of(Curve::b_spline(1, values, knots));
        },
        "shape 0 (cube): face 2, loop 0, coedge " + std::to_string(coedge) + ": its parameter " + words);
  };
  with_table(1, {0, 0.7, 0.6}, "must grow along the edge, it goes from 0.7 to 0.6");
  with_table(2, {0, 0.3, 1}, "must fall along the edge, it goes from 0 to 0.3");
  with_table(1, {0.5, 0.5, 0.5}, "is 0.5 everywhere");
  with_table(1, {0, 0.5, 1}, "is stated from 0.1 to 1, the edge's range is from 0 to 1", {0.1, 1});
  with_table(1, {0, 0.5, 1}, "is stated from 0 to 0.5, the edge's range is from 0 to 1", {0, 0.5});
  with_table(1, {0, 0.5, 1.1}, "is 1.1 at 1, the curve's domain is from 0 to 1");
  with_table(2, {1, 0.5, -0.1}, "is -0.1 at 1, the curve's domain is from 0 to 1");
  with_loop(
      [](TrimLoop& loop) {
        loop.coedges[1].parameter = value_of(Curve::bezier(std::vector<Vec3>{{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}}));
      },
      "coedge 1: its parameter is of degree 2, it must be of degree 1");
  Shape stated = cube();
  std::vector<TrimLoop> loops = stated.faces[2].trims;
  for (Coedge& coedge : loops[0].coedges)
    coedge.parameter = space_line({coedge.reversed ? 1.0 : 0.0, 0, 0}, {coedge.reversed ? 0.0 : 1.0, 0, 0});
  stated.faces[2].trims = loops;
  EXPECT_TRUE(check_topology(stated).ok()) << check_topology(stated).message();
  const Model model = two_cubes();
  const std::vector<Instance> wrong{{2}};
  expect_refused(placed_faces(model.shapes, wrong), StatusCode::invalid_argument, 0, "instance 0: it is of shape 2");
}

}}  // namespace tessera::test
