// Models of shapes in memory, and their maps.

#include <gtest/gtest.h>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>

#include <cmath>
#include <set>

#include "occt/map_checks.h"
#include "occt/occt_shapes.h"
#include "tessera/occt.h"
#include "tessera/throw.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

TEST(OcctModel, CoincidesWithItsShapeAtMappedParameters) {
  int points = 0;
  for (const NamedShape& one : occt_shapes()) {
    const OcctModel all = value_or_throw(model_from(one.shape));
    EXPECT_EQ(all.model.surfaces.size(), faces_in(one.shape).size()) << one.name;
    EXPECT_TRUE(all.left_out.empty()) << one.name;
    EXPECT_TRUE(check_topology(all.model).ok()) << one.name;
    const double fit = one.name == "offset surface" ? 1e-5 : 0;
    points += expect_mapped(all, one.shape, one.name, fit);
  }
  EXPECT_GT(points, 5000);
}

// The maps of a model would coincide with the shape at many points if an angle were taken for a parameter of arcs.
TEST(OcctModel, ParametersOfArcsAreNotAngles) {
  const OcctParameter quarter{Interval{0, 1.5}}, equal;
  EXPECT_EQ(equal.to_occt(0.3), 0.3);
  EXPECT_EQ(equal.from_occt(-7), -7);
  EXPECT_EQ(quarter.to_occt(0), 0);
  EXPECT_NEAR(quarter.to_occt(0.75), 0.75, 1e-15);
  EXPECT_GT(std::abs(quarter.to_occt(0.3) - 0.3), 1e-3);
  EXPECT_NEAR(quarter.from_occt(quarter.to_occt(0.3)), 0.3, 1e-15);
}

// Each face of the shape stands for one surface, in the order of the shape where no part is repeated.
TEST(OcctModel, SurfacesFollowTheOrderOfTheFaces) {
  const TopoDS_Shape shape = drilled_box();
  const OcctModel all = value_or_throw(model_from(shape));
  const std::vector<TopoDS_Face> faces = faces_in(shape);
  ASSERT_EQ(all.model.surfaces.size(), faces.size());
  for (std::size_t k = 0; k < faces.size(); ++k) EXPECT_TRUE(all.face(k).IsEqual(faces[k])) << k;
}

TEST(OcctModel, PartsAreReadOnceForAllTheirPlaces) {
  const TopoDS_Shape drilled = drilled_box(), box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  std::vector<TopoDS_Shape> copies;
  for (int k = 0; k < 5; ++k) copies.push_back(drilled.Moved(shift(5 * k, 0, 0)));
  copies.push_back(box);
  const TopoDS_Compound shape = compound_of(copies);
  const OcctModel all = value_or_throw(model_from(shape));
  EXPECT_EQ(all.model.shapes.size(), 2u);
  ASSERT_EQ(all.model.instances.size(), 6u);
  std::set<std::size_t> found;
  const std::vector<TopoDS_Face> faces = faces_in(shape);
  for (std::size_t k = 0; k < all.model.surfaces.size(); ++k)
    for (std::size_t face = 0; face < faces.size(); ++face)
      if (all.face(k).IsEqual(faces[face])) found.insert(face);
  EXPECT_EQ(found.size(), faces.size());
}

}}  // namespace tessera::test
