// Trimming loops of OBJ files are kept with their surfaces.

#include <algorithm>
#include <cmath>

#include "io/obj_samples.h"
#include "tessera/trim_region.h"

namespace tessera { namespace {

using namespace test;

TEST(ObjTrims, AreKeptWithTheirCurvesAndReported) {
  const std::string curves =
      "vp 0.1 0.1\nvp 0.9 0.1\nvp 0.9 0.9\nvp 0.1 0.9\ncstype bezier\ndeg 1\ncurv2 1 2 3 4 1\nparm u 0 1 2 3 4\nend\n"
      "vp 0.3 0.5 1\nvp 0.5 0.7 2\nvp 0.7 0.5 1\ncstype rat bezier\ndeg 2\ncurv2 -3 -2 -1\nparm u 0 1\nsp 1\nend\n"
      "cstype bspline\ndeg 1\ncurv2 7 5\nparm u 0 0 1 1\nend\n";
  const Model model = model_of(four_vertices + curves + bilinear + bilinear.substr(0, bilinear.size() - 4) +
                               "trim 0 4 1\nhole 0.25 0.75 2 0 1 -1\nscrv 0 1 2\nend\n");
  ASSERT_EQ(model.surfaces.size(), 2u);
  EXPECT_TRUE(model.surfaces[0].trims->empty());
  const std::vector<TrimLoop>& trims = model.surfaces[1].trims;
  ASSERT_EQ(trims.size(), 2u);
  EXPECT_FALSE(trims[0].hole);
  EXPECT_TRUE(trims[1].hole);
  ASSERT_EQ(trims[0].curves.size(), 1u);
  ASSERT_EQ(trims[1].curves.size(), 2u);
  EXPECT_EQ(trims[0].curves[0].domain(), (Interval{0, 4}));
  EXPECT_EQ(evaluate_jet(trims[0].curves[0], 2.5).position, (Vec3{0.5, 0.9, 0}));
  EXPECT_EQ(trims[1].curves[0].domain(), (Interval{0.25, 0.75}));
  EXPECT_LE(max_abs(evaluate_jet(trims[1].curves[0], 0.5).position - Vec3{0.5, 1.9 / 3, 0}), 0x1p-50);
  EXPECT_EQ(evaluate_jet(trims[1].curves[1], 1).position, (Vec3{0.3, 0.5, 0}));
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_EQ(model.warnings[0], "m.obj:21: 2 statements are not kept, the first here: 1 sp, 1 scrv");
}

/// A square with a round hole; an island in the hole, whose outline is one more trim.
TEST(ObjTrims, KeepWhatTheyEnclose) {
  std::string curves =
      "vp 0.1 0.1\nvp 0.9 0.1\nvp 0.9 0.9\nvp 0.1 0.9\ncstype bspline\ndeg 1\ncurv2 1 2 3 4 1\n"
      "parm u 0 0 1 2 3 4 4\nend\n";
  constexpr int x[] = {1, 1, 0, -1, -1, -1, 0, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1};
  for (const double radius : {0.25, 0.125}) {
    for (int k = 0; k < 8; ++k)
      curves += "vp " + std::to_string(0.5 + radius * x[k]) + " " + std::to_string(0.5 + radius * y[k]) +
                (k % 2 == 0 ? " 1\n" : " 0.70710678118654752\n");
    curves += "cstype rat bspline\ndeg 2\ncurv2 -8 -7 -6 -5 -4 -3 -2 -1 -8\nparm u 0 0 0 1 1 2 2 3 3 4 4 4\nend\n";
  }
  // The hole in two parts, of which the second comes first.
  const Model model = model_of(four_vertices + curves + bilinear.substr(0, bilinear.size() - 4) +
                               "trim 0 4 1\nhole 1.5 4 2 0 1.5 2\ntrim 0 4 3\nend\n");
  ASSERT_EQ(model.surfaces.size(), 1u);
  const Domain d = domain(model.surfaces[0].surface);
  const Result<TrimRegion> region = TrimRegion::make(*model.surfaces[0].trims, d);
  ASSERT_TRUE(region.ok());
  EXPECT_TRUE(region->remarks().empty());
  for (int i = 0; i <= 200; ++i)
    for (int k = 0; k <= 200; ++k) {
      const double u = i / 200.0, v = k / 200.0, r = std::hypot(u - 0.5, v - 0.5);
      const double square = 0.4 - std::max(std::abs(u - 0.5), std::abs(v - 0.5));
      if (std::min({std::abs(square), std::abs(r - 0.25), std::abs(r - 0.125)}) < 1e-14) continue;
      const bool kept = square > 0 && (r > 0.25 || r < 0.125);
      ASSERT_EQ(region->locate(u, v), kept ? TrimSide::inside : TrimSide::outside) << u << ' ' << v;
    }
}

}}  // namespace tessera
