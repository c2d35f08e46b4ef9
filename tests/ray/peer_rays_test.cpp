// Compares with rays that other programs have answered: axom's tests and SISL's line intersections of real surfaces.
// Their data is not part of this project: TESSERA_TEST_DATA names its folder; without it the test is skipped.

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "ray_support.h"
#include "tessera/convert.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

using Json = nlohmann::json;

Vec3 vector_of(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }

std::vector<BezierPatch> patches_of(const Json& json) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (const Json& row : json.at("control_points")) {
    for (const Json& p : row) points.push_back(vector_of(p));
  }
  const std::vector<double> u = json.at("knots_u"), v = json.at("knots_v");
  const int m = json.at("degree_u"), n = json.at("degree_v");
  if (!json.at("weights").is_null()) {
    for (const Json& row : json.at("weights")) {
      for (const Json& w : row) weights.push_back(w);
    }
  }
  const BSplineSurface surface = value_of(weights.empty() ? BSplineSurface::polynomial(m, u, n, v, points)
                                                          : BSplineSurface::rational(m, u, n, v, points, weights));
  return value_of(to_bezier(surface)).take_patches();
}

/// A surface of a file as an exact scene.
struct PeerScene {
  PatchSet set;
  RayScene scene;
  explicit PeerScene(const Json& json) : set(set_of(patches_of(json))), scene(make(set)) {}
  static RayScene make(const PatchSet& set) {
    RaySceneOptions options;
    options.mode = RayMode::exact;
    return value_of(RayScene::make(set, options));
  }
  std::vector<double> all_t(const Ray& one) const {
    HitLists lists;
    EXPECT_TRUE(scene.all({&one, 1}, lists).ok());
    std::vector<double> out;
    for (const Hit& hit : lists.hits) out.push_back(hit.t);
    return out;
  }
};

bool any_near(const std::vector<double>& values, double t, double tolerance) {
  return std::any_of(values.begin(), values.end(), [&](double value) { return std::abs(value - t) <= tolerance; });
}

Json data_file(const char* name) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) return {};
  return Json::parse(std::ifstream(std::string(data) + "/peer_cases/" + name));
}

TEST(PeerRays, Axom) {
  const Json file = data_file("axom_rays_A.json");
  if (file.is_null()) GTEST_SKIP() << "TESSERA_TEST_DATA names no folder of test data";
  std::size_t compared = 0, rulings = 0;
  for (const Json& surface : file.at("surfaces")) {
    const PeerScene scene(surface);
    for (const Json& json : surface.at("rays")) {
      if (json.at("domain") != "closed") continue;  // borders belong to patches here
      const Ray one = ray(vector_of(json.at("origin")), vector_of(json.at("direction")));
      SCOPED_TRACE(surface.at("name").get<std::string>() + " " + json.dump());
      const std::string note = json.value("note", "");
      const std::vector<double> ours = scene.all_t(one);
      if (note.find("infinitely many") != std::string::npos || note.find("coplanar") == 0) {
        // The ray runs in the surface: the first point counts, rather than the peer's choice.
        EXPECT_EQ(scene.scene.closest(one).kind, HitKind::hit);
        EXPECT_TRUE(scene.scene.closest(one).flags.uncertified);
        ++rulings;
        continue;
      }
      EXPECT_EQ(ours.size(), json.at("hits").size());
      for (const Json& hit : json.at("hits")) EXPECT_TRUE(any_near(ours, hit.at("t"), 1e-8));
      ++compared;
    }
  }
  std::cout << compared << " rays compared, " << rulings << " that run in the surface\n";
  EXPECT_GT(compared, 60u);
}

TEST(PeerRays, Sisl) {
  const Json file = data_file("sisl_rays_real_A.json");
  if (file.is_null()) GTEST_SKIP() << "TESSERA_TEST_DATA names no folder of test data";
  std::size_t lines = 0, points = 0;
  for (const Json& surface : file.at("surfaces")) {
    const PeerScene scene(surface);
    const double size = surface.at("size"), tolerance = 1e-6 * size;
    for (const Json& json : surface.at("rays")) {
      SCOPED_TRACE(surface.at("name").get<std::string>() + " " + json.at("origin").dump());
      const Vec3 direction = normalized(vector_of(json.at("direction"))), origin = vector_of(json.at("origin"));
      const double back = length(origin - scene.set.box().centre()) + 2 * scene.set.box().diagonal();
      std::vector<double> ours = scene.all_t(ray(origin - back * direction, direction)), theirs;
      for (double& t : ours) t -= back;
      for (const Json& hit : json.at("line_hits")) theirs.push_back(hit.at("t"));
      for (const double t : theirs) EXPECT_TRUE(any_near(ours, t, tolerance)) << "theirs alone: " << t;
      for (const double t : ours) EXPECT_TRUE(any_near(theirs, t, tolerance)) << "ours alone: " << t;
      ++lines, points += theirs.size();
    }
  }
  std::cout << lines << " lines, " << points << " points\n";
  EXPECT_GT(lines, 100u);
}

}}  // namespace tessera::test
