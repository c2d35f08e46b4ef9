// Trimming loops of OBJ files are kept with their surfaces.

#include "io/obj_samples.h"

namespace tessera {
namespace {

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

}  // namespace
}  // namespace tessera
