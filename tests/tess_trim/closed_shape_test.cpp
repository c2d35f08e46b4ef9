// Meshes of shapes: closed along edges by construction, within bound and gap of the faces.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include <tbb/global_control.h>

#include "tess_trim/closed_shape.h"
#include "tessera/tessellate.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

void expect_closed(const ShapeMesh& made, const char* what) {
  EXPECT_TRUE(made.report.closed()) << what << ": " << made.report.open_edges << " open edges, "
                                    << made.report.non_manifold_edges << " of more than two triangles";
  EXPECT_EQ(made.report.inconsistent_edges, 0u) << what;
  EXPECT_EQ(made.open_edges, 0u) << what;
  EXPECT_EQ(made.report.non_finite_vertices, 0u) << what;
}

TEST(ClosedShape, DrilledPlateIsClosedAtAnyTolerance) {
  for (const double turn : {0.0, 0.7}) {
    const Shape shape = joined(drilled_plate(1.7, 1.4, 0.6, turn), 1e-6);
    ASSERT_EQ(closed_count(shape), 1u);
    for (double tolerance = 2; tolerance > 1e-6; tolerance /= 5) {
      const ShapeMesh made = mesh_of(shape, {.tolerance = tolerance});
      expect_closed(made, std::to_string(tolerance).c_str());
      EXPECT_LE(made.bound, tolerance);
      EXPECT_LT(made.gap, 1e-7);
      EXPECT_EQ(made.edge_gaps.size(), shape.edges.size());
      const auto [volume, area] = volume_and_area(made.mesh);
      EXPECT_NEAR(volume, drilled_volume(), area * (made.bound + made.gap)) << tolerance;
    }
  }
}

TEST(ClosedShape, OneCallMakesAClosedMesh) {
  const Mesh mesh = value_of(tessera::tessellate(joined(drilled_plate(), 1e-6), {.tolerance = 1e-3}));
  EXPECT_TRUE(value_of(check(mesh)).closed());
  EXPECT_EQ(mesh.parts.size(), drilled_plate().size());
  Shape broken = joined(drilled_plate(), 1e-6);
  std::vector<TrimLoop> loops = *broken.faces[0].trims;
  loops[0].curves[0] = space_line({0, 0, 0}, {1e101, 0, 0});
  broken.faces[0].trims = std::move(loops);
  EXPECT_EQ(tessera::tessellate(broken, {.tolerance = 1e-3}).status().index(), 0);
}

/// Distances of the mesh's points from the plate's faces, in closed form, for each triangle and its face.
TEST(ClosedShape, PointsLieWithinBoundAndGap) {
  const std::vector<ModelSurface> faces = drilled_plate();
  const Shape shape = joined(faces, 1e-6);
  for (const double tolerance : {0.2, 0.01, 1e-4}) {
    ShapeMesh made = mesh_of(shape, {.tolerance = tolerance});
    double largest = 0;
    const auto distance = [](const Vec3& p) {  // from the plate's skin
      const double r = std::hypot(p.x - 1.7, p.y - 1.4);
      const double box = std::min({std::abs(p.x), std::abs(4 - p.x), std::abs(p.y), std::abs(3 - p.y)});
      const double flat = std::min(std::abs(p.z), std::abs(1 - p.z));
      return std::min({std::abs(r - 0.6), box, r < 0.6 ? std::hypot(flat, 0.6 - r) : flat});
    };
    for (std::size_t t = 0; t < made.mesh.indices.size(); t += 3)
      for (int i = 0; i <= 4; ++i)
        for (int j = 0; i + j <= 4; ++j) {
          const Vec3 p = i / 4.0 * vertex(made.mesh, made.mesh.indices[t]) +
                         j / 4.0 * vertex(made.mesh, made.mesh.indices[t + 1]) +
                         (4 - i - j) / 4.0 * vertex(made.mesh, made.mesh.indices[t + 2]);
          largest = std::max(largest, distance(p));
        }
    EXPECT_LE(largest, made.bound + made.gap + 1e-6) << tolerance;
    EXPECT_GT(largest, 0.01 * tolerance);
  }
}

