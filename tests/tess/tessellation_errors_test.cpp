// Errors of a tessellation, after which nothing is written.

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

using ::testing::HasSubstr;

TEST(TessellationErrors, RatesOutOfRange) {
  Random random(1);
  const PatchSet set = set_of({random_polynomial(random, 3, 3)});
  for (const auto& [u, v, message] : {std::tuple{0, 8, "rate u is 0, it must be 1 to 4096"},
                                      {8, 0, "rate v is 0, it must be 1 to 4096"},
                                      {-5, 8, "rate u is -5, it must be 1 to 4096"},
                                      {8, 4097, "rate v is 4097, it must be 1 to 4096"}}) {
    const auto plan = Tessellation::make(set, {.rates = UniformRates{u, v}});
    ASSERT_FALSE(plan.ok());
    EXPECT_EQ(plan.status().code(), StatusCode::invalid_argument);
    EXPECT_EQ(plan.status().message(), message);
  }
}

TEST(TessellationErrors, VerticesBeyond32Bits) {
  Random random(2);
  const std::vector<BezierPatch> patches(256, random_polynomial(random, 1, 1));
  const auto plan = Tessellation::make(set_of(patches), {.rates = UniformRates{4096, 4096}});
  ASSERT_FALSE(plan.ok());
  EXPECT_EQ(plan.status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(plan.status().message(),
            "256 patches at rates 4096 x 4096 have 4297064704 vertices, 32-bit indices reach 4294967296");
  const std::vector<BezierPatch> fewer(patches.begin(), patches.end() - 1);
  EXPECT_EQ(good(Tessellation::make(set_of(fewer), {.rates = UniformRates{4096, 4096}})).capacity().vertices,
            4280279295u);
}

TEST(TessellationErrors, NoFloatBlocks) {
  Random random(3);
  const std::vector<BezierPatch> patches = {random_polynomial(random, 3, 3)};
  PatchSetOptions options;
  options.blocks = {.float_bernstein = false, .double_bernstein = true};
  const auto plan = Tessellation::make(good(PatchSet::make(patches, options)), {.rates = UniformRates{}});
  ASSERT_FALSE(plan.ok());
  EXPECT_EQ(plan.status().code(), StatusCode::unsupported);
}

/// A mesh full of a pattern, to see whether anything was written.
class Untouched {
 public:
  explicit Untouched(const Tessellation& plan) : mesh_(good(plan.allocate())) {
    for (auto* floats : {&mesh_.positions, &mesh_.normals, &mesh_.parameters})
      std::fill(floats->begin(), floats->end(), -77.0f);
    for (auto* integers : {&mesh_.patches, &mesh_.indices}) std::fill(integers->begin(), integers->end(), 77777777u);
  }
  MeshViews views() { return mesh_.views(); }
  bool holds() const {
    const auto all = [](const auto& values, auto pattern) {
      return std::all_of(values.begin(), values.end(), [&](auto value) { return value == pattern; });
    };
    return all(mesh_.positions, -77.0f) && all(mesh_.normals, -77.0f) && all(mesh_.parameters, -77.0f) &&
           all(mesh_.patches, 77777777u) && all(mesh_.indices, 77777777u);
  }

 private:
  Mesh mesh_;
};

class BadViews : public ::testing::Test {
 protected:
  BadViews()
      : set_(set_of(mixed_patches(4, 30))),
        plan_(good(Tessellation::make(set_, {.rates = UniformRates{3, 2}}))),
        mesh_(plan_) {}

  void expect_refused(const MeshViews& views, StatusCode code, const std::string& message) {
    const Status status = plan_.run(set_, views);
    EXPECT_EQ(status.code(), code);
    EXPECT_EQ(status.message(), message);
    EXPECT_TRUE(mesh_.holds()) << message;
  }

  PatchSet set_;
  Tessellation plan_;
  Untouched mesh_;
};

TEST_F(BadViews, OneTooShort) {
  const std::string vertices = std::to_string(plan_.capacity().vertices),
                    fewer = std::to_string(plan_.capacity().vertices - 1);
  const std::size_t triangles = plan_.capacity().triangles;
  MeshViews views = mesh_.views();
  --views.position.size;
  expect_refused(views, StatusCode::buffer_too_small,
                 "the position view holds " + fewer + " vertices, " + vertices + " are needed");
  views = mesh_.views();
  --views.normal.size;
  expect_refused(views, StatusCode::buffer_too_small,
                 "the normal view holds " + fewer + " vertices, " + vertices + " are needed");
  views = mesh_.views();
  --views.parameter.size;
  expect_refused(views, StatusCode::buffer_too_small,
                 "the parameter view holds " + fewer + " vertices, " + vertices + " are needed");
  views = mesh_.views();
  views.patch = views.patch.first(triangles - 1);
  expect_refused(views, StatusCode::buffer_too_small,
                 "the patch view holds " + std::to_string(triangles - 1) + " triangles, " + std::to_string(triangles) +
                     " are needed");
  views = mesh_.views();
  views.indices = views.indices.first(3 * triangles - 1);
  expect_refused(views, StatusCode::buffer_too_small,
                 "the indices view holds " + std::to_string(3 * triangles - 1) + " indices, " +
                     std::to_string(3 * triangles) + " are needed");
}

TEST_F(BadViews, MissingOrMalformed) {
  MeshViews views = mesh_.views();
  views.position = {};
  expect_refused(views, StatusCode::invalid_argument, "the position view is empty, it is required");
  views = mesh_.views();
  views.indices = {};
  EXPECT_EQ(plan_.run(set_, views).code(), StatusCode::buffer_too_small);
  for (const std::ptrdiff_t stride : {0, -1}) {
    views = mesh_.views();
    views.parameter.stride = stride;
    expect_refused(views, StatusCode::invalid_argument,
                   "the parameter view's stride is " + std::to_string(stride) + ", it must be at least 1");
    views = mesh_.views();
    views.position.stride = stride;
    expect_refused(views, StatusCode::invalid_argument,
                   "the position view's stride is " + std::to_string(stride) + ", it must be at least 1");
  }
  views = mesh_.views();
  views.normal.component[2] = nullptr;
  expect_refused(views, StatusCode::invalid_argument, "a component of the normal view is null");
}

TEST_F(BadViews, MisalignedOrInOnePlace) {
  MeshViews views = mesh_.views();
  views.normal = views.position;
  expect_refused(views, StatusCode::invalid_argument, "position and normal share memory");
  views = mesh_.views();
  views.parameter.component[1] = views.position.component[2];
  expect_refused(views, StatusCode::invalid_argument, "position and parameter share memory");
  views = mesh_.views();
  views.patch = views.indices;
  expect_refused(views, StatusCode::invalid_argument, "indices and patch share memory");
  views = mesh_.views();
  for (float*& component : views.position.component)
    component = reinterpret_cast<float*>(reinterpret_cast<char*>(component) + 1);
  expect_refused(views, StatusCode::invalid_argument, "position: the view's memory must be aligned to 4 bytes");
  views = mesh_.views();
  views.parameter.stride = std::numeric_limits<std::ptrdiff_t>::max();
  expect_refused(views, StatusCode::invalid_argument,
                 "parameter: a stride of 9223372036854775807 over " + std::to_string(plan_.capacity().vertices) +
                     " records reaches beyond the address space");
}

TEST(TessellationErrors, StaleAfterAnEditOfThePoles) {
  Random random(5);
  std::vector<BezierPatch> patches;
  for (int k = 0; k < 40; ++k) patches.push_back(random_polynomial(random, 2, 2));
  PatchSet set = set_of(patches);
  const Tessellation plan = good(Tessellation::make(set, {.rates = UniformRates{}}));
  Untouched mesh(plan);
  std::vector<Vec3> points(patches[33].points().begin(), patches[33].points().end());
  points[1] = points[2] = points[0];
  ASSERT_TRUE(set.set_control_points(33, points).ok());
  const Status status = plan.run(set, mesh.views());
  EXPECT_EQ(status.code(), StatusCode::stale);
  EXPECT_EQ(status.index(), 33);
  EXPECT_THAT(status.message(), HasSubstr("patch 33"));
  EXPECT_TRUE(mesh.holds());
  ASSERT_TRUE(set.set_control_points(33, patches[33].points()).ok());
  EXPECT_TRUE(plan.run(set, mesh.views()).ok());
}

TEST(TessellationErrors, AnotherSet) {
  Random random(6);
  const BezierPatch patch = random_polynomial(random, 3, 3);
  PatchSet set = set_of({patch, patch});
  const PatchSet longer = set_of({patch, patch, patch}), equal = set_of({patch, patch});
  const Tessellation plan = good(Tessellation::make(set, {.rates = UniformRates{}}));
  Untouched mesh(plan);
  for (const PatchSet* other : {&longer, &equal}) {
    EXPECT_EQ(plan.run(*other, mesh.views()).code(), StatusCode::stale);
    EXPECT_TRUE(mesh.holds());
  }
  const PatchSet moved = std::move(set);
  EXPECT_TRUE(plan.run(moved, mesh.views()).ok());
}

/// A set in the memory of one that is gone is another set.
TEST(TessellationErrors, SetInTheMemoryOfAnother) {
  const std::vector<BezierPatch> patches = wavy_field(1, 1);
  std::optional<PatchSet> set(set_of(patches));
  const Tessellation plan = good(Tessellation::make(*set, {.tolerance = 0.01}));
  Mesh mesh = good(plan.allocate());
  for (int k = 0; k < 8; ++k) {
    set.reset();
    set.emplace(set_of(patches));
    EXPECT_EQ(plan.run(*set, mesh.views()).code(), StatusCode::stale);
  }
}

TEST(TessellationErrors, Cancelled) {
  const PatchSet set = set_of(mixed_patches(7, 10));
  const Tessellation plan = good(Tessellation::make(set, {.rates = UniformRates{}}));
  Mesh mesh = good(plan.allocate());
  const std::atomic<bool> cancel = true;
  Execution execution;
  execution.cancel = &cancel;
  EXPECT_EQ(plan.run(set, mesh.views(), execution).code(), StatusCode::cancelled);
}

}}  // namespace tessera::test
