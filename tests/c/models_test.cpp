// Models through C: control points, JSON text, files, and what they hold.

#include <cstdlib>
#include <filesystem>
#include <set>

#include "c/c_objects.h"
#include "support/errors.h"
#include "support/scratch_folder.h"
#include "tessera/io.h"
#include "tessera/tessera_c_shapes.h"

namespace tessera::test { namespace {

Handle<tsr_model> read(const std::string& path) {
  tsr_model* model = nullptr;
  EXPECT_C(tsr_model_read(&model, path.c_str(), nullptr));
  return Handle<tsr_model>(model);
}

tsr_model_info info_of(const tsr_model* model) {
  tsr_model_info info = sized<tsr_model_info>();
  EXPECT_C(tsr_model_describe(model, &info));
  return info;
}

TEST(CModel, SplinesWithNames) {
  const std::vector<double> knots{0, 0, 1, 2, 2};
  std::vector<double> points, weights(9, 1);
  for (int k = 0; k < 9; ++k) points.insert(points.end(), {k / 3 * 1.0, k % 3 * 1.0, k * k * 0.1});
  weights[4] = 2;
  tsr_bspline spline = sized<tsr_bspline>();
  spline.degree_u = spline.degree_v = 1, spline.count_u = spline.count_v = 3;
  spline.points = points.data(), spline.weights = weights.data(), spline.name = "roof";
  spline.knots_u = spline.knots_v = knots.data(), spline.knot_count_u = spline.knot_count_v = 5;
  tsr_model* made = nullptr;
  ASSERT_C(tsr_model_new(&made, &spline, 1));
  const Handle<tsr_model> model(made);
  EXPECT_EQ(info_of(made).surfaces, 1u);
  EXPECT_STREQ(tsr_model_text(made, TSR_TEXT_SURFACE, 0), "roof");
  EXPECT_STREQ(tsr_model_text(made, TSR_TEXT_SURFACE_KIND, 0), "NURBS surface");
  EXPECT_EQ(tsr_model_text(made, TSR_TEXT_SURFACE, 1), nullptr);
  EXPECT_EQ(tsr_model_text(made, 99, 0), nullptr);
  tsr_surface_info surface = sized<tsr_surface_info>();
  ASSERT_C(tsr_model_surface(made, 0, &surface));
  EXPECT_EQ(surface.domain[1], 2);
  EXPECT_EQ(surface.loops, 0u);
  const Handle<tsr_set> set = set_of(made);
  tsr_set_info info = sized<tsr_set_info>();
  ASSERT_C(tsr_set_describe(set.get(), &info));
  EXPECT_EQ(info.patches, 4u);
  EXPECT_EQ(info.high[0], 2);
  std::vector<double> own(12), of(4);
  tsr_patch_info patch = sized<tsr_patch_info>();
  ASSERT_C(tsr_set_patch(set.get(), 3, &patch, own.data(), of.data()));
  EXPECT_EQ(patch.degree_u, 1);
  EXPECT_TRUE(patch.is_rational);
  EXPECT_EQ(patch.domain[0], 1);
  EXPECT_EQ(of, (std::vector<double>{2, 1, 1, 1}));
  EXPECT_EQ(own[2], 1.6);
  expect_c_error(tsr_set_patch(set.get(), 4, nullptr, nullptr, nullptr), TSR_INVALID_ARGUMENT, "patch 4 is none");
}

TEST(CModel, TextOfEverySurfaceKind) {
  std::set<std::string> kinds;
  for (const auto& file : std::filesystem::directory_iterator(std::string(TESSERA_SOURCE_DIR) + "/tools/models")) {
    if (file.path().extension() != ".json") continue;
    const std::string text = value_of(read_file(file.path()));
    tsr_model* made = nullptr;
    ASSERT_C(tsr_model_parse(&made, text.data(), text.size(), "text")) << file.path();
    const Handle<tsr_model> model(made);
    const Model wanted = value_of(read_model(file.path()));
    ASSERT_EQ(info_of(made).surfaces, wanted.surfaces.size());
    for (std::size_t k = 0; k < wanted.surfaces.size(); ++k) {
      EXPECT_EQ(tsr_model_text(made, TSR_TEXT_SURFACE_KIND, k), std::string(kind_name(wanted.surfaces[k].surface)));
      EXPECT_EQ(tsr_model_text(made, TSR_TEXT_SURFACE, k), *wanted.surfaces[k].name);
      kinds.insert(tsr_model_text(made, TSR_TEXT_SURFACE_KIND, k));
    }
    const Handle<tsr_set> set = set_of(made);
    const Handle<tsr_plan> plan = plan_of(set.get(), 1e-2, TSR_PLAN_RELATIVE);
  }
  EXPECT_GE(kinds.size(), 10u);
  tsr_model* broken = nullptr;
  expect_c_error(tsr_model_parse(&broken, "{", 1, "broken"), TSR_PARSE_ERROR, "broken:1");
  EXPECT_EQ(broken, nullptr);
}

TEST(CModel, FilesRoundTrip) {
  const ScratchFolder folder;
  const std::string path = folder / "wavy.json";
  ASSERT_C(tsr_model_save(model_of(wavy_field(2, 1)).get(), path.c_str()));
  EXPECT_EQ(info_of(read(path).get()).surfaces, 2u);
  tsr_model* none = nullptr;
  expect_c_error(tsr_model_read(&none, (folder / "missing.json").c_str(), nullptr), TSR_IO_ERROR, "missing.json");
  expect_c_error(tsr_model_read(&none, folder.file("wavy.xyz", "1").c_str(), nullptr), TSR_UNSUPPORTED, ".xyz");
}

TEST(CModel, PartsAndTheirPlaces) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  tsr_model* made = nullptr;
  ASSERT_C(tsr_model_read(&made, (std::string(data) + "/step_cad/as1-oc-214.stp").c_str(), nullptr));
  const Handle<tsr_model> model(made);
  const tsr_model_info info = info_of(made);
  EXPECT_EQ(info.shapes, 5u);
  EXPECT_EQ(info.instances, 18u);
  EXPECT_STREQ(tsr_model_text(made, TSR_TEXT_UNIT, 0), "mm");
  EXPECT_STRNE(tsr_model_text(made, TSR_TEXT_SHAPE, 0), "");
  EXPECT_NE(tsr_model_text(made, TSR_TEXT_INSTANCE, 17), nullptr);
  tsr_instance_info instance = sized<tsr_instance_info>();
  ASSERT_C(tsr_model_instance(made, 17, &instance));
  EXPECT_LT(instance.shape, 5u);
  EXPECT_LT(instance.first_surface, info.surfaces);
  const double* const m = instance.placement;
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(m[3 * c] * m[3 * c] + m[3 * c + 1] * m[3 * c + 1] + m[3 * c + 2] * m[3 * c + 2], 1, 1e-12);
  expect_c_error(tsr_model_instance(made, 18, &instance), TSR_INVALID_ARGUMENT, "instance 18 is none", 18);
  tsr_face_info face = sized<tsr_face_info>();
  ASSERT_C(tsr_model_face(made, instance.first_surface + 1, &face));
  EXPECT_EQ(face.instance, 17u);
  EXPECT_EQ(face.shape, instance.shape);
  EXPECT_EQ(face.face, 1u);
  expect_c_error(tsr_model_face(made, info.surfaces, &face), TSR_INVALID_ARGUMENT, "is none",
                 static_cast<std::int64_t>(info.surfaces));
  const Handle<tsr_set> set = set_of(made, 0, 2);
  const Handle<tsr_plan> plan = plan_of(set.get(), 1e-3, TSR_PLAN_RELATIVE);
  tsr_plan_info mesh = sized<tsr_plan_info>();
  ASSERT_C(tsr_plan_describe(plan.get(), &mesh));
  EXPECT_EQ(mesh.open_edges, 0u);
}

TEST(CModel, BadSurfacesAreNamed) {
  const std::vector<BezierPatch> patches = wavy_field(1, 1);
  std::vector<tsr_bspline> surfaces(3, bspline_of(patches[0]));
  tsr_model* made = nullptr;
  const auto refused = [&](tsr_status code, const std::string& words, std::int64_t index = 1) {
    expect_c_error(tsr_model_new(&made, surfaces.data(), surfaces.size()), code, words, index);
    EXPECT_EQ(made, nullptr);
    surfaces[1] = surfaces[0];
  };
  std::vector<Vec3> points(patches[0].points().begin(), patches[0].points().end());
  points[7].y = not_a_number;
  surfaces[1].points = &points[0].x;
  refused(TSR_NON_FINITE, "surface 1: control point");
  surfaces[1].points = nullptr;
  refused(TSR_INVALID_ARGUMENT, "points is a null pointer");
  surfaces[1].count_u = 5;
  refused(TSR_COUNT_MISMATCH, "has 4 x 4 points, found 5 x 4");
  surfaces[1].count_u = SIZE_MAX / 2;
  refused(TSR_INVALID_ARGUMENT, "more than memory holds");
  surfaces[1].degree_u = 16;
  refused(TSR_UNSUPPORTED_DEGREE, "16");
  surfaces[1].degree_u = -7;
  refused(TSR_UNSUPPORTED_DEGREE, "-7");
  const std::vector<double> weights{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, 1, 1, 1, 1};
  surfaces[1].weights = weights.data();
  refused(TSR_INVALID_WEIGHT, "surface 1");
  const std::vector<double> knots{0, 0, 0, 0, 1, 1, 1, 1};
  surfaces[1].knots_u = knots.data(), surfaces[1].knot_count_u = 8;
  refused(TSR_INVALID_ARGUMENT, "one of knots_u and knots_v");
  surfaces[1].knots_u = surfaces[1].knots_v = knots.data(), surfaces[1].knot_count_u = surfaces[1].knot_count_v = 8;
  surfaces[1].count_v = 3;
  refused(TSR_COUNT_MISMATCH, "points");
  surfaces[1].struct_size = 8;
  refused(TSR_INVALID_ARGUMENT, "different struct_size");
  expect_c_error(tsr_model_new(&made, surfaces.data(), 0), TSR_INVALID_ARGUMENT, "no surfaces");
}

}}  // namespace tessera::test
