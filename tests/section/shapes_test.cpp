// Sections of shapes of several faces: trimmed faces, edges, coplanar faces.

#include "base/function_ref.h"
#include "join/unjoined_faces.h"
#include "section/section_checks.h"
#include "tess_trim/closed_shape.h"

namespace tessera::test { namespace {

PatchSet set_of(const std::vector<ModelSurface>& faces) { return value_of(make_patch_set(joined(faces, 1e-6))); }

Sections cut(const PatchSet& set, const Vec3& normal, double offset, SectionOptions options = {}) {
  const Sections made = value_of(make_section(set, {normal, offset}, options));
  expect_sound(set, made, 2e-10, length(normal));
  return made;
}

TEST(SectionOfShapes, ADrilledPlate) {
  const PatchSet set = set_of(drilled_plate());  // 4 x 3 x 1 with a hole of radius 0.6 at (1.7, 1.4)
  const Sections middle = cut(set, {0, 0, 1}, 0.5, {.tolerance = 1e-5});
  EXPECT_EQ(middle.planes[0].open_count, 0u);
  ASSERT_EQ(middle.polylines.size(), 2u);
  EXPECT_NEAR(middle.planes[0].length, 14 + 1.2 * pi, 1e-3);
  EXPECT_LE(middle.planes[0].largest_gap, 1e-12);
  // Through the hole: two rectangles.
  const Sections through = cut(set, {1, 0, 0}, 1.7, {.tolerance = 1e-5});
  EXPECT_EQ(through.planes[0].open_count, 0u);
  ASSERT_EQ(through.polylines.size(), 2u);
  EXPECT_NEAR(through.planes[0].length, 2 * (3 - 1.2) + 4, 1e-9);
  // Beside it: one.
  EXPECT_EQ(cut(set, {1, 0, 0}, 3).polylines.size(), 1u);
  // Obliquely, through top, bottom and the hole's wall.
  const Sections oblique = cut(set, normalized({1, 0.3, 2}), 1.2, {.tolerance = 1e-5});
  EXPECT_EQ(oblique.planes[0].open_count, 0u);
  EXPECT_GE(oblique.polylines.size(), 1u);
}

TEST(SectionOfShapes, APlaneInTopOrBottomOfAPlate) {
  const PatchSet set = set_of(drilled_plate());
  for (const double z : {0.0, 1.0}) {
    const Sections made = cut(set, {0, 0, 1}, z, {.tolerance = 1e-5});
    EXPECT_EQ(made.planes[0].limit, z == 0 ? PlaneLimit::above : PlaneLimit::below);
    EXPECT_EQ(made.planes[0].open_count, 0u) << z;
    ASSERT_EQ(made.polylines.size(), 2u) << z;
    EXPECT_NEAR(made.planes[0].length, 14 + 1.2 * pi, 1e-3);
    ASSERT_EQ(made.coplanar.size(), 1u);
    EXPECT_EQ(set.source(made.coplanar[0]).surface, z == 0 ? 1u : 0u);
    const PlaneLimit away = z == 0 ? PlaneLimit::below : PlaneLimit::above;
    EXPECT_EQ(cut(set, {0, 0, 1}, z, {.limit = away}).polylines.size(), 0u);
  }
  // In the front wall, and as the tangent of the hole's wall.
  EXPECT_NEAR(cut(set, {0, 1, 0}, 0).planes[0].length, 10, 1e-9);
  const Sections tangent = cut(set, {0, 1, 0}, 1.4 + 0.6);
  EXPECT_EQ(tangent.planes[0].open_count, 0u);
}

TEST(SectionOfShapes, ACubeAtFacesEdgesAndCorners) {
  const PatchSet set = set_of(cube());
  for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}})
    for (const double at : {0.0, 0.25, 1.0}) {
      const Sections face = cut(set, normal, normal.z < 0 ? -at : at);
      ASSERT_EQ(face.polylines.size(), 1u);
      EXPECT_TRUE(face.polylines[0].closed);
      EXPECT_EQ(face.polylines[0].count, 4u);
      EXPECT_NEAR(face.polylines[0].length, 4, 1e-12);
      EXPECT_EQ(face.coplanar.size(), at == 0.25 ? 0u : 1u);
    }
  // Through two opposite edges: a rectangle.
  const Sections diagonal = cut(set, {1, -1, 0}, 0);
  EXPECT_EQ(diagonal.planes[0].open_count, 0u);
  ASSERT_EQ(diagonal.polylines.size(), 1u);
  EXPECT_NEAR(diagonal.polylines[0].length, 2 + 2 * std::sqrt(2.0), 1e-9);
  // Along one edge: there and back.
  const Sections edge = cut(set, {1, 1, 0}, 0);
  EXPECT_EQ(edge.planes[0].open_count, 0u);
  ASSERT_EQ(edge.polylines.size(), 1u);
  EXPECT_NEAR(edge.polylines[0].length, 2, 1e-9);
  // At a corner, through three corners, and a hexagon.
  const Sections corner = cut(set, {1, 1, 1}, 0);
  EXPECT_EQ(corner.polylines.size(), 0u);
  ASSERT_EQ(corner.contacts.size(), 1u);
  EXPECT_LE(length(corner.contacts[0].position), corner.contact_size);
  const Sections triangle = cut(set, {1, 1, 1}, 1);
  ASSERT_EQ(triangle.polylines.size(), 1u);
  EXPECT_TRUE(triangle.polylines[0].closed);
  EXPECT_NEAR(triangle.polylines[0].length, 3 * std::sqrt(2.0), 1e-9);
  const Sections hexagon = cut(set, {1, 1, 1}, 1.5);
  ASSERT_EQ(hexagon.polylines.size(), 1u);
  EXPECT_EQ(hexagon.polylines[0].count, 6u);
  EXPECT_NEAR(hexagon.polylines[0].length, 3 * std::sqrt(2.0), 1e-9);
}

