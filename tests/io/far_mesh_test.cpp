// Files of meshes far from zero: what is promised of a mesh holds for the numbers that its file has.

#include <gtest/gtest.h>

#include "support/file_triangles.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/io.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

/// A unit sphere's mesh, and what is proven of it.
struct Ball {
  Mesh mesh;
  double bound = 0;
};

Ball ball_at(const Vec3& centre, double tolerance, Precision precision = Precision::single_precision) {
  Model model;
  model.surfaces.push_back(ModelSurface{"ball", value_of(make_nurbs_sphere({.origin = centre}, 1))});
  const PatchSet set = value_of(make_patch_set(model));
  const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = tolerance, .precision = precision}));
  Ball ball{value_of(plan.allocate()), plan.bound()};
  EXPECT_TRUE(plan.run(set, ball.mesh.views()).ok());
  return ball;
}

constexpr double room = 1e-7;  // the distance from the sphere is measured in doubles of these sizes
const char* const names[] = {"ball.stl", "ball.obj", "ball.ply", "ball.glb"};

class FarMesh : public testing::TestWithParam<const char*> {
 protected:
  double measured(const Mesh& mesh, const Vec3& centre) const {
    const std::string path = folder_ / GetParam();
    EXPECT_TRUE(write_mesh(mesh, path).ok());
    return distance_from_sphere(triangles_of_file(path), centre, 1);
  }
  bool is_stl() const { return std::string(GetParam()) == "ball.stl"; }
  ScratchFolder folder_;
};

TEST_P(FarMesh, KeepsItsBoundAndTheRoundingOfItsFile) {
  for (const double away : {0.0, 3.0, 100.0, 1e4, 1.3e7}) {
    const Vec3 centre{away, -0.4 * away, 0.1 * away};
    for (const double tolerance : {1e-2, 1e-3}) {
      const Ball ball = ball_at(centre, tolerance);
      const double rounding = file_rounding(ball.mesh, GetParam());
      EXPECT_LE(measured(ball.mesh, centre), ball.bound + rounding + room) << away << " " << tolerance;
      // Half a unit in the last place of floats, along three axes; 2^-16 of the size where doubles take over.
      EXPECT_LE(rounding, is_stl() ? 1.74 * away * 0x1p-24 + 1e-6 : 1.1 * 0x1p-16) << away;
    }
  }
}

TEST_P(FarMesh, IsWithinTheBoundWhereTheFormatHoldsDoubles) {
  const Vec3 centre{12958095.124851028, 4865499.469870342, 0};
  const Ball ball = ball_at(centre, 1e-2);
  const double found = measured(ball.mesh, centre);
  if (is_stl()) {
    EXPECT_GT(found, 0.2);  // floats there are whole numbers
  } else {
    EXPECT_LE(found, ball.bound + room);
  }
}

TEST_P(FarMesh, PositionsInDoubleAreCountedFromTheseDoubles) {
  const Vec3 centre{-4e6, 2e6, 7e5};
  const Ball ball = ball_at(centre, 1e-3, Precision::double_precision);
  EXPECT_LE(measured(ball.mesh, centre), ball.bound + file_rounding(ball.mesh, GetParam()) + room);
  if (!is_stl()) {
    EXPECT_LE(file_rounding(ball.mesh, GetParam()), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, FarMesh, testing::ValuesIn(names),
                         [](const auto& of) { return std::string(of.param).substr(5); });

TEST(FarMesh, NearZeroFilesHoldFloatsAsBefore) {
  const Ball ball = ball_at({3, -2, 1}, 1e-3);
  const ScratchFolder folder;
  ASSERT_TRUE(write_mesh(ball.mesh, folder / "ball.ply").ok());
  const std::string bytes = value_of(read_file(folder / "ball.ply"));
  EXPECT_NE(bytes.find("property float x"), std::string::npos);
  EXPECT_EQ(bytes.find("property double x"), std::string::npos);
}

}}  // namespace tessera::test