/// Moves the control points of the loops' curves within their planes.
Shape displaced(Shape shape, double by, std::mt19937_64& random) {
  std::uniform_real_distribution<double> offset(-by, by);
  for (ShapeFace& face : shape.faces) {
    if (face.trims->empty()) continue;
    std::vector<TrimLoop> loops = *face.trims;
    for (TrimLoop& loop : loops)
      for (Curve& curve : loop.curves) {
        if (curve.degree() < 2) continue;
        std::vector<Vec3> points(curve.points().begin(), curve.points().end());
        for (Vec3& p : points) p += {offset(random), offset(random), 0};
        curve = value_of(Curve::nurbs(curve.degree(), points, curve.weights(), curve.knots(), curve.domain()));
      }
    face.trims = std::move(loops);
  }
  return shape;
}

TEST(ClosedShape, StaysClosedWhereLoopsAreOffTheirEdges) {
  std::mt19937_64 random(7);
  const Shape exact = joined(drilled_plate(), 1e-6);
  for (const double by : {1e-9, 1e-7, 1e-5, 1e-3, 1e-2}) {
    const Shape shape = displaced(exact, by, random);
    for (const double tolerance : {0.1, 1e-3, 2e-5}) {
      const ShapeMesh made = mesh_of(shape, {.tolerance = tolerance});
      expect_closed(made, std::to_string(by).c_str());
      EXPECT_LE(made.bound, tolerance);
      EXPECT_LE(made.gap, 1.5 * by + 1e-7);
      EXPECT_GT(made.gap, 0.05 * by);
      const auto [volume, area] = volume_and_area(made.mesh);
      EXPECT_NEAR(volume, drilled_volume(), area * (made.bound + made.gap));
    }
  }
}

TEST(ClosedShape, EdgesWiderThanTheLargestGapStayOpen) {
  std::mt19937_64 random(7);
  const Shape shape = displaced(joined(drilled_plate(), 1e-6), 1e-2, random);
  const ShapeMesh closed = mesh_of(shape, {.tolerance = 1e-3}),
                  open = mesh_of(shape, {.tolerance = 1e-3, .joining = {.max_gap = 1e-4}});
  expect_closed(closed, "any gap");
  EXPECT_GT(closed.gap, 1e-3);
  EXPECT_LE(open.gap, 1e-4);
  EXPECT_GT(open.report.open_edges, 20u);
  EXPECT_EQ(open.report.open_edges, open.open_edges);
  const Shape exact = joined(drilled_plate(), 1e-6);
  expect_closed(mesh_of(exact, {.tolerance = 1e-3, .joining = {.max_gap = 1e-6}}), "no gap");
  const ShapeMesh apart = mesh_of(exact, {.tolerance = 1e-3, .joining = {.close_edges = false}});
  EXPECT_GT(apart.report.open_edges, 20u);
  EXPECT_TRUE(apart.edge_gaps.empty());
}

TEST(ClosedShape, OpenShellsKeepExactlyTheirBorders) {
  std::vector<ModelSurface> faces = drilled_plate();
  faces.erase(faces.begin());  // the top
  for (const double tolerance : {0.5, 0.01, 1e-4}) {
    const ShapeMesh made = mesh_of(joined(faces, 1e-6), {.tolerance = tolerance});
    EXPECT_EQ(made.report.open_edges, made.open_edges);
    EXPECT_EQ(made.report.non_manifold_edges, 0u);
    for (std::size_t t = 0; t < made.mesh.indices.size(); t += 3) {
      int on_top = 0;
      for (std::size_t c = 0; c < 3; ++c) on_top += vertex(made.mesh, made.mesh.indices[t + c]).z > 1 - 1e-6;
      EXPECT_LT(on_top, 3);
    }
    EXPECT_GE(made.open_edges, 8u);
  }
}

/// One edge may be split in another way on the other side, and run at another speed.
TEST(ClosedShape, FacesSplitInOtherWaysMeet) {
  const ShapeMesh made = mesh_of(joined(one_against_three(0.2, 0.7), 1e-6), {.tolerance = 1e-3});
  EXPECT_EQ(made.report.open_edges, made.open_edges);
  EXPECT_EQ(made.report.t_junctions, 0u);
  EXPECT_EQ(made.report.open_edges, 8u);  // three on the square, five on the strips
}

