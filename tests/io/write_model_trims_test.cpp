// Trims are written with their surfaces; if a format cannot hold them, a warning says so.

#include "io/written_models.h"

namespace tessera::test { namespace {

/// A triangle of segments, of which one is a part of a longer one; and a circle of two rational halves.
std::vector<TrimLoop> loops() {
  const auto segment = [](Vec3 a, Vec3 b) { return value_of(Curve::bezier(std::vector{a, b})); };
  const Curve longer = value_of(Curve::b_spline(1, std::vector<Vec3>{{0.1, 0.9, 0}, {0.1, 0.1, 0}, {5, 5, 0}},
                                                std::vector<double>{-1, -1, 1.0 / 3, 2, 2}, Interval{-1, 1.0 / 3}));
  const auto half = [](double side) {
    return value_of(
        Curve::bezier(std::vector<Vec3>{{0.5 - side, 0.5, 0}, {0.5 - side, 0.5 + side, 0}, {0.5 + side, 0.5 + side, 0}},
                      std::vector<double>{1, 0.7, 1}, Interval{0, 0.1}));
  };
  return {{{segment({0.1, 0.1, 0}, {0.9, 0.1, 0}), segment({0.9, 0.1, 0}, {0.1, 0.9, 0}), longer}, false},
          {{half(0.1), half(-0.1)}, true}};
}

TEST(WriteModelTrims, ComeBackBitForBit) {
  const ScratchFolder folder;
  Random random(1);
  Model model =
      model_of({random_polynomial(random, 3, 2), random_rational(random, 2, 2), random_polynomial(random, 1, 1)});
  model.surfaces[0].trims = loops();
  model.surfaces[1].trims = std::vector{loops()[1], loops()[0], loops()[1]};
  for (const char* name : {"a.json", "a.obj"}) {
    WrittenModel facts;
    const Model read = rewritten(model, folder / name, &facts);
    EXPECT_TRUE(facts.warnings.empty());
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(model.surfaces[k].trims, read.surfaces[k].trims) << name;
    expect_same_patches(model, read, "trimmed");
  }
}

/// A placement moves the surface; its parameters, and so its loops, stay.
TEST(WriteModelTrims, StayWhereTheSurfaceIsPlaced) {
  const ScratchFolder folder;
  Random random(3);
  Model model = model_of({random_polynomial(random, 3, 2)});
  model.surfaces[0].trims = loops();
  model.surfaces[0].placement = Affine::translated({1, 2, 3}) * Affine::rotated({1, 1, 0}, 0.5);
  const Model copy = model;
  EXPECT_EQ(copy.surfaces[0].trims, model.surfaces[0].trims);
  for (const char* name : {"a.json", "a.obj"}) {
    const Model read = rewritten(model, folder / name);
    EXPECT_EQ(read.surfaces[0].trims, model.surfaces[0].trims) << name;
    expect_same_patches(model, read, "placed");
  }
}

TEST(WriteModelTrims, AreComparedByTheirNumbers) {
  const std::vector<TrimLoop> a = loops();
  std::vector<TrimLoop> b = loops();
  EXPECT_EQ(a, b);
  b[1].hole = false;
  EXPECT_NE(a, b);
  b = loops();
  std::swap(b[0].curves[0], b[0].curves[1]);
  EXPECT_NE(a, b);
  const auto arc = [](double x, double weight, double end) {
    return value_of(Curve::bezier(std::vector<Vec3>{{0, 0, 0}, {x, 1, 0}, {1, 0, 0}}, std::vector<double>{1, weight, 1},
                                  Interval{0, end}));
  };
  EXPECT_EQ(arc(0, 2, 1), arc(0, 2, 1));
  for (const Curve& other : {arc(0.1, 2, 1), arc(0, 1, 1), arc(0, 3, 1), arc(0, 2, 2)}) EXPECT_NE(arc(0, 2, 1), other);
}

TEST(WriteModelTrims, AreSaidToBeLeftOutOfBpt) {
  const ScratchFolder folder;
  Random random(2);
  Model model = model_of({random_polynomial(random, 3, 2), random_polynomial(random, 3, 2)});
  model.surfaces[0].trims = loops();
  model.surfaces[1].trims = std::vector{loops()[0]};
  model.surfaces[1].name = "rim";
  WrittenModel facts;
  rewritten(model, folder / "a.bpt", &facts);
  EXPECT_EQ(facts.warnings, (std::vector<std::string>{"surface 0: 2 trims are not written: .bpt has none",
                                                      "surface 1 (rim): 1 trim is not written: .bpt has none"}));
}

/// A quadric is written as its patches, and its loops in their parameters.
TEST(WriteModelTrims, FollowThePatchesOfQuadrics) {
  const ScratchFolder folder;
  Model model = value_of(read_model(TESSERA_SOURCE_DIR "/tools/models/quadric_elliptic_cylinder.json"));
  ASSERT_TRUE(std::holds_alternative<QuadricPiece>(model.surfaces.at(0).surface));
  model.surfaces[0].trims = loops();
  const Shared<std::vector<TrimLoop>> followed = value_of(grid_trims(model.surfaces[0]));
  EXPECT_NE(*followed, loops());
  for (const char* name : {"a.json", "a.obj"}) {
    WrittenModel facts;
    const Model read = rewritten(model, folder / name, &facts);
    EXPECT_TRUE(facts.warnings.empty());
    EXPECT_EQ(read.surfaces[0].trims, followed) << name;
  }
}

}}  // namespace tessera::test
