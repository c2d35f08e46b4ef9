// Models survive the way to bytes and back; other bytes do no harm.

#include "io/cad/model_bytes.h"

#include <gtest/gtest.h>

#include <random>

#include "support/errors.h"
#include "tessera/nurbs_surface.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

Model sample() {
  Model model{"part", {}, {"one warning", "another"}};
  const Result<BSplineSurface> sphere = make_nurbs_sphere({}, 2);
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0.5, 0}};
  const Result<Curve> curve = Curve::bezier(points), arc = make_nurbs_circle({}, 1);
  TrimLoop loop{{*curve, *arc}, true};
  model.surfaces.push_back({"ball", *sphere, Affine::translated({1, 2, 3}), std::vector<TrimLoop>{loop, {}}});
  const std::vector<double> knots{0, 0, 1, 1};
  model.surfaces.push_back({"", *BSplineSurface::polynomial(1, knots, 1, knots, points, Domain{0.25, 1, 0, 0.5})});
  return model;
}

/// Two instances of a shape of two faces, which share an edge.
Model sample_of_shapes() {
  Model model{"assembly", {}, {"a warning"}};
  Shape shape;
  shape.name = std::string("part");
  const Model surfaces = sample();
  const std::vector<Vec3> ends{{0, 0, 0}, {1, 0, 0}};
  const Result<Curve> line = Curve::bezier(ends), back = Curve::bezier(std::vector<Vec3>{ends[1], ends[0]});
  shape.faces = {{surfaces.surfaces[0]}, {surfaces.surfaces[1]}};
  shape.faces[0].trims = std::vector<TrimLoop>{{{*line, *line}, true, {{0, true, *back}, {1, false}}}};
  shape.faces[1].outline = std::vector<TrimLoop>{{{*line}, false, {{0, false}}}};
  shape.faces[1].colour = Colour{0.25, 0.5, 1, 0.75};
  shape.vertices = {{{1, 2, 3}, 1e-5}, {{4, 5, 6}, 1e-6}};
  shape.edges = {{0, 1, {0, 1}, *line, 1e-4, false, true}, {1, no_id, {2, 3}, {}, 0, true, false}};
  shape.shells = {{{0, 1}, 0}, {{1}}};
  shape.solid_count = 1;
  model.shapes = {shape};
  model.instances = {{0, 0, "one", Affine::translated({1, 0, 0}), Colour{1, 0, 0}}, {0, 2, "two"}};
  Result<std::vector<ModelSurface>> placed = placed_faces(model.shapes, model.instances);
  model.surfaces = *placed;
  model.unit = "mm";
  model.file_unit = "inch";
  return model;
}

