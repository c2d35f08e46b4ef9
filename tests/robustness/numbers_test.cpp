// Unusual numbers: small, large and far models, subnormal ones, and floating-point modes of the caller's.

#include <gtest/gtest.h>

#include <cfenv>

#include "robustness/scene.h"
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace tessera::test { namespace {

AllBuffers<float> grid_of(const PatchSet& set) {
  const std::vector<double> t = uniform_parameters(6);
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  AllBuffers<float> out(plan);
  EXPECT_TRUE(evaluate(set, plan, out.views()).ok());
  return out;
}

/// The largest distance of the float positions from those of the patches in double, over the set's size.
double relative_error(const PatchSet& set) {
  AllBuffers<float> out = grid_of(set);
  const std::vector<double> t = uniform_parameters(6);
  double largest = 0;
  std::size_t record = 0;
  for (std::size_t k = 0; k < set.patch_count(); ++k)
    for (const double u : t)
      for (const double v : t) {
        const Vec3 exact = evaluate_jet(set.patch(k), u, v).position - set.origin();
        largest = std::max(largest, max_abs(read(out.views().position, record++) - exact));
      }
  return largest / set.box().diagonal();
}

TEST(Scales, FloatKeepsItsRelativePrecision) {
  const std::vector<BezierPatch> model = various_patches(4);
  for (const double scale : {1.0, 1e-6, 1e6, 1e-30, 1e30}) {
    EXPECT_LE(relative_error(set_of(placed(model, scale, {}))), 4 * 0x1p-24) << scale;
    // The control points themselves are rounded to double far away: 1e7 + x holds x to 2^-29.
    for (const Vec3& shift : {Vec3{1e7, 0, 0}, Vec3{-1e7, 1e7, 1e7}})
      EXPECT_LE(relative_error(set_of(placed(model, scale, scale * shift))), 4 * 0x1p-24) << scale;
  }
}

/// Scaling by a power of two changes no rounding of positions: the same bits, except for the exponent.
TEST(Scales, PowersOfTwoGiveTheSameBits) {
  const std::vector<BezierPatch> model = various_patches(4);
  const AllBuffers<float> one = grid_of(set_of(model));
  for (const int power : {-40, -20, 20, 40}) {
    const double scale = std::ldexp(1.0, power);
    const PatchSet set = set_of(placed(model, scale, {}));
    AllBuffers<float> other = grid_of(set);
    ASSERT_EQ(one.values[0].size(), other.values[0].size());
    for (std::size_t k = 0; k < one.values[0].size(); ++k)
      ASSERT_EQ(std::ldexp(one.values[0][k], power), other.values[0][k]) << power;
    // If the squares of normals leave the range of float, another method finds them.
    for (std::size_t k = 0; k < one.values[3].size(); ++k)
      ASSERT_NEAR(one.values[3][k], other.values[3][k], 1e-5) << power;
    const auto triangles = [&](const PatchSet& of, double tolerance) {
      return value_of(Tessellation::make(of, {.tolerance = tolerance})).capacity().triangles;
    };
    EXPECT_EQ(triangles(set_of(model), 1e-3), triangles(set, 1e-3 * scale));
  }
}

#ifdef TESSERA_HAS_RAY
TEST(Scales, RaysMeetTheSamePoints) {
  const std::vector<BezierPatch> model = various_patches(4);
  const PatchSet one = set_of(model);
  const std::vector<Ray> rays = rays_at(one, 2000);
  std::vector<Hit> expected(rays.size()), hits(rays.size());
  ASSERT_TRUE(value_of(RayScene::make(one)).closest(rays, expected).ok());
  for (const double scale : {1e-6, 1e6})
    for (const double far : {0.0, 1e7}) {
      const Vec3 shift = scale * Vec3{far, -far, far};
      const PatchSet set = set_of(placed(model, scale, shift));
      std::vector<Ray> moved = rays;
      for (Ray& ray : moved) ray.origin = scale * ray.origin + shift, ray.direction = scale * ray.direction;
      ASSERT_TRUE(value_of(RayScene::make(set)).closest(moved, hits).ok());
      std::size_t others = 0;
      for (std::size_t k = 0; k < rays.size(); ++k) {
        const Hit &a = expected[k], &b = hits[k];
        others += a.kind != b.kind || a.patch != b.patch || !(a.kind == HitKind::miss || std::abs(a.t - b.t) < 1e-6);
      }
      // Far away both the rays and the surface are rounded to 2e-9: hits at silhouettes and borders may differ.
      EXPECT_LE(others, far == 0 ? 0u : 2u) << scale << ' ' << far;
    }
}
#endif

TEST(Subnormals, AreNumbers) {
  for (const double scale : {1e-38, 1e-42, 1e-45, 1e-60, 1e-310, 5e-324}) {
    const auto made = PatchSet::make(placed(wavy_field(2, 2), scale, {}), {.blocks = {.double_bernstein = true}});
    ASSERT_TRUE(made.ok()) << made.status().message();
    const AllBuffers<float> out = grid_of(*made);
    for (const auto& values : out.values)
      for (const float x : values) ASSERT_TRUE(std::isfinite(x)) << scale;
    const auto plan = Tessellation::make(*made, {.tolerance = 0.01, .relative = true});
    EXPECT_TRUE(plan.ok() || !plan.status().message().empty());
#ifdef TESSERA_HAS_RAY
    for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
      const auto scene = RayScene::make(*made, {.mode = mode});
      if (!scene) continue;
      EXPECT_EQ(scene->closest({.origin = {0, 0, 1}, .direction = {1, 0, 0}}).kind, HitKind::miss);
    }
#endif
  }
}

/// The floating-point settings of the caller's thread.
struct Modes {
  int rounding = std::fegetround();
#if defined(__x86_64__)
  unsigned control = _mm_getcsr() & ~0x3fu;  // without the status flags
#else
  unsigned control = 0;
#endif
  bool operator==(const Modes&) const = default;
};

/// During its lifetime the thread rounds in this way, and has these bits set in its control register.
class WithModes {
 public:
  explicit WithModes(int rounding, [[maybe_unused]] unsigned bits = 0) {
    std::fegetenv(&before_);
    std::fesetround(rounding);
#if defined(__x86_64__)
    _mm_setcsr(_mm_getcsr() | bits);
#endif
  }
  WithModes(const WithModes&) = delete;
  WithModes& operator=(const WithModes&) = delete;
  ~WithModes() { std::fesetenv(&before_); }

 private:
  std::fenv_t before_;
};

constexpr unsigned flush_to_zero = 0x8000, subnormals_are_zero = 0x0040;

struct Setting {
  const char* name;
  int rounding;
  unsigned bits;
};
class FloatingPointModes : public ::testing::TestWithParam<Setting> {};

TEST_P(FloatingPointModes, AreLeftAsFoundAndResultsAreDefined) {
  const PatchSet set = set_of(various_patches(4), with_points());
  const AllBuffers<float> expected = grid_of(set);
  const auto plan = value_of(Tessellation::make(set, {.tolerance = 1e-2}));
  const WithModes modes(GetParam().rounding, GetParam().bits);
  const Modes before;
  const AllBuffers<float> out = grid_of(set);
  EXPECT_EQ(Modes(), before);
  for (std::size_t k = 0; k < out.values[0].size(); ++k)
    ASSERT_NEAR(out.values[0][k], expected.values[0][k], 1e-5) << "positions";
  const Bits bits = everything(3);
  EXPECT_GT(bits.size(), 100000u);
  EXPECT_EQ(Modes(), before);
  const auto again = value_of(Tessellation::make(set, {.tolerance = 1e-2}));
  EXPECT_LE(again.bound(), 1e-2);
  EXPECT_EQ(Modes(), before);
#ifdef TESSERA_HAS_RAY
  for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
    const RayScene scene = value_of(RayScene::make(set, {.mode = mode}));
    const std::vector<Ray> rays = rays_at(set, 500);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(scene.closest(rays, hits).ok());
    for (const Hit& hit : hits) {
      if (hit.kind != HitKind::hit) continue;
      ASSERT_TRUE(std::isfinite(hit.t) && is_finite(hit.position) && is_finite(hit.normal));
      EXPECT_LT(max_abs(hit.position - evaluate_jet(set.patch(hit.patch), hit.patch_u, hit.patch_v).position), 1e-3);
    }
    EXPECT_EQ(Modes(), before);
  }
#endif
}