TEST(ClosedShape, ThreeFacesAtAnEdgeShareItsVertices) {
  std::vector<ModelSurface> faces = drilled_plate();
  faces.push_back(rectangle_face({4, 0, 1}, {0, 3, 0}, {1, 0, 1}));  // a flag along the edge x = 4 on top
  faces.push_back(rectangle_face({0, 0, 0}, {0, 3, 0}, {-1, 0, 0.5}));
  const ShapeMesh made = mesh_of(joined(faces, 1e-6), {.tolerance = 1e-3});
  EXPECT_EQ(made.report.non_manifold_edges, 2u);
  EXPECT_EQ(made.report.t_junctions, 0u);
}

TEST(ClosedShape, FacesTurnedInsideOutAreClosedToo) {
  std::vector<ModelSurface> faces = drilled_plate();
  faces[3] = rectangle_face({0, 3, 0}, {4, 0, 0}, {0, 0, 1});
  const ShapeMesh made = mesh_of(joined(faces, 1e-6), {.tolerance = 1e-3});
  EXPECT_TRUE(made.report.closed());
  EXPECT_GT(made.report.inconsistent_edges, 0u);
}

TEST(ClosedShape, LoopsWithoutCoedgesStayOpen) {
  Shape shape = joined(drilled_plate(), 1e-6);
  std::vector<TrimLoop> loops = *shape.faces[0].trims;
  for (TrimLoop& loop : loops) loop.coedges.clear();
  shape.faces[0].trims = std::move(loops);
  const ShapeMesh made = mesh_of(shape, {.tolerance = 1e-3, .joining = {.weld = 0}});
  EXPECT_GT(made.open_edges, 30u);
  EXPECT_EQ(made.report.non_finite_vertices, 0u);
}

/// States a coedge's parameter anew: even along its edge.
void restate(TrimLoop& loop, std::size_t at, const Shape& shape) {
  Coedge& coedge = loop.coedges[at];
  const Interval &edge = shape.edges[coedge.edge].range, &curve = loop.curves[at].domain();
  const double first = coedge.reversed ? curve.to : curve.from, last = coedge.reversed ? curve.from : curve.to;
  coedge.parameter = value_of(Curve::b_spline(1, std::vector<Vec3>{{first, 0, 0}, {last, 0, 0}},
                                              std::vector<double>{edge.from, edge.from, edge.to, edge.to}));
}

/// Edges may be those of other places altogether: then gaps are as large as the plate, and the mesh is closed all the
/// same.
TEST(ClosedShape, WrongCoedgesMakeGapsAndNoHoles) {
  const Shape exact = joined(drilled_plate(), 1e-6);
  std::mt19937_64 random(11);
  for (int round = 0; round < 60; ++round) {
    Shape shape = exact;
    ShapeFace& face = shape.faces[random() % 7];
    const bool is_trimmed = !face.trims->empty();
    std::vector<TrimLoop> loops = is_trimmed ? *face.trims : *face.outline;
    TrimLoop& loop = loops[random() % loops.size()];
    const std::size_t count = loop.coedges.size();
    const std::size_t a = random() % count, b = random() % count;
    switch (round % 3) {
      case 0:
        std::swap(loop.coedges[a], loop.coedges[b]);
        break;
      case 1:
        loop.coedges[a].reversed = !loop.coedges[a].reversed;
        break;
      default:
        loop.coedges[a].edge = static_cast<std::uint32_t>(random() % shape.edges.size());
        break;
    }
    for (const std::size_t c : {a, b}) restate(loop, c, shape);
    (is_trimmed ? face.trims : face.outline) = std::move(loops);
    const PatchSet set = value_of(make_patch_set(shape));
    const Result<Tessellation> plan = Tessellation::make(set, {.tolerance = 0.01});
    ASSERT_TRUE(plan.ok()) << round << ' ' << plan.status().message();
    Mesh mesh = value_of(plan->allocate());
    ASSERT_TRUE(plan->run(set, mesh.views()).ok());
    const MeshReport report = value_of(check(mesh));
    EXPECT_EQ(report.non_finite_vertices, 0u) << round;
    EXPECT_LE(plan->bound(), 0.01) << round;
    EXPECT_LT(plan->gap(), 6) << round;
    if (round % 3 < 2) {
      EXPECT_EQ(plan->open_edges(), 0u) << round << ": " << report.open_edges;
    }
  }
}

