// Real files of the classic formats: the teapot is the same in all of them, spheres are round; values of other
// programs. tests/conformance checks that every file is read.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "support/scratch_folder.h"
#include "tessera/io.h"

namespace tessera { namespace {

namespace fs = std::filesystem;

class ClassicFiles : public testing::Test {
 protected:
  void SetUp() override {
    const char* const data = std::getenv("TESSERA_TEST_DATA");
    if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
    data_ = data;
  }
  Model read(const std::string& name) const {
    Result<Model> model = read_model(data_ / name);
    EXPECT_TRUE(model.ok()) << model.status().message();
    return model ? *std::move(model) : Model{};
  }
  fs::path data_;
};

/// A patch's control points, whatever their order.
using PointSet = std::multiset<std::array<double, 3>>;

/// The patches of a model, points through `map` and to four decimals.
template <class Map>
std::multiset<PointSet> point_sets(const Model& model, const Map& map) {
  std::multiset<PointSet> patches;
  const auto rounded = [](double x) { return std::round(x * 1e4) / 1e4 + 0.0; };
  for (const ModelSurface& surface : model.surfaces) {
    const Result<PatchGrid> grid = to_bezier(surface);
    EXPECT_TRUE(grid.ok());
    for (const BezierPatch& patch : grid->patches()) {
      PointSet points;
      for (const Vec3& q : patch.points()) {
        const Vec3 p = map(q);
        points.insert({rounded(p.x), rounded(p.y), rounded(p.z)});
      }
      patches.insert(std::move(points));
    }
  }
  return patches;
}

TEST_F(ClassicFiles, TheTeapotIsTheSameInEveryFormat) {
  const auto as_it_is = [](const Vec3& p) { return p; };
  const auto pot = point_sets(read("classic_teaset/uteapot.rib"), as_it_is);
  ASSERT_EQ(pot.size(), 32u);
  EXPECT_TRUE(pot == point_sets(read("bezierview_bv/SurfLab__teapot.bv"), as_it_is));
  EXPECT_TRUE(pot == point_sets(read("g2_gotools/splipy_teapot.g2"), as_it_is));
  // This teapot is smaller, stands on its bottom, and has a bottom instead of the others' rim: Newell's 28 patches
  // agree.
  const auto lowered = [](const Vec3& p) { return 40 * p - Vec3{0, 0, 6}; };
  const auto small = point_sets(read("classic_teaset/mkeeter_teapot.bpt"), lowered);
  std::vector<PointSet> shared;
  std::set_intersection(pot.begin(), pot.end(), small.begin(), small.end(), std::back_inserter(shared));
  EXPECT_EQ(shared.size(), 28u);
}

/// The largest distance of the model's points from the sphere.
double off_sphere(const Model& model, const Vec3& centre, double radius) {
  double worst = 0;
  for (const ModelSurface& surface : model.surfaces) {
    const Domain d = domain(surface.surface);
    for (double s = 0; s <= 1; s += 0.0625) {
      for (double t = 0; t <= 1; t += 0.0625) {
        const Vec3 p = evaluate_jet(surface, d.u_at(s), d.v_at(t))->position;
        worst = std::max(worst, std::abs(length(p - centre) - radius));
      }
    }
  }
  return worst;
}

TEST_F(ClassicFiles, SpheresAreRound) {
  // Round up to their digits: ten decimals, six, six significant.
  EXPECT_LE(off_sphere(read("bezierview_bv/SurfLab__sphere.bv"), {}, 1), 2e-10);
  EXPECT_LE(off_sphere(read("g2_gotools/splipy_sphere.g2"), {}, 1), 2e-6);
  EXPECT_LE(off_sphere(read("rib_nupatch/trimmed_nupatch_sphere.rib"), {0.0730667, 0.146111, 0}, 10.1086), 1e-4);
}

TEST_F(ClassicFiles, TheTrimmedSphereKeepsItsLoop) {
  const Model model = read("rib_nupatch/trimmed_nupatch_sphere.rib");
  const ModelSurface& surface = model.surfaces.at(0);
  ASSERT_EQ(surface.trims->size(), 1u);
  ASSERT_EQ(surface.trims->at(0).curves.size(), 4u);
  // Runs around the whole of the parameters; each curve begins where the one before it ends.
  Vec3 end;
  for (const Curve& curve : surface.trims->at(0).curves) {
    EXPECT_LE(length(evaluate_jet(curve, curve.domain().from).position - end), 1e-12);
    end = evaluate_jet(curve, curve.domain().to).position;
  }
  EXPECT_LE(length(end), 1e-12);
}

TEST_F(ClassicFiles, ValuesOfOtherProgramsAreMet) {
  const auto cases =
      nlohmann::json::parse(test::content_of((data_ / "peer_cases/oracle_real_surfaces_A.json").string()));
  const std::map<std::string, std::pair<std::string, std::size_t>> sources{
      {"g2sphere#0", {"g2_gotools/splipy_sphere.g2", 0}},
      {"g2teapot#0", {"g2_gotools/splipy_teapot.g2", 0}},
      {"g2teapot#28", {"g2_gotools/splipy_teapot.g2", 28}}};
  std::size_t points = 0;
  for (const auto& surface : cases["surfaces"]) {
    const auto source = sources.find(surface["name"].get<std::string>());
    if (source == sources.end()) continue;
    const Model model = read(source->second.first);
    const double size = surface["size"], of_points = surface["tolerance_rel_point"];
    for (const auto& eval : surface["evals"]) {
      const double u = eval["params"][0], v = eval["params"][1];
      const Result<SurfaceJet> jet = evaluate_jet(model.surfaces.at(source->second.second), u, v);
      const auto vector = [](const nlohmann::json& x) { return Vec3{x[0], x[1], x[2]}; };
      const Vec3 du = vector(eval["derivs"]["du"]), dv = vector(eval["derivs"]["dv"]);
      const double of_derivatives = surface["tolerance_rel_derivs"].get<double>() * std::max(max_abs(du), max_abs(dv));
      EXPECT_LE(length(jet->position - vector(eval["point"])), of_points * size) << source->first;
      EXPECT_LE(length(jet->du - du), of_derivatives) << source->first;
      EXPECT_LE(length(jet->dv - dv), of_derivatives) << source->first;
      ++points;
    }
  }
  EXPECT_GE(points, 20u);
}

}}  // namespace tessera
