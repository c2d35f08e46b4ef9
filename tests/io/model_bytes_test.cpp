// Models survive the way to bytes and back; other bytes do no harm.

#include "io/cad/model_bytes.h"

#include <gtest/gtest.h>

#include <random>

#include "support/errors.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test {
namespace {

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

TEST(ModelBytes, OtherBytesAreRefused) {
  const std::string bytes = to_bytes(sample());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_FALSE(model_from_bytes(std::string_view(bytes).substr(0, size)).ok()) << size;
  std::mt19937 random(5);
  for (int k = 0; k < 2000; ++k) {
    std::string damaged = bytes;
    damaged[random() % damaged.size()] = static_cast<char>(random());
    static_cast<void>(model_from_bytes(damaged));  // any result will do, except a crash or endless memory
  }
}

}  // namespace
}  // namespace tessera::test