TEST(SectionOfShapes, EveryTurnOfACubeIsClosed) {
  for (int trial = 0; trial < 200; ++trial) {
    const Affine turn = Affine::rotated({1, 2, 3}, 0.1 * trial) * Affine::rotated({1, -1, 0.5}, 0.37 * trial);
    std::vector<ModelSurface> faces = cube();
    for (ModelSurface& face : faces) face.placement = turn;
    const PatchSet set = set_of(faces);
    const Vec3 normal = turn.vector({0, 0, 1});
    for (const double at : {0.0, 0.3, 1.0}) {
      const Sections made = cut(set, normal, at);
      ASSERT_EQ(made.polylines.size(), 1u) << trial << ' ' << at;
      EXPECT_TRUE(made.polylines[0].closed) << trial << ' ' << at;
      EXPECT_NEAR(made.polylines[0].length, 4, 1e-9) << trial << ' ' << at;
    }
    const Sections corner = cut(set, turn.vector({1, 1, 1}), std::sqrt(3.0) / std::sqrt(3.0));
    EXPECT_EQ(corner.planes[0].open_count, 0u) << trial;
  }
}

TEST(SectionOfShapes, OpenShellsHaveOpenEnds) {
  std::vector<ModelSurface> faces = cube();
  faces.pop_back();  // the face x = 1
  const PatchSet set = set_of(faces);
  const Sections made = cut(set, {0, 0, 1}, 0.5);
  ASSERT_EQ(made.polylines.size(), 1u);
  EXPECT_FALSE(made.polylines[0].closed);
  EXPECT_EQ(made.planes[0].open_count, 1u);
  EXPECT_NEAR(made.polylines[0].length, 3, 1e-12);
}

TEST(SectionOfShapes, FacesApartAreJoinedAcrossTheGapThatIsReported) {
  std::vector<ModelSurface> faces = cube();
  const double gap = 1e-5;
  faces[5].placement = Affine::translated({gap, 0, 0});
  const PatchSet set = value_of(make_patch_set(joined(faces, 1e-4)));
  const Sections made = cut(set, {0, 0, 1}, 0.5, {.tolerance = 1e-3});
  ASSERT_EQ(made.polylines.size(), 1u);
  EXPECT_TRUE(made.polylines[0].closed);
  EXPECT_NEAR(made.planes[0].largest_gap, gap, 1e-12);
  EXPECT_GE(made.planes[0].bound, 0.99 * gap);
  // A tolerance that is finer than the gap keeps both points and says which segments bridge it.
  const Sections fine = cut(set, {0, 0, 1}, 0.5, {.tolerance = 1e-6});
  EXPECT_EQ(std::ranges::count(fine.points, true, &SectionPoint::bridges_gap), 2);
  // A limit below the gap leaves ends open.
  const Sections strict = cut(set, {0, 0, 1}, 0.5, {.tolerance = 1e-6, .max_gap = 1e-6});
  EXPECT_EQ(strict.planes[0].open_count, 2u);
}

TEST(SectionOfShapes, APlateWithManyHoles) {
  std::vector<TrimLoop> loops{space_polygon({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}})};
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) loops.push_back(circle_loop(1 + 2 * i, 1 + 2 * j, 0.5, true, 0.3 * i + j));
  const PatchSet set = value_of(
      make_patch_set(Model{.name = "plate", .surfaces = {rectangle_face({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, loops)}}));
  for (int k = 0; k < 40; ++k) {
    const double x = 0.125 + 0.25 * k;
    const Sections made = cut(set, {1, 0, 0}, x);
    const double from_centre = std::abs(std::remainder(x - 1, 2));
    const bool is_cut = from_centre < 0.5;
    EXPECT_EQ(made.polylines.size(), is_cut ? 6u : 1u) << x;
    const double kept = 10 - (is_cut ? 10 * std::sqrt(0.25 - from_centre * from_centre) : 0);
    EXPECT_NEAR(made.planes[0].length, kept, 1e-10) << x;
  }
}

}}  // namespace tessera::test