TEST(ModelBytes, HoldShapesAndInstances) {
  const Model model = sample_of_shapes();
  const std::string bytes = to_bytes(model);
  const Result<Model> read = model_from_bytes(bytes);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(to_bytes(*read), bytes);
  ASSERT_EQ(read->shapes.size(), 1u);
  const Shape &shape = read->shapes[0], &before = model.shapes[0];
  EXPECT_EQ(shape.name, "part");
  EXPECT_EQ(shape.faces[0].trims, before.faces[0].trims);
  EXPECT_EQ(shape.faces[1].outline, before.faces[1].outline);
  EXPECT_EQ(shape.faces[1].colour, (Colour{0.25, 0.5, 1, 0.75}));
  EXPECT_EQ(shape.vertices[1].position, (Vec3{4, 5, 6}));
  EXPECT_EQ(shape.vertices[1].tolerance, 1e-6);
  EXPECT_EQ(shape.edges[0].curve, before.edges[0].curve);
  EXPECT_TRUE(shape.edges[0].same_parameter && !shape.edges[0].degenerate);
  EXPECT_EQ(shape.edges[1].end, no_id);
  EXPECT_EQ(shape.edges[1].range, (Interval{2, 3}));
  EXPECT_TRUE(shape.edges[1].degenerate && !shape.edges[1].curve);
  EXPECT_EQ(shape.shells[0].faces, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(shape.shells[1].solid, no_id);
  EXPECT_EQ(shape.solid_count, 1u);
  ASSERT_EQ(read->surfaces.size(), 4u);
  EXPECT_EQ(read->instances[0].colour, (Colour{1, 0, 0}));
  EXPECT_EQ(read->surfaces[1].placement, Affine::translated({1, 0, 0}));
  EXPECT_EQ(read->instances[1].first_surface, 2u);
  EXPECT_EQ(read->instances[1].name, "two");
  EXPECT_EQ(read->unit + read->file_unit, "mminch");
}

TEST(ModelBytes, WrongIdsAreNamed) {
  const auto refused = [](auto damage, const std::string& words) {
    Model model = sample_of_shapes();
    damage(model);
    expect_refused(model_from_bytes(to_bytes(model)), StatusCode::internal, Status::no_index,
                   "a damaged model" + words);
  };
  refused([](Model& m) { m.shapes[0].edges[0].end = 2; },
          ": shape 0 (part): edge 0 ends at vertex 2, there are 2 vertices");
  refused([](Model& m) { m.shapes[0].shells[1].faces = {2}; },
          ": shape 0 (part): shell 1 has face 2, there are 2 faces");
  refused([](Model& m) { m.instances[1].shape = 1; }, ": instance 1 (two): it is of shape 1, there is 1 shape");
  refused([](Model& m) { m.shapes[0].edges.pop_back(); },
          ": shape 0 (part): face 0, loop 0 uses edge 1, there is 1 edge");
  refused([](Model& m) { m.instances[0].colour->green = 1.5; }, "");
}

TEST(ModelBytes, FewBytesDoNotBecomeEndlessSurfaces) {
  Model model = sample_of_shapes();
  model.shapes[0].faces.resize(1, model.shapes[0].faces[0]);
  model.shapes[0].faces.resize(2100, {{"", model.shapes[0].faces[0].surface}});
  model.shapes[0].shells = {};
  model.instances.assign(2000, {0});
  model.surfaces = {};
  expect_refused(model_from_bytes(to_bytes(model)), StatusCode::unsupported, Status::no_index,
                 "its instances have more than 4194304 faces");
}

TEST(ModelBytes, HoldTheWholeModel) {
  const Model model = sample();
  const std::string bytes = to_bytes(model);
  const Result<Model> read = model_from_bytes(bytes);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(to_bytes(*read), bytes);
  EXPECT_EQ(read->name, "part");
  EXPECT_EQ(read->warnings, model.warnings);
  ASSERT_EQ(read->surfaces.size(), 2u);
  EXPECT_EQ(read->surfaces[0].name, "ball");
  EXPECT_EQ(read->surfaces[0].placement, model.surfaces[0].placement);
  ASSERT_EQ(read->surfaces[0].trims->size(), 2u);
  EXPECT_TRUE(read->surfaces[0].trims->at(0).hole);
  EXPECT_EQ(read->surfaces[0].trims->at(0).curves.size(), 2u);
  const BSplineSurface &before = std::get<BSplineSurface>(model.surfaces[1].surface),
                       &after = std::get<BSplineSurface>(read->surfaces[1].surface);
  EXPECT_EQ(before.domain(), after.domain());
  EXPECT_TRUE(std::ranges::equal(before.points(), after.points()));
}

TEST(ModelBytes, HoldAnErrorToo) {
  expect_refused(model_from_bytes(to_bytes(Status(StatusCode::parse_error, "words", 7))), StatusCode::parse_error, 7,
                 "words");
  Model other;
  other.surfaces.push_back({"", *BezierPatch::polynomial(1, 1, std::vector<Vec3>(4))});
  expect_refused(model_from_bytes(to_bytes(other)), StatusCode::internal, Status::no_index, "no form as bytes");
}

class BadModelBytes : public testing::TestWithParam<bool> {};

TEST_P(BadModelBytes, AreRefused) {
  const std::string bytes = to_bytes(GetParam() ? sample_of_shapes() : sample());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_FALSE(model_from_bytes(std::string_view(bytes).substr(0, size)).ok()) << size;
  std::mt19937 random(5);
  for (int k = 0; k < 2000; ++k) {
    std::string damaged = bytes;
    damaged[random() % damaged.size()] = static_cast<char>(random());
    static_cast<void>(model_from_bytes(damaged));  // any result will do, except a crash or endless memory
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, BadModelBytes, testing::Bool());

}}  // namespace tessera::test
