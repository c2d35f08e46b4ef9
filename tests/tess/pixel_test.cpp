// In a camera's picture no point of the surface is further from its triangle than the proven number of pixels.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/impl_access.h"
#include "tess/bounds/picture.h"
#include "tess/certificate_sets.h"
#include "tess/seen_pixels.h"
#include "tess/tessellate_support.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

TEST(Pixels, AreNeverExceeded) {
  Random random(1);
  for (const CertificateSet& chosen : certificate_sets()) {
    if (chosen.name == "size 1e6, at 1e7") continue;  // an error, tested below: floats there move by pixels
    const PatchSet set = set_of(chosen.patches);
    double most = 0;
    for (const View& view : views_of(set)) {
      const auto plan = Tessellation::make(set, {.pixels = PixelTolerance{2, view}, .max_triangles = 20'000'000});
      if (!plan) {  // patches that all but touch the eye
        EXPECT_NE(plan.status().message().find("ixels"), std::string::npos) << plan.status().message();
        RecordProperty(chosen.name, plan.status().message());
        continue;
      }
      EXPECT_LE(plan->pixels(), 2 * (1 + 1e-6));
      if (plan->capacity().triangles > 300'000) continue;
      const PixelFound found = pixels_over_bound(set, *plan, mesh_of(set, *plan), view, random);
      EXPECT_LE(found.share, 1) << chosen.name << (view.orthographic ? ", orthographic" : "");
      most = std::max(most, found.share);
    }
    EXPECT_GE(most, chosen.bicubic ? 0.2 : 0) << chosen.name;
  }
}

/// Bounds in a picture for a patch alone, and for it in its block.
TEST(Pixels, PicturesInBlocksHoldThoseInDoubleAndLittleMore) {
  std::size_t sharp = 0, all = 0;
  for (const CertificateSet& chosen : certificate_sets()) {
    const PatchSet set = set_of(chosen.patches);
    const PatchSet::Impl& inner = impl_of(set);
    for (const View& view : views_of(set)) {
      const Camera camera = good(Camera::make(view));
      std::array<double, PatchSet::lanes> moved;
      moved.fill(1e-6 * set.box().diagonal());
      std::vector<ScreenSpaceBound> pictures(set.patch_count());
      for (std::size_t block = 0; block < inner.lane_counts.size(); ++block)
        ScreenSpaceBound::find(camera, inner, block, moved, 0.5, pictures.data());
      for (std::size_t k = 0; k < pictures.size(); ++k) {
        const ScreenSpaceBound exact(camera, inner.patches[k], moved[0], 0.5);
        ASSERT_EQ(pictures[k].projected().has_value(), exact.projected().has_value());
        EXPECT_EQ(pictures[k].distance(), exact.distance());
        EXPECT_EQ(pictures[k].moved_pixels(), exact.moved_pixels());
        if (!exact.projected()) continue;
        for (const Rates rates : {Rates{1, 1}, Rates{1, 4}, Rates{6, 3}, Rates{2, 2}}) {
          const double in_double = exact.projected()->distance(rates), found = pictures[k].projected()->distance(rates);
          EXPECT_GE(found, in_double * (1 - 1e-9)) << chosen.name;
          // Roots are up to 0.36% too large, rounding up to an eighth; or both are next to nothing.
          EXPECT_LE(found, std::max(1.2 * in_double, 0.05)) << chosen.name;
          sharp += found <= 1.01 * in_double;
          ++all;
        }
      }
    }
  }
  EXPECT_GT(sharp, all * 9 / 10);
}

TEST(Pixels, ClosedBodiesStayClosedFromAnywhere) {
  for (const auto& body : {closed_body(), sphere()}) {
    const PatchSet set = set_of(body);
    for (const View& view : views_of(set))
      for (const double pixels : {20.0, 3.0, 0.5}) {
        const Tessellation plan = good(Tessellation::make(set, {.pixels = PixelTolerance{pixels, view}}));
        const Mesh mesh = mesh_of(set, plan);
        const MeshReport report = good(check(mesh));
        EXPECT_TRUE(report.closed()) << pixels;
        EXPECT_EQ(report.degenerate_triangles, 0u);
        EXPECT_EQ(2 * report.distinct_positions, report.triangles + 4);
        EXPECT_LE(plan.pixels(), pixels * (1 + 1e-6));
      }
  }
}

TEST(Pixels, FarPatchesTakeFewerTriangles) {
  const PatchSet set = set_of(wavy_field(16, 4));
  const View view{.eye = {-3, 2, 2}, .target = {8, 2, 0}, .near_distance = 0.01};
  const Tessellation plan = good(Tessellation::make(set, {.pixels = PixelTolerance{0.5, view}}));
  const Mesh mesh = mesh_of(set, plan);
  const auto of_column = [&](std::uint32_t column) {
    return std::count_if(mesh.patches.begin(), mesh.patches.end(), [&](std::uint32_t k) { return k / 4 == column; });
  };
  EXPECT_GT(of_column(0), 4 * of_column(15));
  const MeshReport report = good(check(mesh));
  EXPECT_EQ(2 * report.distinct_positions, report.triangles + report.open_edges + 2);  // a disc: no crack
  // The camera is turned away and sees nothing of it.
  const View away{.eye = {-3, 2, 2}, .target = {-8, 2, 2}};
  const Tessellation unseen = good(Tessellation::make(set, {.pixels = PixelTolerance{0.5, away}}));
  EXPECT_EQ(unseen.capacity().triangles, 2u * 64);
  EXPECT_EQ(unseen.pixels(), 0);
}

/// A floor that passes under the camera: its hull contains the eye's plane, its visible part does not.
TEST(Pixels, AFloorBelowTheEye) {
  std::vector<BezierPatch> floor;
  for (const BezierPatch& patch : wavy_field(1, 1)) floor.push_back(placed({patch}, 20, {-10, -10, -10})[0]);
  const PatchSet set = set_of(floor);
  const View view{.eye = {0, 0, 12}, .target = {6, 0, 8}};
  const Tessellation plan = good(Tessellation::make(set, {.pixels = PixelTolerance{0.5, view}}));
  EXPECT_LE(plan.pixels(), 0.5 * (1 + 1e-6));
  EXPECT_LT(plan.capacity().triangles, 200'000u);
  Random random(2);
  const PixelFound found = pixels_over_bound(set, plan, mesh_of(set, plan), view, random);
  EXPECT_GT(found.seen, 100u);
  EXPECT_LE(found.share, 1);
}

TEST(Pixels, CombineWithTheOthers) {
  const PatchSet set = set_of(closed_body());
  const View view = views_of(set)[0];
  const Tessellation plan = good(Tessellation::make(
      set, {.tolerance = 0.01, .angle = 0.2, .pixels = PixelTolerance{1, view}, .joining = {.weld = 1e-6}}));
  EXPECT_LE(plan.bound(), 0.01 * (1 + 1e-6));
  EXPECT_LE(plan.angle(), 0.2 * (1 + 1e-6));
  EXPECT_LE(plan.pixels(), 1 + 1e-6);
  EXPECT_TRUE(good(check(mesh_of(set, plan))).closed());
}

TEST(Pixels, WrongOnesAreRefused) {
  const PatchSet set = set_of(closed_body());
  const View good_view = views_of(set)[0];
  const auto message = [&](double pixels, const View& view) {
    const auto plan = Tessellation::make(set, {.pixels = PixelTolerance{pixels, view}});
    EXPECT_FALSE(plan.ok());
    return plan.ok() ? "" : plan.status().message();
  };
  for (const double pixels : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_NE(message(pixels, good_view).find("pixels, it must be finite and above 0"), std::string::npos);
  const auto changed = [&](auto change) {
    View view = good_view;
    change(view);
    return message(1, view);
  };
  EXPECT_NE(changed([](View& v) { v.target = v.eye; }).find("the same point"), std::string::npos);
  EXPECT_NE(changed([](View& v) { v.eye.x = std::nan(""); }).find("must be finite"), std::string::npos);
  EXPECT_NE(changed([](View& v) { v.field_of_view = 0; }).find("field of view"), std::string::npos);
  EXPECT_NE(changed([](View& v) { v.field_of_view = std::nan(""); }).find("field of view"), std::string::npos);
  EXPECT_NE(changed([](View& v) { v.orthographic = true, v.extent = -1; }).find("extent"), std::string::npos);
  EXPECT_NE(changed([](View& v) { v.height = 0; }).find("pixels, each must be from 1 to"), std::string::npos);
  EXPECT_NE(changed([](View& v) { v.near_distance = -1; }).find("near distance"), std::string::npos);
  // Floats far away move by more than the pixels allow: an error, not silence.
  const PatchSet far = set_of(placed(closed_body(), 1, {1e7, 0, 0}));
  const auto rough =
      Tessellation::make(*PatchSet::make(placed(closed_body(), 1, {1e7, 0, 0}), PatchSetOptions{.origin = Vec3{}}),
                         {.pixels = PixelTolerance{0.5, views_of(far)[0]}});
  ASSERT_FALSE(rough.ok());
  EXPECT_NE(rough.status().message().find("the tolerance of 0.5 pixels at the view's near distance must be above "),
            std::string::npos)
      << rough.status().message();
}

}}  // namespace tessera::test