/// A half ball on a disc: a seam, a pole, and an edge of the ball's half against the disc's circle.
TEST(ClosedShape, SeamsAndPolesAreClosed) {
  const Curve arc = value_of(
      Curve::bezier(std::vector<Vec3>{{2, 0, 0}, {2, 0, 2}, {0, 0, 2}}, std::vector<double>{1, std::sqrt(0.5), 1}));
  const ModelSurface dome{.name = std::string("dome"), .surface = value_of(make_surface_of_revolution(arc, {}))};
  ModelSurface disc = rectangle_face({-2.5, -2.5, 0}, {0, 5, 0}, {5, 0, 0}, {circle_loop(2.5, 2.5, 2, false, 0.3)});
  for (const double tolerance : {1.0, 0.05, 1e-3, 1e-5}) {
    const ShapeMesh made = mesh_of(joined({dome, disc}, 1e-6), {.tolerance = tolerance});
    expect_closed(made, "half a ball");
    const auto [volume, area] = volume_and_area(made.mesh);
    EXPECT_NEAR(volume, 16 * std::numbers::pi / 3, area * (made.bound + made.gap)) << tolerance;
  }
}

/// The triangles of a mesh by their corners' positions, in order.
std::vector<std::array<float, 9>> triangles_of(const Mesh& mesh) {
  std::vector<std::array<float, 9>> all;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    std::array<std::array<float, 3>, 3> corners;
    for (std::size_t c = 0; c < 3; ++c)
      std::copy_n(&mesh.positions[3 * std::size_t{mesh.indices[t + c]}], 3, corners[c].begin());
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::array<float, 9>& flat = all.emplace_back();
    for (std::size_t k = 0; k < 9; ++k) flat[k] = corners[k / 3][k % 3];
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(ClosedShape, TheOrderOfFacesMakesNoDifference) {
  std::vector<ModelSurface> faces = drilled_plate(1.7, 1.4, 0.6, 0.4);
  const auto first = triangles_of(mesh_of(joined(faces, 1e-6), {.tolerance = 1e-3}).mesh);
  std::mt19937_64 random(3);
  for (int k = 0; k < 5; ++k) {
    std::shuffle(faces.begin(), faces.end(), random);
    EXPECT_EQ(triangles_of(mesh_of(joined(faces, 1e-6), {.tolerance = 1e-3}).mesh), first);
  }
}

TEST(ClosedShape, BytesDoNotDependOnThreads) {
  const Shape shape = joined(drilled_plate(), 1e-6);
  const auto bytes = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Mesh mesh = mesh_of(shape, {.tolerance = 1e-4}).mesh;
    return std::pair(mesh.positions, mesh.indices);
  };
  EXPECT_EQ(bytes(1), bytes(4));
}

/// Control points of all patches, mapped.
TEST(ClosedShape, MeshesFollowEdits) {
  PatchSet set = value_of(make_patch_set(joined(drilled_plate(), 1e-6)));
  Tessellation plan = value_of(Tessellation::make(set, {.tolerance = 1e-3}));
  Mesh mesh = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(set, mesh.views()).ok());
  double scale = 1;
  const auto stretch = [&](double by) {
    std::vector<std::uint32_t> patches(set.patch_count());
    std::iota(patches.begin(), patches.end(), 0u);
    std::vector<Vec3> points;
    for (const std::uint32_t k : patches)
      for (const Vec3& p : set.patch(k).points()) points.push_back({p.x, p.y, by * p.z});
    scale *= by;
    return value_of(plan.update(set, PatchEdits{patches, points}, mesh.views()));
  };
  const auto expect_stretched = [&] {
    EXPECT_TRUE(value_of(check(mesh)).closed());
    EXPECT_EQ(plan.open_edges(), 0u);
    EXPECT_LE(plan.bound(), 1e-3);
    const auto [volume, area] = volume_and_area(mesh);
    EXPECT_NEAR(volume, scale * drilled_volume(), area * (plan.bound() + plan.gap()));
  };
  EXPECT_FALSE(stretch(1.01).topology);
  expect_stretched();
  // One face alone rises from the others: they stay joined, half-way.
  std::vector<Vec3> points;
  std::vector<std::uint32_t> lone{0};
  for (const Vec3& p : set.patch(0).points()) points.push_back(p + Vec3{0, 0, 0.01});
  EXPECT_FALSE(value_of(plan.update(set, PatchEdits{lone, points}, mesh.views())).topology);
  EXPECT_TRUE(value_of(check(mesh)).closed());
  EXPECT_NEAR(plan.gap(), 0.005, 1e-6);
}

