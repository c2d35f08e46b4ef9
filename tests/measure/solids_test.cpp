// Solids of shapes: directions of faces, cavities, placements, open edges; options, threads and cancellation.

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "join/unjoined_faces.h"
#include "measure/measure_bodies.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

constexpr std::array<std::array<std::uint32_t, 4>, 6> sides{
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

/// Adds a box as a shell of solid 0. Some faces are turned, so that normals point to both sides; faces with an odd
/// number are trimmed along their sides, the others have outlines.
void add_box(Shape& shape, const Vec3& lower, const Vec3& upper, unsigned turned, double gap = 0) {
  const auto corner = [&](std::uint32_t k) {
    return Vec3{k & 1 ? upper.x : lower.x, k & 2 ? upper.y : lower.y, k & 4 ? upper.z : lower.z};
  };
  const auto first_vertex = static_cast<std::uint32_t>(shape.vertices.size());
  const auto first_edge = static_cast<std::uint32_t>(shape.edges.size());
  for (std::uint32_t k = 0; k < 8; ++k) shape.vertices.push_back({corner(k), 1e-7});
  const auto coedge = [&](std::uint32_t from, std::uint32_t to) -> Coedge {
    for (std::uint32_t k = first_edge; k < shape.edges.size(); ++k) {
      if (shape.edges[k].start == first_vertex + from && shape.edges[k].end == first_vertex + to) return {k, false};
      if (shape.edges[k].start == first_vertex + to && shape.edges[k].end == first_vertex + from) return {k, true};
    }
    shape.edges.push_back({first_vertex + from, first_vertex + to, {0, 1}, space_line(corner(from), corner(to)), 1e-7});
    return {static_cast<std::uint32_t>(shape.edges.size() - 1), false};
  };
  Shell shell{{}, 0};
  for (std::uint32_t side = 0; side < 6; ++side) {
    std::array<std::uint32_t, 4> at = sides[side];
    if (turned >> side & 1) std::swap(at[1], at[3]);
    const Vec3 off = gap * normalized(cross(corner(at[1]) - corner(at[0]), corner(at[3]) - corner(at[0])));
    const std::vector<Vec3> points{corner(at[0]) + off, corner(at[3]) + off, corner(at[1]) + off, corner(at[2]) + off};
    TrimLoop loop;
    const std::array<Vec3, 4> uv{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    for (std::size_t k = 0; k < 4; ++k) {
      loop.curves.push_back(space_line(uv[k], uv[(k + 1) % 4]));
      loop.coedges.push_back(coedge(at[k], at[(k + 1) % 4]));
    }
    ShapeFace face{{"side", polynomial(1, 1, points)}};
    (side % 2 != 0 ? face.trims : face.outline) = std::vector<TrimLoop>{loop};
    shell.faces.push_back(static_cast<std::uint32_t>(shape.faces.size()));
    shape.faces.push_back(face);
  }
  shape.shells.push_back(shell);
  shape.solid_count = 1;
}

TEST(Solids, TheVolumeIsPositiveWhateverTheFacesDirections) {
  for (unsigned turned = 0; turned < 64; ++turned) {
    Shape shape;
    add_box(shape, {1, 2, 3}, {2, 4, 6}, turned);
    const std::vector<BodyMeasures> found = value_of(measure_solids(shape));
    ASSERT_EQ(found.size(), 1u);
    const std::string what = std::to_string(turned);
    expect_measured(found[0].volume, 6, 1e-9, what);
    expect_point(found[0].centroid, {1.5, 3, 4.5}, 1e-8, what);
    expect_measured({found[0].inertia.xx, found[0].inertia.error}, 6.0 / 12 * (4 + 9), 1e-7, what);
    EXPECT_LE(std::abs(found[0].inertia.xy), found[0].inertia.error);
    EXPECT_EQ(found[0].solid, 0u);
    EXPECT_LE(found[0].gap, 1e-15);
    EXPECT_TRUE(found[0].proven);
  }
}

TEST(Solids, CavitiesAreTakenAway) {
  for (const unsigned turned : {0u, 63u, 21u}) {
    Shape shape;
    add_box(shape, {0, 0, 0}, {1, 1, 1}, turned);
    add_box(shape, {-2, -2, -2}, {4, 2, 2}, 63 - turned);
    const std::vector<BodyMeasures> found = value_of(measure_solids(shape));
    ASSERT_EQ(found.size(), 1u);
    expect_measured(found[0].volume, 96 - 1, 1e-9, "hollow");
    expect_point(found[0].centroid, (1.0 / 95) * (96 * Vec3{1, 0, 0} - Vec3{0.5, 0.5, 0.5}), 1e-7, "hollow");
  }
  Shape apart;
  add_box(apart, {0, 0, 0}, {1, 1, 1}, 0);
  add_box(apart, {2, 0, 0}, {4, 1, 1}, 5);
  expect_measured(value_of(measure_solids(apart))[0].volume, 3, 1e-9, "beside each other");
}

TEST(Solids, InstancesArePlaced) {
  Model model;
  model.shapes.resize(1);
  add_box(model.shapes[0], {0, 0, 0}, {1, 2, 3}, 9);
  const Affine turn = Affine::translated({1e3, 5, 0}) * Affine::rotated({1, 1, 1}, 1.1);
  const Affine mirror = Affine::scaled({2, -1, 0.5});
  Affine shear;
  shear.columns[1] = {0.5, 1, 0.25};
  const std::vector<Affine> maps{{}, turn, mirror, turn * shear * mirror};
  for (std::size_t k = 0; k < maps.size(); ++k) model.instances.push_back({0, 6 * k, "", maps[k], {}});
  model.surfaces = value_of(placed_faces(model.shapes, model.instances));
  const std::vector<BodyMeasures> found = value_of(measure_solids(model));
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t k = 0; k < maps.size(); ++k) {
    const std::string what = std::to_string(k);
    EXPECT_EQ(found[k].instance, k);
    expect_measured(found[k].volume, 6 * std::abs(maps[k].determinant()), 1e-9, what);
    expect_point(found[k].centroid, maps[k].point({0.5, 1, 1.5}), 1e-7, what);
    // Measured again with the faces themselves placed.
    Shape placed = model.shapes[0];
    for (ShapeFace& face : placed.faces) face.placement = maps[k];
    const BodyMeasures direct = value_of(measure_solids(placed))[0];
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(found[k].inertia.moments[axis], direct.inertia.moments[axis],
                  found[k].inertia.moments_error + direct.inertia.moments_error)
          << what;
  }
  const BodyMeasures total = value_of(total_of(found));
  double volume = 0;
  for (const BodyMeasures& body : found) volume += body.volume.value;
  expect_measured(total.volume, volume, 1e-9, "total");
}

TEST(Solids, GapsWidenTheBound) {
  Shape shape;
  add_box(shape, {0, 0, 0}, {1, 1, 1}, 0, 1e-4);
  const BodyMeasures body = value_of(measure_solids(shape))[0];
  EXPECT_NEAR(body.gap, 1e-4 * std::sqrt(2), 1e-9);
  // The faces are moved apart, or into each other, by 1e-4 each.
  EXPECT_LE(std::abs(body.volume.value - 1), 6.1e-4);
  EXPECT_GE(body.volume.error, 1e-4);
  EXPECT_LE(body.volume.error, 1e-2);
}

TEST(Solids, OpenSolidsNameTheirOpenEdges) {
  Shape shape;
  shape.name = std::string("tub");
  add_box(shape, {0, 0, 0}, {1, 1, 1}, 0);
  shape.shells[0].faces.pop_back();
  expect_refused(measure_solids(shape), StatusCode::invalid_argument, 0, "solid 0: 4 open edges: ");
  Model model;
  model.shapes = {shape};
  model.instances = {{0, 0}};
  model.surfaces = value_of(placed_faces(model.shapes, model.instances));
  expect_refused(measure_solids(model), StatusCode::invalid_argument, 0, "shape 0 (tub): solid 0: 4 open edges: ");
  // A shell of no solid may be open.
  shape.shells[0].solid = no_id;
  EXPECT_TRUE(value_of(measure_solids(shape)).empty());
}

TEST(Solids, FacesThatCannotBeOrientedAreAnError) {
  Shape shape;
  add_box(shape, {0, 0, 0}, {1, 1, 1}, 0);
  // The loop of one face names two of its opposite edges the other way round.
  std::vector<TrimLoop> loops = *shape.faces[1].trims;
  for (const std::size_t k : {0u, 2u}) loops[0].coedges[k].reversed = !loops[0].coedges[k].reversed;
  shape.faces[1].trims = loops;
  expect_refused(measure_solids(shape), StatusCode::invalid_argument, 0, "solid 0: its faces cannot be oriented");
}

TEST(Solids, OptionsOutOfRangeAreErrors) {
  const Model model = model_of(surfaces_of(sphere()));
  for (const double accuracy : {0.0, -1.0, 1.0, infinity, not_a_number}) {
    expect_refused(measure_surfaces(model, {.accuracy = accuracy}), StatusCode::invalid_argument, -1, "accuracy");
    expect_refused(measure_box(model, {.accuracy = accuracy}), StatusCode::invalid_argument, -1, "accuracy");
  }
  expect_refused(measure_enclosed(model.surfaces, {.max_cells = 0}), StatusCode::invalid_argument, -1, "max_cells");
  expect_refused(measure_enclosed({}), StatusCode::invalid_argument, -1, "no surfaces");
  expect_refused(total_of({}), StatusCode::invalid_argument, -1, "no bodies");
  const BezierPatch huge = polynomial(1, 1, {{0, 0, 0}, {1e200, 0, 0}, {0, 1e200, 0}, {1e200, 1e200, 0}});
  expect_refused(measure_surfaces(model_of(surfaces_of({huge}))), StatusCode::invalid_argument, 0, "range of numbers");
  expect_refused(measure_enclosed(surfaces_of({huge})), StatusCode::invalid_argument, -1, "range of numbers");
}

TEST(Solids, AnyNumberOfThreadsGivesTheSameBytes) {
  const std::vector<ModelSurface> body = surfaces_of(closed_body());
  const Model model = model_of(body);
  std::vector<double> first;
  for (const int threads : {1, 2, 7}) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      const BodyMeasures found = value_of(measure_enclosed(body));
      const AreaMeasures area = value_of(measure_surfaces(model));
      const MeasuredBox box = value_of(measure_box(model));
      const std::vector<double> numbers{found.volume.value,    found.volume.error,          found.centroid.value.x,
                                        found.inertia.xy,      found.inertia.error,         area.total.area.value,
                                        area.total.area.error, area.total.centroid.value.z, box.box.lower.x,
                                        box.upper_error.z};
      if (first.empty()) first = numbers;
      EXPECT_EQ(std::memcmp(first.data(), numbers.data(), numbers.size() * sizeof(double)), 0) << threads;
    });
  }
}

TEST(Solids, CancelAndProgress) {
  const std::vector<ModelSurface> body = surfaces_of(closed_body());
  std::atomic<bool> cancel{true};
  expect_refused(measure_enclosed(body, {}, {.cancel = &cancel}), StatusCode::cancelled, -1, "");
  expect_refused(measure_surfaces(model_of(body), {}, {.cancel = &cancel}), StatusCode::cancelled, -1, "");
  expect_refused(measure_box(model_of(body), {}, {.cancel = &cancel}), StatusCode::cancelled, -1, "");
  double last = 0;
  int ends = 0;
  Execution execution;
  execution.progress = [&](double done) {
    EXPECT_GT(done, last);
    last = done;
    ends += done == 1;
  };
  EXPECT_TRUE(measure_enclosed(body, {}, execution).ok());
  EXPECT_EQ(ends, 1);
}

}}  // namespace tessera::test
