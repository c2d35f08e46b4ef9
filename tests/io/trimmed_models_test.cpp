// The trimmed models that come with the project: the part of each surface that is kept is the one in closed form.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <set>

#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "tessera/io.h"
#include "tessera/trim_region.h"

namespace tessera::test { namespace {

const std::filesystem::path models_folder = TESSERA_SOURCE_DIR "/tools/models";

/// A function of a point of a surface that is positive where the point is kept: about its distance from the border.
using Kept = std::function<double(const Vec3& point, double u, double v)>;

struct TrimmedModel {
  std::string name;
  std::size_t surface;
  TrimOptions periodic;
  double precision;                ///< of the curves, as a value of `kept`
  double share;                    ///< of the domain's area that is kept
  std::vector<LoopFault> remarks;  ///< those that are meant
  Kept kept;
};

double beyond(double x, double y, double radius) { return std::hypot(x, y) - radius; }

double in_plate(const Vec3& p, double, double) {
  double nearest = beyond(p.x - 6, p.y - 4, 2);
  for (const double x : {1.5, 10.5})
    for (const double y : {1.5, 6.5}) nearest = std::min(nearest, beyond(p.x - x, p.y - y, 0.75));
  return nearest;
}

double in_target(const Vec3& p, double, double) {
  const double r = std::hypot(p.x - 5, p.y - 5);
  return r > 3.5 ? 4 - r : r > 2.5 ? r - 3 : r > 1.5 ? 2 - r : r - 1;
}

double in_sieve(const Vec3&, double u, double v) {
  double nearest = 1;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      nearest = std::min(nearest, beyond(u - (455 + 10 * i) / 1000.0, v - (455 + 10 * j) / 1000.0, 0.004));
  return nearest;
}

std::vector<TrimmedModel> trimmed_models() {
  const TrimOptions none{}, around{.periodic_u = true}, both{.periodic_u = true, .periodic_v = true};
  const Kept octant = [](const Vec3& p, double, double) { return std::min({p.x, p.y, p.z}); };
  const Kept cut = [](const Vec3& p, double, double) { return 2 + p.x - p.z; };
  return {
      {"trimmed_plate", 0, none, 1e-14, 1 - (4 * 0.5625 + 4) * std::numbers::pi / 96, {}, in_plate},
      {"trimmed_rings", 0, none, 1e-14, std::numbers::pi * (16 - 9 + 4 - 1) / 100, {}, in_target},
      {"trimmed_hundred_holes", 0, none, 1e-15, 1 - 100 * std::numbers::pi * 16e-6, {}, in_sieve},
      {"trimmed_slit",
       0,
       none,
       0,
       0.5625,
       {LoopFault::retraced},
       [](const Vec3&, double u, double v) { return 0.375 - std::max(std::abs(u - 0.5), std::abs(v - 0.5)); }},
      {"trimmed_bicubic",
       0,
       none,
       1e-15,
       1 - std::numbers::pi * (1.0 / 16 + 1.0 / 64),
       {},
       [](const Vec3&, double u, double v) {
         return std::min(beyond(u - 0.25, v - 0.5, 0.25), beyond(u - 0.75, v - 0.375, 0.125));
       }},
      {"trimmed_torus",
       0,
       both,
       1e-15,
       1 - std::numbers::pi / 64,
       {},
       [](const Vec3&, double u, double v) { return beyond(std::min(u, 1 - u), std::min(v, 1 - v), 0.125); }},
      {"trimmed_octant", 0, none, 1e-14, 0.125, {}, octant},
      {"trimmed_octant", 0, around, 1e-14, 0.125, {}, octant},
      {"trimmed_cap",
       0,
       around,
       1e-14,
       0.25,
       {LoopFault::open},
       [](const Vec3& p, double, double) { return p.z - std::sqrt(0.5); }},
      {"trimmed_cylinder", 0, none, 1e-14, 0.5, {}, cut},
      {"trimmed_cylinder", 0, around, 1e-14, 0.5, {}, cut},
      {"trimmed_crossing_cylinders",
       0,
       around,
       2e-5,
       0.94,
       {},
       [](const Vec3& p, double, double) { return beyond(p.x, p.z, 0.5); }},
      {"trimmed_crossing_cylinders",
       1,
       around,
       2e-5,
       0.622,
       {},
       [](const Vec3& p, double, double) { return 1 - std::hypot(p.x, p.y); }},
  };
}

TEST(TrimmedModels, KeepWhatTheirFormulasSay) {
  Random random(1);
  for (const TrimmedModel& model : trimmed_models()) {
    const Model read = value_of(read_model(models_folder / (model.name + ".json")));
    EXPECT_TRUE(read.warnings.empty()) << model.name;
    const ModelSurface& surface = read.surfaces.at(model.surface);
    const PatchGrid grid = value_of(to_bezier(surface));
    const TrimRegion region =
        value_of(TrimRegion::make(*surface.trims, grid.breaks_u(), grid.breaks_v(), model.periodic));
    std::vector<LoopFault> remarks;
    for (const LoopRemark& remark : region.remarks()) remarks.push_back(remark.fault);
    EXPECT_EQ(remarks, model.remarks) << model.name;
    const Domain d = region.domain();
    int inside = 0;
    constexpr int count = 20000;
    for (int k = 0; k < count; ++k) {
      const double u = uniform(random, d.u0, d.u1), v = uniform(random, d.v0, d.v1);
      const TrimSide found = region.locate(u, v);
      const double kept = model.kept(value_of(evaluate_jet(surface, u, v)).position, u, v);
      inside += found == TrimSide::inside;
      if (std::abs(kept) <= model.precision) continue;
      ASSERT_EQ(found, kept > 0 ? TrimSide::inside : TrimSide::outside) << model.name << ": " << u << ", " << v;
    }
    EXPECT_NEAR(inside / double{count}, model.share, 0.015) << model.name;
  }
}

TEST(TrimmedModels, AreAllInTheTable) {
  std::set<std::string> listed, found;
  for (const TrimmedModel& model : trimmed_models()) listed.insert(model.name);
  for (const auto& entry : std::filesystem::directory_iterator(models_folder))
    if (const std::string name = entry.path().stem(); name.starts_with("trimmed_")) found.insert(name);
  EXPECT_EQ(listed, found);
  for (const auto& entry : std::filesystem::directory_iterator(models_folder)) {
    if (entry.path().extension() != ".json" || entry.path().stem().string().starts_with("trimmed_")) continue;
    for (const ModelSurface& surface : value_of(read_model(entry.path())).surfaces)
      EXPECT_TRUE(surface.trims->empty()) << entry.path() << " is trimmed: its name begins with trimmed_";
  }
}

/// The curves of the crossing cylinders are cubics; the part that they miss is within the table's precision.
TEST(TrimmedModels, CrossingCylindersMeet) {
  const Model model = value_of(read_model(models_folder / "trimmed_crossing_cylinders.json"));
  ASSERT_EQ(model.surfaces.size(), 2u);
  double wide = 0, narrow = 0;
  const auto visit = [&](const ModelSurface& surface, std::size_t curve, double& farthest) {
    for (const TrimLoop& loop : *surface.trims)
      for (std::size_t c = 0; c < loop.curves.size(); c += curve) {
        const Interval& d = loop.curves[c].domain();
        for (int k = 0; k <= 1000; ++k) {
          const Vec3 uv = position(loop.curves[c], d.from + (d.to - d.from) * k / 1000);
          const Vec3 p = value_of(evaluate_jet(surface, uv.x, uv.y)).position;
          farthest = std::max({farthest, std::abs(beyond(p.x, p.z, 0.5)), std::abs(beyond(p.x, p.y, 1))});
        }
      }
  };
  visit(model.surfaces[0], 1, wide);
  visit(model.surfaces[1], 2, narrow);
  EXPECT_LE(wide, 2e-5);
  EXPECT_LE(narrow, 2e-5);
}

}}  // namespace tessera::test