#ifdef TESSERA_HAS_RAY
/// Large enough for Embree to build with several threads, which must not round as this thread does.
TEST_P(FloatingPointModes, LargeScenesAreBuilt) {
  const PatchSet set = set_of(wavy_field(40, 40));
  const WithModes modes(GetParam().rounding, GetParam().bits);
  const Modes before;
  for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
    const RayScene scene = value_of(RayScene::make(set, {.mode = mode}));
    EXPECT_EQ(Modes(), before);
    for (double x = 0.25; x < 40; x += 1.5)
      EXPECT_EQ(scene.closest({.origin = {x, 40 - x, 9}, .direction = {0, 0, -1}}).kind, HitKind::hit) << x;
  }
}
#endif

INSTANTIATE_TEST_SUITE_P(
    Modes, FloatingPointModes,
    ::testing::Values(Setting{"nearest", FE_TONEAREST, 0}, Setting{"upward", FE_UPWARD, 0},
                      Setting{"downward", FE_DOWNWARD, 0}, Setting{"towards_zero", FE_TOWARDZERO, 0},
                      Setting{"flush_to_zero", FE_TONEAREST, flush_to_zero},
                      Setting{"subnormals_are_zero", FE_TONEAREST, flush_to_zero | subnormals_are_zero},
                      Setting{"upward_and_flushed", FE_UPWARD, flush_to_zero | subnormals_are_zero}),
    [](const auto& setting) { return setting.param.name; });

}}  // namespace tessera::test
