// Bad input gives a Status, and nothing is written.

#include <gtest/gtest.h>

#include <limits>
#include <type_traits>

#include "support/grids.h"

namespace tessera::test { namespace {

class EvaluateErrors : public ::testing::Test {
 protected:
  Random random{41};
  PatchSet set = set_of(mixed_patches(random, 2));
  std::vector<double> t = uniform_parameters(4);
  GridPlan plan = value_of(GridPlan::make(set, t, t));
  GridBuffers<float> out{plan};
  GridBuffers<float> untouched{plan};

  void expect_error(StatusCode code, const QuantityViews<float>& views) {
    const Status status = evaluate(set, plan, views);
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_TRUE(out == untouched);
  }
};

TEST_F(EvaluateErrors, EachShortView) {
  for (int output = 0; output < 4; ++output) {
    QuantityViews<float> views = out.views();
    View3<float>* view[] = {&views.position, &views.du, &views.dv, &views.normal};
    view[output]->size = plan.capacity() - 1;
    expect_error(StatusCode::buffer_too_small, views);
  }
}

TEST_F(EvaluateErrors, StridesAndMissingComponents) {
  QuantityViews<float> views = out.views();
  views.normal.stride = 0;
  expect_error(StatusCode::invalid_argument, views);
  views = out.views();
  views.position.stride = -3;
  expect_error(StatusCode::invalid_argument, views);
  views = out.views();
  views.dv.component[2] = nullptr;
  expect_error(StatusCode::invalid_argument, views);
  expect_error(StatusCode::invalid_argument, {});
}

TEST_F(EvaluateErrors, OverlapsAndMisalignment) {
  const std::size_t count = plan.capacity();
  std::vector<float> memory(8 * count, -7.0f);
  const std::span<float> all = memory;
  const auto expect_refused = [&](const QuantityViews<float>& views) {
    const Status status = evaluate(set, plan, views);
    EXPECT_EQ(status.code(), StatusCode::invalid_argument);
    EXPECT_NE(status.message().find("position"), std::string::npos) << status.message();
    EXPECT_TRUE(std::ranges::all_of(memory, [](float x) { return x == -7.0f; }));
  };
  const auto of = [&](std::size_t record, std::size_t first) { return View3<float>::interleaved(all, record, first); };
  expect_refused({.position = of(3, 0), .normal = of(3, 3)});  // a record later
  expect_refused({.position = of(6, 0), .normal = of(6, 2)});  // z is x
  expect_refused({.position = of(6, 0), .normal = of(8, 3)});  // strides of their own
  expect_refused({.position = of(2, 0)});                      // itself
  const auto array = [&](std::size_t first) { return all.subspan(first, count); };
  expect_refused({.position = View3<float>::soa({array(0), array(count - 1), array(3 * count)})});
  View3<float> odd = of(3, 0);
  for (float*& component : odd.component) component = reinterpret_cast<float*>(reinterpret_cast<char*>(component) + 1);
  expect_refused({.position = odd});
  View3<float> wide = of(3, 0);
  wide.stride = std::numeric_limits<std::ptrdiff_t>::max();
  expect_refused({.position = wide});
}

TEST_F(EvaluateErrors, BlocksThatShareMemory) {
  AlignedVector<float> memory(2 * plan.block_capacity(), -7.0f);
  const std::span<float> all = memory;
  const QuantityBlocks<float> apart{.position = all.first(plan.block_capacity()),
                                    .normal = all.subspan(plan.block_capacity())};
  QuantityBlocks<float> shared = apart;
  shared.normal = all.subspan(plan.block_capacity() - 16);
  const Status status = evaluate(set, plan, shared);
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  EXPECT_NE(status.message().find("normal"), std::string::npos) << status.message();
  EXPECT_TRUE(std::ranges::all_of(memory, [](float x) { return x == -7.0f; }));
  EXPECT_TRUE(evaluate(set, plan, apart).ok());
}

/// Every output of QuantityViews, short by one record, with a stride of 0, or without a component: no output is
/// written.
TEST_F(EvaluateErrors, EachViewOfLocalGeometry) {
  AllBuffers<float> memory(plan), clean(plan);
  const auto expect_refused = [&](const QuantityViews<float>& views, StatusCode code, const std::string& name) {
    const Status status = evaluate(set, plan, views);
    EXPECT_EQ(status.code(), code) << name;
    EXPECT_NE(status.message().find(name), std::string::npos) << status.message();
    EXPECT_TRUE(memory == clean) << name;
  };
  for_each_quantity([&](const auto& output) {
    QuantityViews<float> views = memory.views();
    output.of(views).size = plan.capacity() - 1;
    expect_refused(views, StatusCode::buffer_too_small, output.name);
    views = memory.views();
    output.of(views).stride = 0;
    expect_refused(views, StatusCode::invalid_argument, output.name);
    if (output.width == 1) return;
    views = memory.views();
    output.of(views).component.back() = nullptr;
    expect_refused(views, StatusCode::invalid_argument, output.name);
  });
}

TEST_F(EvaluateErrors, EachBlockOfLocalGeometry) {
  for_each_quantity([&](const auto& output) {
    const std::size_t needed = plan.block_capacity() / 3 * static_cast<std::size_t>(output.width);
    QuantityBlocks<float> blocks;
    using Value = typename std::remove_reference_t<decltype(output.of(blocks))>::element_type;
    AlignedVector<Value> memory(needed + 1, Value(9));
    const std::span<Value> all = memory;
    for (const auto& [span, code] : {std::pair{all.first(needed - 1), StatusCode::buffer_too_small},
                                     {all.subspan(1), StatusCode::invalid_argument}}) {
      output.of(blocks) = span;
      const Status status = evaluate(set, plan, blocks);
      EXPECT_EQ(status.code(), code) << output.name;
      EXPECT_NE(status.message().find(output.name), std::string::npos) << status.message();
    }
    EXPECT_TRUE(std::ranges::all_of(memory, [](Value x) { return x == Value(9); }));
  });
}

TEST_F(EvaluateErrors, GeometryOptions) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1e-9, 1.0, nan}) {
    EXPECT_EQ(GridPlan::make(set, t, t, {.geometry = {.min_sine = bad}}).status().code(), StatusCode::invalid_argument);
    EXPECT_EQ(GridPlan::make(set, t, t, {.geometry = {.umbilic_tolerance = bad}}).status().code(),
              StatusCode::invalid_argument);
  }
}