/// By index alone, each side of a triangle belongs to two.
TEST(ClosedShape, VerticesAreSharedByIndexOnRequest) {
  const Shape shape = joined(drilled_plate(), 1e-6);
  for (const std::optional<double> crease : {std::optional<double>(), std::optional<double>(4.0 / 5)}) {
    const ShapeMesh made =
        mesh_of(shape, {.tolerance = 1e-3, .joining = {.crease_angle = crease, .share_vertices = true}});
    expect_closed(made, "shared");
    EXPECT_EQ(made.mesh.normals.empty(), !crease);
    EXPECT_LT(made.mesh.vertex_count(), mesh_of(shape, {.tolerance = 1e-3}).mesh.vertex_count());
    if (crease) continue;
    EXPECT_EQ(made.mesh.vertex_count(), made.report.distinct_positions);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (std::size_t t = 0; t < made.mesh.indices.size(); t += 3)
      for (std::size_t c = 0; c < 3; ++c) ++sides[{made.mesh.indices[t + c], made.mesh.indices[t + (c + 1) % 3]}];
    for (const auto& [side, count] : sides) {
      EXPECT_EQ(count, 1);
      EXPECT_TRUE(sides.count({side.second, side.first}));
    }
  }
}

/// A rounded edge: the normals of fillet and faces are one where they touch, those at sharp edges are not.
TEST(ClosedShape, NormalsAreJoinedAtSmoothEdges) {
  const Shape shape = joined(drilled_plate(), 1e-6);
  const ShapeMesh sharp = mesh_of(shape, {.tolerance = 1e-3, .joining = {.crease_angle = 0.1}});
  const ShapeMesh round = mesh_of(shape, {.tolerance = 1e-3, .joining = {.crease_angle = std::numbers::pi}});
  std::map<std::array<float, 3>, std::vector<Vec3>> at_sharp, at_round;
  const auto collect = [](const Mesh& mesh, auto& at) {
    for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
      const float *p = &mesh.positions[3 * k], *n = &mesh.normals[3 * k];
      at[{p[0], p[1], p[2]}].push_back({n[0], n[1], n[2]});
    }
  };
  collect(sharp.mesh, at_sharp), collect(round.mesh, at_round);
  const auto spread = [](const std::vector<Vec3>& normals) {
    double most = 0;
    for (const Vec3& n : normals) most = std::max(most, length(n - normals.front()));
    return most;
  };
  double least = 9, most = 0;
  for (const auto& [place, normals] : at_sharp)
    if (normals.size() > 2) least = std::min(least, spread(normals));
  for (const auto& [place, normals] : at_round) most = std::max(most, spread(normals));
  EXPECT_GT(least, 1.4);
  EXPECT_EQ(most, 0);
}

TEST(ClosedShape, AnglesPixelsDoublesAndQuadsAreClosed) {
  const Shape shape = joined(drilled_plate(), 1e-6);
  expect_closed(mesh_of(shape, {.angle = 0.2}), "angle");
  View view;
  view.eye = {9, -7, 6}, view.target = {2, 1.5, 0.5};
  expect_closed(mesh_of(shape, {.pixels = PixelTolerance{0.5, view}}), "pixels");
  expect_closed(mesh_of(shape, {.tolerance = 1e-3, .precision = Precision::double_precision}), "doubles");
  expect_closed(mesh_of(shape, {.tolerance = 1e-3, .fewest = true}), "fewest");
  expect_closed(mesh_of(shape, {.tolerance = 1e-3, .joining = {.crease_angle = 0.1}}), "creases");
  const ShapeMesh quads = mesh_of(shape, {.tolerance = 1e-3, .quads = true});
  EXPECT_TRUE(quads.report.closed());
  EXPECT_EQ(quads.report.t_junctions, 0u);
}

}}  // namespace tessera::test