TEST_F(EvaluateErrors, BlockMemory) {
  AlignedVector<float> memory(plan.block_capacity() + 1, -7.0f);
  const std::span<float> all = memory;
  EXPECT_EQ(evaluate(set, plan, QuantityBlocks<float>{.position = all.first(plan.block_capacity() - 1)}).code(),
            StatusCode::buffer_too_small);
  EXPECT_EQ(evaluate(set, plan, QuantityBlocks<float>{.position = all.subspan(1)}).code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(evaluate(set, plan, QuantityBlocks<float>{}).code(), StatusCode::invalid_argument);
  EXPECT_TRUE(std::ranges::all_of(memory, [](float x) { return x == -7.0f; }));
}

TEST_F(EvaluateErrors, PlanOfAnotherPrecisionOrSet) {
  GridBuffers<double> doubles(plan);
  EXPECT_EQ(evaluate(set, plan, doubles.views()).code(), StatusCode::invalid_argument);
  const PatchSet other = set_of({random_polynomial(random, 3, 3)});
  EXPECT_EQ(evaluate(other, plan, out.views()).code(), StatusCode::stale);
}

TEST_F(EvaluateErrors, Parameters) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto code = [&](std::vector<double> u, std::vector<double> v) { return GridPlan::make(set, u, v).status(); };
  EXPECT_EQ(code({}, t).code(), StatusCode::invalid_argument);
  EXPECT_EQ(code(t, {0, nan}).code(), StatusCode::non_finite);
  EXPECT_EQ(code(t, {0, nan}).index(), 1);
  EXPECT_EQ(code({infinity}, t).code(), StatusCode::non_finite);
  EXPECT_EQ(code({-0.001}, t).code(), StatusCode::invalid_argument);
  EXPECT_EQ(code({0, 1, 1.001}, t).index(), 2);
}

/// 2^24 x 2^24 parameters over 2^16 patches would be 2^64 points, and their count 0.
TEST_F(EvaluateErrors, MorePointsThanMemoryCanAddress) {
  const std::vector<BezierPatch> patches(1u << 16, random_polynomial(random, 1, 1));
  const PatchSet many = set_of(patches);
  const std::vector<double> zeros(1u << 24, 0.0);
  EXPECT_EQ(GridPlan::make(many, zeros, zeros).status().code(), StatusCode::invalid_argument);
}

TEST_F(EvaluateErrors, BlocksThatTheSetLacks) {
  EXPECT_EQ(GridPlan::make(set, t, t, {.precision = Precision::double_precision}).status().code(),
            StatusCode::unsupported);
  EXPECT_EQ(GridPlan::make(set, t, t, {.representation = Representation::power}).status().code(),
            StatusCode::unsupported);
}

TEST_F(EvaluateErrors, CancelledBeforeTheFirstTask) {
  const std::atomic<bool> cancel = true;
  Execution execution;
  execution.cancel = &cancel;
  EXPECT_EQ(evaluate(set, plan, out.views(), execution).code(), StatusCode::cancelled);
}

}}  // namespace tessera::test
